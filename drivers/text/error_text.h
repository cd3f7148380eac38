/* Sentences for people: always one line, never longer than ETHD_MESSAGE_MAX. */
#ifndef ETHD_FILE_ERROR_TEXT_H
#define ETHD_FILE_ERROR_TEXT_H

#include <stdarg.h>

#include "ethd/config.h"

#define ETHD_QUOTE_MAX 56 /* bytes that ethd__quote writes at most, the closing 0 included */

/* printf into message, control characters replaced; returns `status`. [main] */
ethd_status ethd__say(char message[ETHD_MESSAGE_MAX], ethd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* "NAME: no memory", without a name where it is NULL; returns ETHD_E_MEMORY. [main] */
ethd_status ethd__no_memory(char message[ETHD_MESSAGE_MAX], const char *name);

/* The same without a status; a message that is too long loses its middle. [main] */
void ethd__say_all(char message[ETHD_MESSAGE_MAX], const char *format, va_list args)
    __attribute__((format(printf, 2, 0)));

/* A word of the input for a message: in quotes, cut to fit, anything but printable ASCII as '?'. [any] */
const char *ethd__quote(const char *word, size_t length, char out[ETHD_QUOTE_MAX]);

#endif
