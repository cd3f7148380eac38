#include "text/error_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define HEAD 200 /* bytes of a cut message before the cut */

static void keep_one_line(char *text) {
  for (; *text; text++)
    if ((unsigned char)*text < 0x20 || *text == 0x7f) *text = '?';
}

/* A path may be longer than a message. Then its middle is left out, since its ends say more. */
void ethd__say_all(char message[ETHD_MESSAGE_MAX], const char *format, va_list args) {
  ETHD__FREED char *whole = NULL;
  int length = vasprintf(&whole, format, args);
  if (length < 0) {
    snprintf(message, ETHD_MESSAGE_MAX, "%s", ethd_status_sentence(ETHD_E_MEMORY));
    return;
  }
  if (length < ETHD_MESSAGE_MAX)
    memcpy(message, whole, (size_t)length + 1);
  else
    snprintf(message, ETHD_MESSAGE_MAX, "%.*s...%s", HEAD, whole, whole + length - (ETHD_MESSAGE_MAX - 4 - HEAD));
  keep_one_line(message);
}

ethd_status ethd__say(char message[ETHD_MESSAGE_MAX], ethd_status status, const char *format, ...) {
  va_list args;
  va_start(args, format);
  ethd__say_all(message, format, args);
  va_end(args);
  return status;
}

ethd_status ethd__no_memory(char message[ETHD_MESSAGE_MAX], const char *name) {
  return ethd__say(message, ETHD_E_MEMORY, "%s%s%s", name ? name : "", name ? ": " : "",
                   ethd_status_sentence(ETHD_E_MEMORY));
}

const char *ethd__quote(const char *word, size_t length, char out[ETHD_QUOTE_MAX]) {
  const size_t room = ETHD_QUOTE_MAX - 6;
  size_t shown = length < room ? length : room, n = 0;
  out[n++] = '"';
  for (size_t i = 0; i < shown; i++) out[n++] = word[i] >= ' ' && word[i] <= '~' ? word[i] : '?';
  if (shown < length) {
    memcpy(out + n, "...", 3);
    n += 3;
  }
  out[n++] = '"';
  out[n] = 0;
  return out;
}

/* Writes the numbers of an error that aren't NaN. */
static void numbers(const ethd_error *error, char *out, size_t room) {
  int n = 0;
  out[0] = 0;
  if (error->found == error->found) n = snprintf(out, room, "; found %.10g", error->found);
  if (error->min == error->min && error->max == error->max)
    snprintf(out + n, room - (size_t)n, "%c allowed %.10g to %.10g", n ? ',' : ';', error->min, error->max);
}

void ethd_error_text(const char *file, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  char name[ETHD_QUOTE_MAX + sizeof error->name + 4] = "", range[120], place[24] = "";
  if (error->line > 0) snprintf(place, sizeof place, "%d:", error->line);
  if (error->name[0]) snprintf(name, sizeof name, "%.*s: ", (int)sizeof error->name, error->name);
  numbers(error, range, sizeof range);
  ethd__say(message, error->status, "%s%s%s%s%s%s%s", file ? file : "", file ? ":" : "", place,
            file || place[0] ? " " : "", name, ethd_status_sentence(error->status), range);
}
