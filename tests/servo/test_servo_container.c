/* A container is a PID namespace: when its first process ends, the kernel kills the guardian, too. ethd-run in one, as
   its first process, under a shell and under an init (tini, which is docker run --init), before a drive without a
   watchdog on a serial line. The guardian waits for a quiet line before it writes, and an init's end is quicker. And
   what else the guardian says of where it runs, from made-up control groups. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "servo/guardian.h"
#include "servo/mock.h"
#include "text/text.h"
#include "unit/rig.h"
#include "unit/suite.h"

#define TRIES 5 /* a busy machine's loop may end by itself before it is killed */

static mock drive;
static char message[ETHD_MESSAGE_MAX], folder[] = "/tmp/ethd-container-XXXXXX", run[512];

static atomic_int enabled; /* whether it ever was */
static mock_act push(void *user, uint64_t n, int function) {
  (void)user, (void)n;
  if (function == 3) drive.words[MOCK_READING_COUNT]++;
  if (drive.words[MOCK_STATUS] & 2) enabled = 1;
  return (mock_act){MOCK_ANSWER, 0, 0};
}

static bool pushes(void) { return drive.words[MOCK_TORQUE1] && drive.words[MOCK_STATUS] & 2; }
static bool rests(void) { return !drive.words[MOCK_TORQUE1] && !(drive.words[MOCK_STATUS] & 2); }

static bool await(bool (*is)(void), int ms) {
  for (; !is() && ms > 0; ms--) usleep(1000);
  return is();
}

static void path_of(const char *name, char out[128]) { snprintf(out, 128, "%s/%s", folder, name); }

static void write_text(const char *name, const char *text) {
  char path[128];
  path_of(name, path);
  ck_assert_msg(ethd_text_write(path, text, strlen(text), message) == ETHD_OK, "%s", message);
}

static bool said(const char *what) {
  char path[128], *text;
  size_t length;
  path_of("said", path);
  ck_assert_msg(ethd_text_read(path, 1 << 20, &text, &length, message) == ETHD_OK, "%s", message);
  bool is = strstr(text, what) != NULL;
  if (!is) printf("no \"%s\" in:\n%s", what, text);
  free(text);
  return is;
}

/* The process of this name below `top`; 0: there is none. */
static pid_t find(pid_t top, const char *name) {
  char path[64], is[32] = "";
  int child;
  pid_t found = 0;
  snprintf(path, sizeof path, "/proc/%d/task/%d/children", (int)top, (int)top);
  FILE *children = fopen(path, "re");
  while (children && !found && fscanf(children, "%d", &child) == 1) {
    snprintf(path, sizeof path, "/proc/%d/comm", child);
    FILE *comm = fopen(path, "re");
    bool same = comm && fgets(is, sizeof is, comm) && !strncmp(is, name, strlen(name)) && is[strlen(name)] == '\n';
    if (comm) fclose(comm);
    found = same ? child : find(child, name);
  }
  if (children) fclose(children);
  return found;
}

/* Starts ethd-run in a PID namespace of its own; `before` are the words before it, or its own. */
static pid_t start(const char *const *before) {
  char path[128], said_path[128];
  const char *words[20] = {"unshare", "-rfp", "--mount-proc"};
  int n = 3;
  path_of("d.ini", path);
  path_of("said", said_path);
  while (*before) words[n++] = *before++;
  bool is_script = !strcmp(words[n - 1], "-c");
  if (is_script) words[n++] = "\"$@\"; exit $?", words[n++] = "sh";
  if (words[3] != run) words[n++] = run;
  words[n++] = "--duration", words[n++] = "20", words[n++] = "--config";
  words[n++] = path;
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    setsid(); /* its group ends with the test */
    if (!freopen("/dev/null", "r", stdin) || !freopen(said_path, "w", stdout)) _exit(99);
    dup2(1, 2);
    execvp(words[0], (char *const *)words);
    _exit(99);
  }
  return child;
}

static int end_of(pid_t child) {
  int how;
  ck_assert_int_eq(waitpid(child, &how, 0), child);
  return WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
}

/* Puts `lines` into [device], and the joints and the finger where torque is asked for. */
static void prepare(const char *lines) {
  char text[1024];
  snprintf(text, sizeof text,
           "[device]\ndriver = servo\nmap = d.map\nport = %s\n%s[tracking]\nk_t = 5\nb_t = 0.1\n[limits]\nspeed = 2\n",
           drive.port, lines);
  write_text("d.ini", text);
  drive.words[MOCK_POSITION1 + 1] = 9800; /* 1.571 rad */
  drive.words[MOCK_READING_X] = 0x3A83;   /* 1 mm as a float */
  drive.words[MOCK_READING_X + 1] = 0x126F;
  enabled = 0;
  drive.act = push;
}

static const char *const tini[] = {"tini", "--", NULL}, *const shell[] = {"bash", "-c", NULL},
                         *const script[] = {"tini", "--", "sh", "-c", NULL}, *const first[] = {NULL};
static const char *const *const inits[] = {tini, shell, script};

/* Starts it and waits until the drive holds a torque; returns the process of that name, and its namespace's parent. */
static pid_t push_under(const char *const *before, const char *name, pid_t *child) {
  for (int i = 0; i < TRIES; i++) {
    *child = start(before);
    pid_t found = await(pushes, 10000) ? find(*child, name) : 0;
    if (found) return found;
    kill(*child, SIGKILL);
    (void)end_of(*child);
  }
  ck_abort_msg("the drive never held a torque");
}

/* The program is killed: its guardian lives long enough, and then the namespace ends as it would have. */
TEST_LOOP(test_killed, 0, 3) {
  pid_t child;
  mock_start(&drive, 1);
  prepare("");
  pid_t program = push_under(inits[_i], "ethd-run", &child);
  ck_assert_int_gt(find(program, "ethd-guardian"), 0);
  kill(program, SIGKILL);
  ck_assert(await(rests, 10000));
  ck_assert_int_eq(end_of(child), 128 + SIGKILL);
  ck_assert(said("a guardian process writes zero torque within ") && said("; not when the container is killed"));
  mock_stop(&drive);
}

/* docker stop: an init passes SIGTERM on, and the program ends in order. */
TEST(test_stopped) {
  pid_t child;
  mock_start(&drive, 1);
  prepare("");
  kill(push_under(tini, "tini", &child), SIGTERM);
  ck_assert_int_eq(end_of(child), 0);
  ck_assert(rests());
  mock_stop(&drive);
}

/* The keeper is killed: so is the program. Here bash outlives it, and the guardian acts. */
TEST(test_keeper_killed) {
  pid_t child;
  mock_start(&drive, 1);
  prepare("");
  const char *const stays[] = {"bash", "-c", "\"$@\"; sleep 5", "bash", NULL};
  kill(push_under(stays, "ethd-keeper", &child), SIGKILL);
  ck_assert(await(rests, 10000));
  ck_assert_int_eq(end_of(child), 0);
  mock_stop(&drive);
}

/* The first process itself: nobody outlives it, so the drive isn't enabled unless the configuration says so. */
TEST(test_first) {
  pid_t child;
  mock_start(&drive, 1);
  prepare("");
  ck_assert_int_eq(end_of(start(first)), 1);
  ck_assert(said("ethd-run: device servo: start: this program is the first process (PID 1) of its container") &&
            said("docker run --init or --pid=host, a drive with a watchdog, or device.unguarded = yes"));
  ck_assert(!enabled && rests());
  prepare("home = stop\nq1 = 0\nq2 = 0\n"); /* and it doesn't move to find its joints either */
  const char *const home[] = {run, "--home", NULL};
  ck_assert_int_eq(end_of(start(home)), 1);
  ck_assert(said("the first process (PID 1)") && !enabled);
  prepare("unguarded = yes\n");
  (void)push_under(first, "ethd-run", &child);
  kill(find(child, "ethd-run"), SIGTERM);
  ck_assert_int_eq(end_of(child), 0);
  ck_assert(said("device.unguarded is yes, and here the guardian ends with this program"));
  ck_assert(!said("of this program's end or silence"));
  mock_stop(&drive);
}

/* ---- control groups ---- */

static void group(const char *line, const char *oom_at) {
  char path[256], root[128];
  static const char *const made[] = {"",        "/proc",          "/proc/self",       "/sys",
                                     "/sys/fs", "/sys/fs/cgroup", "/sys/fs/cgroup/a", "/sys/fs/cgroup/a/b.service"};
  path_of("root", root);
  for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
    snprintf(path, sizeof path, "%s%s", root, made[i]);
    mkdir(path, 0700);
  }
  for (int i = 5; i < 8; i++) {
    snprintf(path, sizeof path, "root%s/memory.oom.group", made[i]);
    write_text(path, oom_at && !strcmp(oom_at, made[i]) ? "1\n" : "0\n");
  }
  write_text("root/proc/self/cgroup", line);
}

TEST(test_groups) {
  static const char memory[] = "not when memory runs out: memory.oom.group is 1";
  static const char mixed[] = "not in a service with KillMode=mixed";
  char root[128], out[ETHD_MESSAGE_MAX];
  path_of("root", root);
  group("0::/a/b.service\n", NULL);
  ethd__guardian_limits(root, false, out);
  ck_assert(!strstr(out, memory) && strstr(out, mixed));
  static const char *const places[] = {"/sys/fs/cgroup", "/sys/fs/cgroup/a", "/sys/fs/cgroup/a/b.service"};
  for (int i = 0; i < 3; i++) { /* of the group itself, and of those around it */
    group("9:name=systemd:/x\n0::/a/b.service\n", places[i]);
    ethd__guardian_limits(root, false, out);
    ck_assert(strstr(out, memory) && strstr(out, mixed));
    ethd__guardian_limits(root, true, out); /* the kernel spares it */
    ck_assert(!strstr(out, memory));
  }
  group("0::/\n", places[1]); /* another's group */
  ethd__guardian_limits(root, false, out);
  ck_assert(!strstr(out, memory) && !strstr(out, mixed));
  group("9:name=systemd:/system.slice/e.service\n", NULL); /* before cgroup v2 */
  ethd__guardian_limits(root, false, out);
  ck_assert(strstr(out, mixed) != NULL);
  ethd__guardian_limits("/nowhere", false, out);
  ck_assert(!strstr(out, memory) && !strstr(out, mixed));
}

/* The plant's map without a watchdog, for a machine that may be busy: exchanges are rare, answers have half a second. */
static void write_map(void) {
  char *text, *all;
  size_t length;
  ck_assert(ethd_text_read("apps/config/plant.map", 1 << 16, &text, &length, message) == ETHD_OK);
  const char *watchdog = strstr(text, "[watchdog]"), *registers = strstr(text, "[register control]");
  ck_assert(watchdog && registers);
  ck_assert_int_gt(asprintf(&all,
                            "[bus]\ntransport = rtu\nport = /dev/null\nbaud = 500000\ndivisor = 25\nresponse = 0.5\n"
                            "drain = 0.02\n[watchdog]\nkind = none\n%s",
                            registers),
                   0);
  write_text("d.map", all);
  free(text);
  free(all);
}

FIXTURE(write_map, NULL)

int suite_begin(void) {
  const char *build = getenv("BUILD");
  if (system("unshare -rfp --mount-proc tini -- true") != 0) {
    puts("SKIP: no PID namespace with tini in it can be made here (tini installed? as root?)");
    return 77;
  }
  signal(SIGPIPE, SIG_IGN);
  snprintf(run, sizeof run, "%s/bin/ethd-run", build ? build : "build");
  return !mkdtemp(folder);
}

int suite_end(int failed) {
  char command[128];
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return system(command) != 0 || failed;
}
