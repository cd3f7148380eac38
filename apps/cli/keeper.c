/* In a container the kernel kills all processes when the first one, an init, ends, and an init ends with what it has
   started. A drive's guardian outlives the program by some milliseconds, so what the init has started must, too:

       init --- ethd-keeper --- the program --- guardian

   The keeper passes signals on, waits for both, and ends as the program did. */
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "device/container.h"

#define LEFT 10 /* s, at most, for the program's remaining processes */

/* All signals but SIGCONT and those that a program raises by its own error. Signals that stop a job are passed on, too:
   the program decides whether it stops. */
static sigset_t passed_on(void) {
  static const int own[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS, SIGCONT};
  sigset_t set;
  sigfillset(&set);
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) sigdelset(&set, own[i]);
  return set;
}

/* Collects the ends of children; *end is the program's. Returns whether any are left. */
static bool reap(pid_t program, bool *ended, int *end) {
  int how;
  pid_t child;
  while ((child = waitpid(-1, &how, WNOHANG | WUNTRACED)) > 0) {
    if (child != program) continue;
    if (WIFSTOPPED(how)) {
      if (WSTOPSIG(how) != SIGSTOP) raise(SIGSTOP); /* the shell looks at us; its SIGCONT reaches both */
      continue;
    }
    *ended = true;
    *end = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
  }
  return child == 0;
}

static _Noreturn void keep(pid_t program, const sigset_t *signals) {
  bool ended = false;
  int end = ETHD_EXIT_FAILED, left = 10 * LEFT;
  const struct timespec tenth = {.tv_nsec = 100000000};
  prctl(PR_SET_NAME, "ethd-keeper");
  signal(SIGCHLD, SIG_DFL); /* where it is ignored, ends of children are lost */
  while (reap(program, &ended, &end) && left > 0) {
    siginfo_t got;
    int number = ended ? sigtimedwait(signals, &got, &tenth) : sigwaitinfo(signals, &got);
    left -= ended;
    /* a terminal's signals (si_code > 0) reach the program without us */
    if (number > 0 && number != SIGCHLD && got.si_code <= 0 && !ended) kill(program, number);
  }
  _exit(end);
}

void ethd__container_keeper(void) {
  sigset_t signals = passed_on(), before;
  if (ethd__container_depth() < 1) return;
  sigprocmask(SIG_BLOCK, &signals, &before);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  pid_t keeper = getpid(), program = fork();
  if (program > 0) keep(program, &signals);
  if (program == 0) prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (program == 0 && getppid() != keeper) _exit(ETHD_EXIT_FAILED);
  sigprocmask(SIG_SETMASK, &before, NULL); /* without a keeper a drive that needs its guardian isn't enabled */
}
