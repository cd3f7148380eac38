/* Keeps control characters from terminals, which obey sequences of them. Names of files, and words of files and
   plugins, may hold some. */
#ifndef ETHD__APPS_CLI_TERMINAL_H
#define ETHD__APPS_CLI_TERMINAL_H

#include <stdbool.h>

/* From here on a terminal at stdout or stderr gets ? for each of them except tabs and line ends. Returns false without
   memory. [main] */
bool ethd__terminals_plain(void);

#endif
