/* The guardian's process. It is started by fork without exec, so that it needs no program of its own beside the
   driver. It only sleeps and reads a page, and at the end sends the drive the frames that were prepared. */
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clock.h"
#include "servo/guardian.h"
#include "text/error_text.h"

#define LOOK 1      /* ms */
#define PRIORITY 90 /* above the loop's, in case the loop runs away; where it is granted */
#define SOCKET 3
#define READY 10000 /* ms within which the process must watch; a busy machine starts it late */

/* ---- descriptors over the socket ---- */

typedef union ancillary {
  struct cmsghdr head;
  char room[CMSG_SPACE(sizeof(int))];
} ancillary;

static int pass_on(int socket, int fd) {
  char byte = fd >= 0;
  struct iovec data = {&byte, 1};
  ancillary c = {.room = {0}};
  struct msghdr m = {.msg_iov = &data, .msg_iovlen = 1};
  if (fd >= 0) {
    m.msg_control = &c;
    m.msg_controllen = sizeof c.room;
    struct cmsghdr *h = CMSG_FIRSTHDR(&m);
    h->cmsg_level = SOL_SOCKET;
    h->cmsg_type = SCM_RIGHTS;
    h->cmsg_len = CMSG_LEN(sizeof fd);
    memcpy(CMSG_DATA(h), &fd, sizeof fd);
  }
  return sendmsg(socket, &m, MSG_NOSIGNAL | MSG_DONTWAIT) == 1;
}

/* Returns 0 when the other side is gone. */
static int receive(ethd__guardian *g) {
  char byte;
  struct iovec data = {&byte, 1};
  ancillary c;
  struct msghdr m = {.msg_iov = &data, .msg_iovlen = 1, .msg_control = &c, .msg_controllen = sizeof c.room};
  ssize_t n = recvmsg(g->socket, &m, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  if (n == 0) return 0;
  if (g->line >= 0) close(g->line);
  g->line = -1;
  const struct cmsghdr *h = CMSG_FIRSTHDR(&m);
  if (h && h->cmsg_type == SCM_RIGHTS) memcpy(&g->line, CMSG_DATA(h), sizeof g->line);
  return 1;
}

/* ---- the process ---- */

/* Closes the program's descriptors: lines, files, and the terminal, which would otherwise wait for this process. */
static void let_go_of_the_rest(ethd__guardian *g) {
  int null = open("/dev/null", O_RDWR);
  for (int i = 0; i < 3; i++) dup2(null, i);
  if (g->socket != SOCKET) dup2(g->socket, SOCKET);
  g->socket = SOCKET;
  if (syscall(SYS_close_range, SOCKET + 1, ~0u, 0) == 0) return;
  for (int i = SOCKET + 1; i < 4096; i++) close(i); /* a kernel before 5.9 */
}

/* A task with -1000 isn't killed for memory, not even with its control group (the kernel's cgroup-v2.rst on
   memory.oom.group). Only a privileged process may have it. */
static int spare(void) {
  int fd = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  int is = fd >= 0 && write(fd, "-1000", 5) == 5;
  if (fd >= 0) close(fd);
  return is;
}

/* A signal from a terminal or a service manager that ends the program must not end this process first. */
static void settle(void) {
  const struct sched_param param = {.sched_priority = PRIORITY};
  sigset_t none;
  for (int s = 1; s < SIGRTMIN; s++)
    if (s != SIGKILL && s != SIGSTOP && s != SIGSEGV && s != SIGBUS && s != SIGFPE && s != SIGILL) signal(s, SIG_IGN);
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  setsid();
  prctl(PR_SET_NAME, "ethd-guardian");
  (void)!sched_setscheduler(0, SCHED_FIFO, &param);
}

static void watch(ethd__guardian *g) {
  for (;;) {
    struct pollfd wait = {g->socket, POLLIN, 0};
    int ready = poll(&wait, 1, LOOK);
    int alive = ready < 1 || receive(g);
    if (atomic_load(&g->page->closing)) return;
    if (ethd__guardian_due(g, ethd__clock_now()) || (!alive && atomic_load(&g->page->armed)))
      (void)!ethd__guardian_act(g);
    if (!alive) return;
  }
}

/* ---- [main] ---- */

static ethd_status refuse(char *message) {
  return ethd__say(message, ETHD_E_DEVICE, "the guardian of the drive can't be started: %s", strerror(errno));
}

/* Waits until the process says that it watches and holds none of our descriptors any more; before that, a port that
   we close and open again would still be taken. */
static bool stands(const ethd__guardian *g) {
  struct pollfd wait = {g->socket, POLLIN, 0};
  char byte;
  int ready;
  do ready = poll(&wait, 1, READY);
  while (ready < 0 && errno == EINTR);
  if (ready > 0 && recv(g->socket, &byte, 1, MSG_DONTWAIT) == 1) return true;
  errno = ready ? ESRCH : ETIMEDOUT;
  kill(g->process, SIGKILL);
  return false;
}

ethd_status ethd__guardian_start(ethd__guardian *g, char message[ETHD_MESSAGE_MAX]) {
  int pair[2];
  void *page = mmap(NULL, sizeof *g->page, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) return refuse(message);
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair)) {
    munmap(page, sizeof *g->page);
    return refuse(message);
  }
  g->page = page;
  g->process = fork();
  if (g->process == 0) {
    close(pair[0]);
    g->socket = pair[1];
    settle();
    atomic_store(&g->page->spared, spare());
    let_go_of_the_rest(g);
    if (send(g->socket, "", 1, MSG_NOSIGNAL) == 1) watch(g);
    _exit(0);
  }
  close(pair[1]);
  g->socket = pair[0];
  if (g->process > 0 && stands(g)) return ETHD_OK;
  ethd_status status = refuse(message);
  ethd__guardian_end(g);
  return status;
}

bool ethd__guardian_enter(ethd__guardian *g, int64_t now_ns, int fd, uint64_t connects) {
  if (!g->page) return true;
  /* a line that two processes hold can't be opened anew */
  if (fd < 0 && g->passed && pass_on(g->socket, -1)) g->passed = false;
  if (fd >= 0 && connects != g->connects && pass_on(g->socket, fd)) {
    g->connects = connects;
    g->passed = true;
    atomic_store(&g->page->line, ETHD__GUARDIAN_OURS);
  }
  atomic_store(&g->page->beat_ns, now_ns);
  return atomic_load(&g->page->line) == ETHD__GUARDIAN_OURS || fd < 0;
}

void ethd__guardian_end(ethd__guardian *g) {
  if (!g->page) return;
  atomic_store(&g->page->closing, 1);
  close(g->socket);
  if (g->process > 0) waitpid(g->process, NULL, 0);
  munmap(g->page, sizeof *g->page);
  g->page = NULL;
  g->socket = -1;
}
