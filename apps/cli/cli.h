/* What all programs share: argp's settings, one-line failures, strict option values, progress, Ctrl-C.

   Exit 0 done, 1 the job failed, 2 wrong usage or bad input. All [main]. */
#ifndef ETHD_APPS_CLI_H
#define ETHD_APPS_CLI_H

#include <argp.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#include "ethd/config.h"

enum { ETHD_EXIT_DONE = 0, ETHD_EXIT_FAILED = 1, ETHD_EXIT_INPUT = 2 };

/* First in main: version text, exit code of wrong usage, FTZ and DAZ; a full quota is an answer of write, not the end; a
   terminal gets no control characters from stdout and stderr. */
void ethd__begin(void);

/* Code of a plugin runs on this thread from here on (what it is, for people), or no longer (NULL): if it doesn't return
   within 5 s, the program says so and exits 1. Once it has run, an exit that isn't the program's own, which a plugin
   can call at any time, is said and becomes exit 1. ethd__begin hooks it into the reading of configurations. */
void ethd__foreign(const char *what);

/* The program ends by its own will. */
void ethd__leave(void);

/* Last in main: `return ethd__end(code)`. Exit 1 when stdout could not be written. */
int ethd__end(int code);

/* "program: message" as one line on stderr, then exit. */
_Noreturn void ethd__fail(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same for no memory. */
_Noreturn void ethd__fail_memory(void);

/* Exit code for a failure of the library or of drivers: 1 for no memory, device and the like, else 2. */
int ethd__exit_code(ethd_status status);

/* Option values, or exit 2: "--taps: found "x", a whole number from 1 to 1000 is allowed". */
double ethd__option_number(const char *option, const char *text, double min, double max);
int64_t ethd__option_integer(const char *option, const char *text, int64_t min, int64_t max);
uint64_t ethd__option_seed(const char *option, const char *text);

/* A picture's file, which ends in .png and begins like no command; else exit 2. */
const char *ethd__option_picture(const char *option, const char *text);

/* Exit 2 when the output is the input's file; NULL is none. */
void ethd__refuse_input(const char *option, const char *output, const char *input_option, const char *input);

/* Calls `each` for every word of a comma-separated list; exit 2 on an empty word. */
void ethd__option_list(const char *option, const char *text, void (*each)(const char *word, void *user), void *user);

/* A file that came with the programs ("n.ini"): $ETHD_DATA_DIR/NAME, else ../share/ethd/NAME beside the
   program's folder. Freed by the caller; exit 1 when it isn't there. */
char *ethd__data_path(const char *name);

/* The file as it is named, or, where there is none, one of that name that came with the programs. Freed by the caller. */
char *ethd__given_or_data(const char *name);

/* The folder of recorded movements: $ETHD_MOTION_DIR, ../shared/motion, or the one that came with the programs. Freed by
   the caller. */
char *ethd__motion_folder(void);

/* A bar on stderr when that is a terminal, else nothing; redrawn at most ten times a second. done =
   total removes it. */
void ethd__progress(uint64_t done, uint64_t total, const char *what);

/* From here on Ctrl-C and SIGTERM set ethd__stop; a second one ends the program at once. */
void ethd__catch_interrupt(void);

/* For what moves: these, SIGHUP, SIGQUIT, SIGUSR1 and SIGUSR2 set it, as often as they come: a stop under control isn't cut short. A
   reader of our lines that leaves ends nothing. */
void ethd__catch_end(void);
extern volatile sig_atomic_t ethd__stop;

/* Subnormals count as 0 on this thread (ethd__begin did it for the main thread). */
void ethd__flush_denormals(void);

#endif
