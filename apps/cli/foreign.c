/* Code of plugins in a program: it may never return, and it may end the program. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"

static const char *volatile running; /* NULL: none */
static volatile sig_atomic_t has_run, is_leaving;

/* Prints one line, by calls that a signal handler may use, and ends the program. */
static _Noreturn void fail_now(const char *const words[]) {
  char line[ETHD_MESSAGE_MAX];
  size_t n = 0;
  for (; *words; words++)
    for (const char *p = *words; *p && n < sizeof line - 1; p++) line[n++] = (unsigned char)*p < ' ' ? '?' : *p;
  line[n++] = '\n';
  (void)!write(STDERR_FILENO, line, n);
  _exit(ETHD_EXIT_FAILED);
}

static void too_long(int number) {
  (void)number;
  if (running) fail_now((const char *const[]){program_invocation_short_name, ": ", running, " doesn't return", NULL});
}

static void at_exit(void) {
  if (!has_run || is_leaving) return;
  fail_now((const char *const[]){program_invocation_short_name, ": ", running ? running : "a plugin",
                                 " ended the program", NULL});
}

void ethd__leave(void) { is_leaving = 1; }

void ethd__foreign(const char *what, unsigned patience) {
  static bool ready;
  if (what && !ready) {
    struct sigaction action = {.sa_handler = too_long};
    sigemptyset(&action.sa_mask);
    sigaction(SIGALRM, &action, NULL);
    ready = atexit(at_exit) == 0;
  }
  if (what) has_run = 1;
  running = what;
  alarm(what ? patience : 0);
}
