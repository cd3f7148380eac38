#include "text/text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/error_text.h"
#include "text/file.h"

/* ---- reading ---- */

#define PIPE_MAX ((size_t)1 << 30) /* bytes of what isn't a regular file */

static ethd_status too_long(const char *path, size_t most, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: too long, at most %zu bytes are allowed", path, most);
}

static bool read_part(int fd, char *to, off_t at, off_t end) {
  while (at < end) {
    ssize_t got = pread(fd, to + at, (size_t)(end - at), at);
    if (got < 0) return false;
    if (got == 0) break;
    at += got;
  }
  return true;
}

/* Reads what is on the disk. A file's holes are zeros that take no room there, and none here: the memory of calloc is
   zero before it is touched. */
static char *read_regular(int fd, size_t size) {
  char *text = calloc(size + 1, 1);
  off_t end = (off_t)size, data = 0, hole;
  for (off_t at = 0; text && at < end; at = hole) {
    data = lseek(fd, at, SEEK_DATA);
    if (data < 0 && errno == ENXIO) break;
    if (data < 0) data = at; /* the file system doesn't tell */
    hole = lseek(fd, data, SEEK_HOLE);
    if (hole < 0 || hole > end) hole = end;
    if (read_part(fd, text, data, hole)) continue;
    free(text);
    return NULL;
  }
  return text;
}

/* Returns bytes that were read, 0 at the end, -1: errno. Waits for a pipe's other end; a signal ends the wait. */
static ssize_t read_some(int fd, char *to, size_t most) {
  struct pollfd wait = {.fd = fd, .events = POLLIN};
  ssize_t got;
  do {
    if (poll(&wait, 1, -1) < 0) return -1;
    got = read(fd, to, most);
  } while (got < 0 && errno == EAGAIN);
  return got;
}

static ethd_status read_stream(int fd, const char *path, size_t most, char **text, size_t *length, char *message) {
  size_t room = 65536, n = 0;
  ssize_t got = 0;
  char *buffer = malloc(room);
  while (buffer && n <= most && (got = read_some(fd, buffer + n, room - 1 - n)) > 0) {
    n += (size_t)got;
    char *more = n == room - 1 ? realloc(buffer, room *= 2) : buffer;
    if (!more) free(buffer);
    buffer = more;
  }
  if (!buffer) return ethd__no_memory(message, path);
  if (got < 0 || n > most) {
    free(buffer);
    return got < 0 ? ethd__file_refuse(path, message) : too_long(path, most, message);
  }
  buffer[n] = 0;
  *text = buffer;
  *length = n;
  return ETHD_OK;
}

static ethd_status read_file(int fd, const char *path, size_t size, char **text, size_t *length, char *message) {
  errno = 0;
  *text = read_regular(fd, size);
  if (*text) *length = size;
  return *text ? ETHD_OK : errno && errno != ENOMEM ? ethd__file_refuse(path, message) : ethd__no_memory(message, path);
}

/* Editors on Windows put a mark before UTF-8, and may write UTF-16. */
static ethd_status take_mark(const char *path, char **text, size_t *length, char *message) {
  static const char utf8[] = "\xEF\xBB\xBF";
  if (*length >= 3 && !memcmp(*text, utf8, 3)) {
    *length -= 3;
    memmove(*text, *text + 3, *length + 1);
  }
  if (*length < 2 || (memcmp(*text, "\xFF\xFE", 2) && memcmp(*text, "\xFE\xFF", 2))) return ETHD_OK;
  free(*text);
  *text = NULL;
  *length = 0;
  return ethd__say(message, ETHD_E_FILE, "%s: its text is UTF-16: save it as UTF-8", path);
}

ethd_status ethd_text_read(const char *path, size_t most, char **text, size_t *length, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  ethd_status status;
  *text = NULL;
  *length = 0;
  int fd = ethd__file_read(path, &info, message);
  if (fd < 0) return ETHD_E_FILE;
  size_t size = (size_t)info.st_size;
  if (S_ISREG(info.st_mode) && size > most)
    status = ethd__say(message, ETHD_E_FILE, "%s: %zu bytes, at most %zu are allowed", path, size, most);
  else if (S_ISREG(info.st_mode) && size) /* the kernel's own files say 0 */
    status = read_file(fd, path, size, text, length, message);
  else
    status = read_stream(fd, path, most < PIPE_MAX ? most : PIPE_MAX, text, length, message);
  close(fd);
  return status ? status : take_mark(path, text, length, message);
}

/* ---- numbers and paths ---- */

static const char *digits(const char *p, const char *end) {
  while (p < end && isdigit((unsigned char)*p)) p++;
  return p;
}

const char *ethd__decimal(const char *p, const char *end) {
  const char *whole = p;
  p = digits(p, end);
  size_t count = (size_t)(p - whole);
  if (p < end && *p == '.') {
    const char *fraction = ++p;
    p = digits(p, end);
    count += (size_t)(p - fraction);
  }
  if (!count) return NULL;
  if (p < end && (*p == 'e' || *p == 'E')) {
    p++;
    if (p < end && (*p == '+' || *p == '-')) p++;
    const char *exponent = p;
    p = digits(p, end);
    if (p == exponent) return NULL;
  }
  return p;
}

static bool is_word(const char *text, size_t length, const char *word) {
  return length == strlen(word) && strncasecmp(text, word, length) == 0;
}

bool ethd__number(const char *text, size_t length, double *out) {
  const char *p = text, *end = text + length;
  if (is_word(text, length, "nan")) return *out = NAN, true;
  if (p < end && (*p == '+' || *p == '-')) p++;
  if (is_word(p, (size_t)(end - p), "inf")) return *out = *text == '-' ? -INFINITY : INFINITY, true;
  if (ethd__decimal(p, end) != end) return false;
  *out = strtod(text, NULL);
  return isfinite(*out);
}

bool ethd__whole(const char *text, size_t length, double *out) {
  if (length > 2 && length <= 10 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
    *out = strtod(text, NULL);
    return strspn(text + 2, "0123456789abcdefABCDEF") == length - 2;
  }
  return ethd__number(text, length, out) && *out == rint(*out);
}

bool ethd__text_is_word(const char *text, size_t most, const char *letters) {
  size_t n = text ? strnlen(text, most + 1) : 0;
  return n >= 1 && n <= most && strspn(text, letters) == n;
}

bool ethd__text_is_line(const char *text, size_t most) {
  size_t n = text ? strnlen(text, most + 1) : 0;
  for (size_t i = 0; i < n; i++)
    if (text[i] < ' ' || text[i] > '~') return false;
  return n >= 1 && n <= most;
}

char *ethd__path_join(const char *folder, const char *path) {
  char *joined;
  if (path[0] == '/' || !folder || !folder[0]) return strdup(path);
  return asprintf(&joined, "%s/%s", folder, path) < 0 ? NULL : joined;
}

char *ethd__path_folder(const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash) return strdup(".");
  return slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
}
