/* Standard output and standard error. A terminal obeys control sequences, and names or words from files and plugins may
   contain them, so control characters are not sent to a terminal. A reader that doesn't read never blocks a program
   that moves a device. */
#ifndef ETHD__APPS_CLI_TERMINAL_H
#define ETHD__APPS_CLI_TERMINAL_H

#include <stdbool.h>
#include <stdint.h>

/* From here on a terminal at stdout or stderr gets ? for each control character except tabs and line ends. Returns
   false without memory. [main] */
bool ethd__terminals_plain(void);

/* From here on threads write what goes to stdout and stderr; no print waits any more. Returns false without memory.
   [main] */
bool ethd__streams_detach(void);

/* Waits until all of stdout is written, as long as its reader reads. Returns 0, or errno of a failed write; *dropped: bytes that were not read in time. Flushes nothing. [main] */
int ethd__stdout_end(uint64_t *dropped);

/* Clears the cursor's line of the terminal on stderr. [any] */
void ethd__terminal_erase_line(void);

/* Returns false while the program is in the background of the terminal at stdin, whose lines then belong to other
   programs. [any] */
bool ethd__stdin_is_ours(void);

#endif
