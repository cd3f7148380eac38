/* Terminals obey sequences of control characters, and names of files, words of files and plugins may hold some. */
#ifndef ETHD_APPS_TERMINAL_H
#define ETHD_APPS_TERMINAL_H

/* From here on a terminal behind stdout or stderr gets ? for each of them, but for tabs and line ends. [main] */
void ethd__terminals_plain(void);

#endif
