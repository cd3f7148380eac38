/* Signals that end a program, and signals that don't. */
#include <errno.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/terminal.h"

volatile sig_atomic_t ethd__stop;
static volatile sig_atomic_t was_refused;

static timer_t again;

static void wake(int number) { (void)number; }

/* A call that waits is ended by the signal, and one that begins to wait later by the timer's. */
static void stop(int number) {
  const struct itimerspec often = {{0, 100000000}, {0, 100000000}};
  if (ethd__stop) _exit(128 + number);
  ethd__stop = 1;
  timer_settime(again, 0, &often, NULL);
}

static void ask(int number) {
  (void)number;
  ethd__stop = 1;
}

static void refuse(int number) {
  (void)number;
  was_refused = 1;
}

/* Only `stop` and `wake` interrupt a system call that waits. The other handlers restart it (SA_RESTART), so that
   no signal interrupts the calls that stop a device. A signal that is ignored at the program's start stays ignored:
   nohup, and a script's &, rely on that. */
static void catch (void (*handler)(int), int number) {
  struct sigaction action = {.sa_handler = handler}, before;
  if (handler != stop && handler != wake) action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  if (sigaction(number, NULL, &before) == 0 && before.sa_handler == SIG_IGN) return;
  sigaction(number, &action, NULL);
}

void ethd__catch_interrupt(void) {
  struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGVTALRM};
  catch (wake, SIGVTALRM);
  if (timer_create(CLOCK_MONOTONIC, &event, &again) != 0) ethd__fail_memory();
  catch (stop, SIGINT);
  catch (stop, SIGTERM);
}

void ethd__catch_end(void) {
  static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) catch (ask, numbers[i]);
  signal(SIGPIPE, SIG_IGN);
}

void ethd__hold_device(void) {
  ethd__catch_end();
  catch (refuse, SIGTSTP);
  signal(SIGTTIN, SIG_IGN);
  signal(SIGTTOU, SIG_IGN);
  if (!ethd__streams_detach()) ethd__fail_memory();
}

void ethd__tell_refusal(void) {
  if (!was_refused) return;
  was_refused = 0;
  fprintf(stderr, "%s: Ctrl-Z is ignored: a stopped program can't control the device; Ctrl-C ends the run\n",
          program_invocation_short_name);
}
