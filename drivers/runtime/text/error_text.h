/* Sentences for people: always one line, never longer than ETHD_MESSAGE_MAX. */
#ifndef ETHD__TEXT_ERROR_TEXT_H
#define ETHD__TEXT_ERROR_TEXT_H

#include <stdarg.h>

#include "ethd/config.h"
#include "text/freed.h"

#define ETHD_QUOTE_MAX 56 /* bytes that ethd__quote writes at most, the closing 0 included */

/* Prints into message, like printf, with control characters replaced; returns `status`. [main] */
ethd_status ethd__say(char message[ETHD_MESSAGE_MAX], ethd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Writes "NAME: no memory", without the name if it is NULL; returns ETHD_E_MEMORY. [main] */
ethd_status ethd__no_memory(char message[ETHD_MESSAGE_MAX], const char *name);

/* Prints like ethd__say, without a status; a message that is too long loses its middle. [main] */
void ethd__say_all(char message[ETHD_MESSAGE_MAX], const char *format, va_list args)
    __attribute__((format(printf, 2, 0)));

/* Prepares a word of the input for a message: in quotes, cut to fit, with '?' for all but printable ASCII. [any] */
const char *ethd__quote(const char *word, size_t length, char out[ETHD_QUOTE_MAX]);

#endif
