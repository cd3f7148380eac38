/* Serial lines, on a pty. */
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "serial/line.h"
#include "unit/pty.h"
#include "unit/rig.h"

static char message[ETHD_MESSAGE_MAX], path[64];

/* ---- a line that has another rate than it was asked for, as some adapters do ---- */

enum { GET_TERMIOS2 = 0x2a, INPUT_SPEED = 36 }; /* the request's last byte; where struct termios2 has it */

static uint32_t rate; /* 0: as it was asked for */

int ioctl(int fd, unsigned long request, ...) {
  va_list args;
  va_start(args, request);
  char *what = va_arg(args, char *);
  va_end(args);
  int result = (int)syscall(SYS_ioctl, fd, request, what);
  if (result == 0 && rate && (request & 0xff) == GET_TERMIOS2 && request > 0xffff) {
    memcpy(what + INPUT_SPEED, &rate, sizeof rate);
    memcpy(what + INPUT_SPEED + sizeof rate, &rate, sizeof rate);
  }
  return result;
}

/* A rate is right within 2 %: 115384 is what 48 MHz give for 115200. 9600 for a rate that the line doesn't know isn't. */
TEST(test_another_rate) {
  static const struct {
    uint32_t asked, has;
    bool good;
  } rows[] = {{115200, 115384, true}, {115200, 113000, true},  {500000, 490000, true},
              {500000, 510000, true}, {500000, 489999, false}, {500000, 510001, false},
              {500000, 9600, false},  {9800, 9600, false},     {115200, 230400, false}};
  char expected[ETHD_MESSAGE_MAX];
  int master = pty_open(NULL, path), fd;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    rate = rows[i].has;
    ethd_status status = ethd__line_open(path, ETHD__LINE_8N1, rows[i].asked, &fd, message);
    rate = 0;
    ck_assert_msg(status == (rows[i].good ? ETHD_OK : ETHD_E_DEVICE), "%u for %u", rows[i].has, rows[i].asked);
    ck_assert_int_eq(fd >= 0, rows[i].good);
    if (fd >= 0) close(fd);
    if (rows[i].good) continue;
    snprintf(expected, sizeof expected,
             "%s: %u baud requested, the line has %u, over 2 %% away; choose a rate that the line supports", path,
             rows[i].asked, rows[i].has);
    ck_assert_str_eq(message, expected);
  }
  close(master);
}

TEST(test_any_rate) {
  static const uint32_t rates[] = {9600, 115200, 250000, 400000, 500000, 1000000, 2000000, 12345};
  int master = pty_open(NULL, path), fd;
  ck_assert_int_ge(master, 0);
  for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
    struct termios t;
    ck_assert_msg(ethd__line_open(path, ETHD__LINE_8N1, rates[i], &fd, message) == ETHD_OK, "%s", message);
    ck_assert_int_eq(tcgetattr(fd, &t), 0);
    ck_assert(!(t.c_lflag & (ICANON | ECHO | ISIG)) && !(t.c_oflag & OPOST) && (t.c_cflag & CSIZE) == CS8);
    (void)ethd__line_low_latency(fd);
    close(fd);
  }
  close(master);
}

TEST(test_every_byte) {
  int master = pty_open(NULL, path), fd;
  unsigned char sent[256], got[256];
  ck_assert_int_eq(ethd__line_open(path, ETHD__LINE_8N1, 500000, &fd, message), ETHD_OK);
  ck_assert_int_eq(read(fd, got, sizeof got), 0); /* nothing yet, and no waiting */
  for (int i = 0; i < 256; i++) sent[i] = (unsigned char)i;
  ck_assert_int_eq(write(master, sent, sizeof sent), sizeof sent);
  ck_assert_int_eq(read(fd, got, sizeof got), sizeof got);
  ck_assert_mem_eq(got, sent, sizeof got);
  ck_assert_int_eq(write(fd, sent, sizeof sent), sizeof sent);
  ck_assert_int_eq(read(master, got, sizeof got), sizeof got);
  ck_assert_mem_eq(got, sent, sizeof got);
  close(fd);
  close(master);
}

TEST(test_ours_alone) {
  int master = pty_open(NULL, path), fd, other;
  ck_assert_int_eq(ethd__line_open(path, ETHD__LINE_8N1, 500000, &fd, message), ETHD_OK);
  ck_assert_int_eq(ethd__line_open(path, ETHD__LINE_8N1, 500000, &other, message), ETHD_E_DEVICE);
  ck_assert_ptr_nonnull(strstr(message, "another program uses it"));
  ck_assert_int_eq(other, -1);
  close(fd);
  ck_assert_int_eq(ethd__line_open(path, ETHD__LINE_8N1, 500000, &fd, message), ETHD_OK);
  close(fd);
  close(master);
}

/* Another user opens a line after it was closed, and after the program that had it was killed. */
TEST(test_again_without_rights) {
  int master = pty_open(NULL, path), fd, status;
  ck_assert_int_eq(chmod(path, 0666), 0);
  pid_t child = fork();
  if (child == 0) _exit(ethd__line_open(path, ETHD__LINE_8N1, 500000, &fd, message) == ETHD_OK ? raise(SIGKILL) : 1);
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert(WIFSIGNALED(status));
  child = fork();
  if (child == 0) {
    if (getuid() == 0 && setuid(65534)) _exit(2);
    _exit(ethd__line_open(path, ETHD__LINE_8N1, 500000, &fd, message) == ETHD_OK ? 0 : 1);
  }
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  close(master);
}

TEST(test_refused) {
  int fd;
  ck_assert_int_eq(ethd__line_open("/nowhere/ttyUSB0", ETHD__LINE_8N1, 500000, &fd, message), ETHD_E_DEVICE);
  ck_assert_str_eq(message, "/nowhere/ttyUSB0: No such file or directory");
  ck_assert_int_eq(ethd__line_open("/dev/null", ETHD__LINE_8N1, 500000, &fd, message), ETHD_E_DEVICE);
  ck_assert_str_eq(message, "/dev/null: isn't a serial line");
  ck_assert_int_eq(fd, -1);
}
