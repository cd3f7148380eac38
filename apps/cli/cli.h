/* Shared by all programs: argp's settings, one-line failures, strict option values, progress, Ctrl-C.

   Exit codes: 0 done, 1 the job failed, 2 wrong usage or bad input. All [main]. */
#ifndef ETHD__APPS_CLI_CLI_H
#define ETHD__APPS_CLI_CLI_H

#include <argp.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "ethd/config.h"
#include "text/freed.h"

enum { ETHD_EXIT_DONE = 0, ETHD_EXIT_FAILED = 1, ETHD_EXIT_INPUT = 2 };

/* Comes first in main. Sets version text, exit code of wrong usage, FTZ and DAZ; makes a full quota an error of write
   instead of a signal that ends the program; keeps control characters on stdout and stderr from a terminal. */
void ethd__begin(void);

/* Announces that a plugin's code runs on this thread from here on (`what`: its name for people), or no longer (NULL).
   If it doesn't return within `patience` s, the program says so and exits 1. Once it has run, a plugin can call exit at
   any time; such an exit is reported and becomes exit 1. ethd__begin hooks this into the reading of configurations. */
void ethd__foreign(const char *what, unsigned patience);

/* Announces the program's own exit. */
void ethd__leave(void);

/* Comes last in main: `return ethd__end(code)`. Exits 1 if stdout could not be written. */
int ethd__end(int code);

/* Prints "program: message" as one line on stderr and exits. */
_Noreturn void ethd__fail(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same for "no memory". */
_Noreturn void ethd__fail_memory(void);

/* Returns folder/name, which the caller frees; exits 1 without memory. */
char *ethd__folder_path(const char *folder, const char *name);

/* A text that is printed into memory; its end returns it, which the caller frees. Exit 1 without memory. */
typedef struct ethd__printed {
  FILE *file;
  char *text;
  size_t length;
} ethd__printed;

FILE *ethd__print_begin(ethd__printed *out);
char *ethd__print_end(ethd__printed *out);

/* Returns the exit code for a failure of the library or of drivers: 1 for no memory, device and the like, else 2. */
int ethd__exit_code(ethd_status status);

/* Exits with this code and the message where the status is a failure. */
void ethd__need(ethd_status status, const char *message);

/* Does the same with 1: it isn't the input's fault. */
void ethd__must(ethd_status status, const char *message);

/* Each reads an option's value or exits 2: "--taps: found "x", a whole number from 1 to 1000 is allowed". */
double ethd__option_number(const char *option, const char *text, double min, double max);
int64_t ethd__option_integer(const char *option, const char *text, int64_t min, int64_t max);
uint64_t ethd__option_seed(const char *option, const char *text);

/* Returns a picture's file, which must end in .png and not begin like a command (| or <); else exits 2. */
const char *ethd__option_picture(const char *option, const char *text);

/* Returns the path of a picture's table, with .csv for .png, which the caller frees; exits 1 without memory. */
char *ethd__picture_table(const char *png);

/* Exits 2 if the output is the input's file; NULL: there is none. */
void ethd__refuse_input(const char *option, const char *output, const char *input_option, const char *input);

/* Exits 2 if two outputs are one file, so that the second would replace the first; NULL: no such output. */
void ethd__refuse_same(const char *option, const char *output, const char *other_option, const char *other);

/* Calls `each` for every word of a comma-separated list; exit 2 on an empty word. */
void ethd__option_list(const char *option, const char *text, void (*each)(const char *word, void *user), void *user);

/* Returns the path of a file that is installed with the programs ("n.ini"): $ETHD_DATA_DIR/NAME, else
   ../share/ethd/NAME beside the program's folder. The caller frees it; exits 1 if the file is missing. */
char *ethd__data_path(const char *name);

/* Returns the named file or, if it is missing, the installed one of that name. The caller frees it. */
char *ethd__given_or_data(const char *name);

/* Marks the folder as received from others: from here on no link below it is followed, and only regular files
   are read and replaced there (text/file.h). NULL: none. */
void ethd__receive(const char *folder);

/* For a program of the plane alone: exits 2 at a configuration of the front in space. */
void ethd__need_plane(const ethd_config *config);

/* Exits 2 unless the folder holds a recording. */
void ethd__need_recording(const char *folder);

/* Returns the folder of recorded movements: $ETHD_MOTION_DIR, ../shared/motion, or the installed one. The caller frees
   it. */
char *ethd__motion_folder(void);

/* Draws a bar on stderr if that is a terminal, at most ten times a second; done = total removes it. */
void ethd__progress(uint64_t done, uint64_t total, const char *what);

/* Makes Ctrl-C and SIGTERM set ethd__stop from here on, and end every wait, for a file, a pipe or another program; a
   second signal ends the program at once. Here and below, a signal that is ignored when the program starts stays
   ignored. */
void ethd__catch_interrupt(void);

/* For a program that moves a device, before it opens a file or starts a thread: in a container the program goes on as
   the child of a process that ends when a drive's guardian has ended, too (cli/keeper.c). Elsewhere nothing happens. */
void ethd__container_keeper(void);

/* For a program that moves a device: makes these, SIGHUP, SIGQUIT, SIGUSR1 and SIGUSR2 set it, however often they come,
   so that nothing cuts a controlled stop short. A reader of our output that goes away ends nothing. */
void ethd__catch_end(void);

/* The same for a program that moves a device in real time, which neither a terminal nor a reader of its output may hold
   up: Ctrl-Z doesn't stop it, nor does the terminal when it runs in the background, and no print waits (terminal.h). */
void ethd__hold_device(void);

/* Prints that Ctrl-Z is ignored, if it was pressed. */
void ethd__tell_refusal(void);
extern volatile sig_atomic_t ethd__stop;

/* Makes subnormals count as 0 on this thread; ethd__begin does so for the main thread. */
void ethd__flush_denormals(void);

#endif
