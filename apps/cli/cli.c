#include "cli/cli.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "cli/terminal.h"
#include "clock.h"
#include "denormals.h"
#include "ethd/ethd.h"
#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

void ethd__flush_denormals(void) { (void)ethd__denormals_flush(); }

/* Opens / on each of the descriptors 0 to 2 that is closed. Otherwise a file of ours could get number 1, and standard
   output would go into it. O_PATH allows neither reading nor writing. */
static void keep_streams(void) {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
    if (fcntl(fd, F_GETFD) < 0) (void)!open("/", O_PATH | O_CLOEXEC);
}

#define STACK ((rlim_t)1 << 20) /* bytes that any program or thread of ours may need */

/* Threads get the limit with which the program began. */
static bool widen_threads(void) {
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes)) return false;
  bool good = !pthread_attr_setstacksize(&attributes, STACK) && !pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  return good;
}

/* A stack that is too small would end the program somewhere by SIGSEGV. */
static void need_stack(void) {
  struct rlimit now, wanted;
  if (getrlimit(RLIMIT_STACK, &now) || now.rlim_cur >= STACK) return;
  wanted = (struct rlimit){STACK, now.rlim_max < STACK ? STACK : now.rlim_max};
  if (!setrlimit(RLIMIT_STACK, &wanted) && widen_threads()) return;
  ethd__fail(ETHD_EXIT_FAILED, "the stack may have %ju kB, %ju are needed: ulimit -s %ju",
             (uintmax_t)now.rlim_cur >> 10, (uintmax_t)STACK >> 10, (uintmax_t)STACK >> 10);
}

void ethd__begin(void) {
  keep_streams();
  need_stack();
  signal(SIGXFSZ, SIG_IGN);
  if (!ethd__terminals_plain()) ethd__fail_memory();
  argp_program_version = "libethd " ETHD_VERSION;
  argp_err_exit_status = ETHD_EXIT_INPUT;
  ethd__flush_denormals();
  ethd__foreign_code = ethd__foreign;
}

int ethd__end(int code) {
  ethd__leave();
  uint64_t dropped = 0;
  bool failed = fflush(stdout) != 0 || ferror(stdout);
  int reason = failed ? errno ? errno : EIO : ethd__stdout_end(&dropped);
  if (!reason && !dropped) return code;
  if (reason)
    fprintf(stderr, "%s: standard output: %s\n", program_invocation_short_name, strerror(reason));
  else
    fprintf(stderr, "%s: standard output: its reader is too slow, and %" PRIu64 " bytes are lost\n",
            program_invocation_short_name, dropped);
  return code ? code : ETHD_EXIT_FAILED;
}

void ethd__fail(int code, const char *format, ...) {
  char message[ETHD_MESSAGE_MAX];
  va_list args;
  va_start(args, format);
  ethd__say_all(message, format, args);
  va_end(args);
  fflush(stdout);
  fprintf(stderr, "%s: %s\n", program_invocation_short_name, message);
  ethd__leave();
  exit(code);
}

void ethd__fail_memory(void) { ethd__fail(ETHD_EXIT_FAILED, "%s", ethd_status_sentence(ETHD_E_MEMORY)); }

char *ethd__folder_path(const char *folder, const char *name) {
  char *path = ethd__path_join(folder, name);
  if (!path) ethd__fail_memory();
  return path;
}

FILE *ethd__print_begin(ethd__printed *p) {
  p->file = open_memstream(&p->text, &p->length);
  if (!p->file) ethd__fail_memory();
  return p->file;
}

char *ethd__print_end(ethd__printed *p) {
  bool failed = ferror(p->file);
  if (fclose(p->file) || failed) ethd__fail_memory();
  return p->text;
}

int ethd__exit_code(ethd_status status) {
  switch (status) {
  case ETHD_E_MEMORY:
  case ETHD_E_LAW:
  case ETHD_E_BUDGET:
  case ETHD_E_FULL:
  case ETHD_E_DEVICE:
  case ETHD_E_UNFINISHED:
  case ETHD_E_DIFFERS: return ETHD_EXIT_FAILED;
  default: return status < 0 ? ETHD_EXIT_INPUT : ETHD_EXIT_DONE;
  }
}

void ethd__need(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

void ethd__must(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

/* ---- option values ---- */

double ethd__option_number(const char *option, const char *text, double min, double max) {
  char quote[ETHD_QUOTE_MAX];
  double value;
  if (!ethd__number(text, strlen(text), &value) || !(value >= min && value <= max))
    ethd__fail(ETHD_EXIT_INPUT, "%s: found %s, a number from %.10g to %.10g is allowed", option,
               ethd__quote(text, strlen(text), quote), min, max);
  return value;
}

static bool whole(const char *text, bool negative_too) {
  if (negative_too && *text == '-') text++;
  return *text && !text[strspn(text, "0123456789")];
}

int64_t ethd__option_integer(const char *option, const char *text, int64_t min, int64_t max) {
  char quote[ETHD_QUOTE_MAX];
  errno = 0;
  int64_t value = strtoimax(text, NULL, 10);
  if (!whole(text, true) || errno || value < min || value > max)
    ethd__fail(ETHD_EXIT_INPUT, "%s: found %s, a whole number from %" PRId64 " to %" PRId64 " is allowed", option,
               ethd__quote(text, strlen(text), quote), min, max);
  return value;
}

uint64_t ethd__option_seed(const char *option, const char *text) {
  char quote[ETHD_QUOTE_MAX];
  errno = 0;
  uint64_t value = strtoumax(text, NULL, 10);
  if (!whole(text, false) || errno)
    ethd__fail(ETHD_EXIT_INPUT, "%s: found %s, a whole number from 0 to %" PRIu64 " is allowed", option,
               ethd__quote(text, strlen(text), quote), UINT64_MAX);
  return value;
}

const char *ethd__option_picture(const char *option, const char *text) {
  char quote[ETHD_QUOTE_MAX];
  size_t n = strlen(text);
  if (n < 5 || strcmp(text + n - 4, ".png") != 0 || strchr("|<", *text))
    ethd__fail(ETHD_EXIT_INPUT, "%s: found %s, a file .png is needed", option, ethd__quote(text, n, quote));
  return text;
}

char *ethd__picture_table(const char *png) {
  char *csv = strdup(png);
  if (!csv) ethd__fail_memory();
  memcpy(csv + strlen(csv) - 4, ".csv", 4);
  return csv;
}

void ethd__refuse_input(const char *option, const char *output, const char *input_option, const char *input) {
  struct stat out, in;
  if (!output || !input || stat(output, &out) != 0 || stat(input, &in) != 0) return;
  if (!S_ISREG(out.st_mode) || out.st_ino != in.st_ino || out.st_dev != in.st_dev) return;
  ethd__fail(ETHD_EXIT_INPUT, "%s: %s is the file of %s, which is only read; another name is needed", option, output,
             input_option);
}

static bool is_same_folder(const char *a, const char *b) {
  struct stat info, other;
  char *folders[] = {ethd__path_folder(a), ethd__path_folder(b)};
  if (!folders[0] || !folders[1]) ethd__fail_memory();
  bool same = stat(folders[0], &info) == 0 && stat(folders[1], &other) == 0 && info.st_ino == other.st_ino &&
              info.st_dev == other.st_dev;
  free(folders[0]);
  free(folders[1]);
  return same;
}

/* Devices and pipes take what several write. */
static bool is_same_file(const char *a, const char *b) {
  struct stat info, other;
  bool is_there = stat(a, &info) == 0, other_is_there = stat(b, &other) == 0;
  const char *slash = strrchr(a, '/'), *other_slash = strrchr(b, '/');
  if (is_there != other_is_there) return false;
  if (is_there) return S_ISREG(info.st_mode) && info.st_ino == other.st_ino && info.st_dev == other.st_dev;
  return !strcmp(slash ? slash + 1 : a, other_slash ? other_slash + 1 : b) && is_same_folder(a, b);
}

void ethd__refuse_same(const char *option, const char *output, const char *other_option, const char *other) {
  if (output && other && is_same_file(output, other))
    ethd__fail(ETHD_EXIT_INPUT, "%s: %s is the file of %s, too; another name is needed", option, output, other_option);
}

void ethd__option_list(const char *option, const char *text, void (*each)(const char *word, void *user), void *user) {
  ETHD__FREED char *words = strdup(text);
  char *rest = words, *word;
  if (!words) ethd__fail_memory();
  while ((word = strsep(&rest, ","))) {
    if (!*word) ethd__fail(ETHD_EXIT_INPUT, "%s: an empty word in the list", option);
    each(word, user);
  }
}

/* ---- files that came with the programs ---- */

static char *data_folder(void) {
  const char *given = getenv("ETHD_DATA_DIR");
  char program[4096];
  if (given && *given) return strdup(given);
  ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = 0;
  ETHD__FREED char *bin = ethd__path_folder(program);
  return bin ? ethd__path_join(bin, "../share/ethd") : NULL;
}

static char *in_data_folder(const char *name) {
  ETHD__FREED char *folder = data_folder();
  char *path = folder ? ethd__path_join(folder, name) : NULL;
  if (!path) ethd__fail_memory();
  return path;
}

static char *copy_of(const char *text) {
  char *copy = strdup(text);
  if (!copy) ethd__fail_memory();
  return copy;
}

void ethd__receive(const char *folder) {
  if (!folder) return;
  ethd__received *received = malloc(sizeof *received);
  if (!received) ethd__fail_memory();
  ethd__received_enter(received, folder);
}

char *ethd__given_or_data(const char *name) {
  char *path = !*name || access(name, R_OK) == 0 ? NULL : in_data_folder(name);
  if (path && access(path, R_OK) == 0) return path;
  free(path);
  return copy_of(name);
}

void ethd__need_plane(const ethd_config *config) {
  if (config->is_space)
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: [space] is for a device in space, and this program works in the plane; ethd-run, ethd-conform, "
               "ethd-check and ethd-replay --verify take it",
               config->path ? config->path : "configuration");
}

void ethd__need_recording(const char *folder) {
  ETHD__FREED char *ticks = NULL;
  if (asprintf(&ticks, "%s/tick.npy", folder) < 0) ethd__fail_memory();
  if (!ethd__file_taken(ticks))
    ethd__fail(ETHD_EXIT_INPUT, "%s: no recording, whose tick.npy is needed: %s; ethd-run --record makes one", folder,
               strerror(errno));
}

char *ethd__motion_folder(void) {
  const char *given = getenv("ETHD_MOTION_DIR"), *larger = "../shared/motion";
  if (given && *given) return copy_of(given);
  return access(larger, R_OK) == 0 ? copy_of(larger) : in_data_folder("motion");
}

char *ethd__data_path(const char *name) {
  char *path = in_data_folder(name);
  if (access(path, R_OK) != 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s; ETHD_DATA_DIR may name its folder", path, strerror(errno));
  return path;
}

/* ---- progress ---- */

void ethd__progress(uint64_t done, uint64_t total, const char *what) {
  static double shown;
  if (!isatty(STDERR_FILENO)) return;
  double t = 1e-9 * (double)ethd__clock_now();
  if (done >= total) {
    if (shown > 0) ethd__terminal_erase_line();
    shown = 0;
  } else if (t - shown >= 0.1) {
    double share = (double)done / (double)total;
    int filled = (int)(share * 40);
    fflush(stderr);
    ethd__terminal_erase_line();
    fprintf(stderr, "%s [%.*s%*s] %3.0f %%", what, filled, "########################################", 40 - filled, "",
            100 * share);
    shown = t;
  }
  fflush(stderr);
}
