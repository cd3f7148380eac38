/* What is written: folders that are claimed, files that are replaced, names and cells that are made of other people's
   words, messages that keep their reason. */
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "text/claim.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/file_name.h"
#include "text/text.h"
#include "unit/suite.h"

static const char *const own[] = {"a.csv", "*.png", NULL};
static char message[ETHD_MESSAGE_MAX], folder[64], out[96];

static void set_up(void) {
  strcpy(folder, "/tmp/ethd-output-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(out, sizeof out, "%s/a.csv", folder);
}

static void tear_down(void) {
  static const char *const names[] = {"a.csv", "b.csv", "x.png", "dir/.lock", "dir/a.csv", ".lock"};
  char path[96];
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    snprintf(path, sizeof path, "%s/%s", folder, names[i]);
    unlink(path);
  }
  snprintf(path, sizeof path, "%s/dir", folder);
  rmdir(path);
  ck_assert_msg(rmdir(folder) == 0, "something else was left in %s", folder);
}

static char *in(const char *name) {
  static char path[96];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void put(const char *name, const char *text) {
  ck_assert_msg(!ethd_text_write(in(name), text, strlen(text), message), "%s", message);
}

static bool holds(const char *name, const char *text) {
  char *there;
  size_t n;
  bool same = !ethd_text_read(in(name), 1000, &there, &n, message) && !strcmp(there, text);
  free(there);
  return same;
}

/* ---- folders ---- */

TEST(test_claim) {
  ethd__claim claim, other;
  ck_assert_msg(!ethd__claim_folder(in("dir"), own, false, &claim, message), "%s", message);
  ck_assert_int_lt(ethd__claim_folder(in("dir"), own, true, &other, message), 0);
  ck_assert_ptr_nonnull(strstr(message, "dir: another program is writing there"));
  ethd__claim_release(&claim);
  ck_assert_int_eq(access(in("dir/.lock"), F_OK), -1);
  put("dir/a.csv", "1");
  ck_assert_int_eq(ethd__claim_folder(in("dir"), own, false, &claim, message), ETHD_E_ARGUMENT);
  ck_assert_ptr_nonnull(strstr(message, "dir: holds a.csv already; --force replaces what is there"));
  ck_assert_int_eq(access(in("dir/.lock"), F_OK), -1);
  ck_assert(!ethd__claim_folder(in("dir"), own, true, &claim, message));
  ck_assert(holds("dir/a.csv", "1"));
  ck_assert(!ethd__claim_empty(in("dir"), own, message));
  ck_assert_int_eq(access(in("dir/a.csv"), F_OK), -1);
  ethd__claim_release(&claim);
}

TEST(test_claim_leaves_what_isnt_its_own) {
  ethd__claim claim;
  put("b.csv", "mine");
  put("x.png", "mine too");
  ck_assert_int_eq(ethd__claim_folder(folder, own, false, &claim, message), ETHD_E_ARGUMENT);
  ck_assert_ptr_nonnull(strstr(message, "x.png"));
  unlink(in("x.png"));
  ck_assert(!ethd__claim_folder(folder, own, false, &claim, message));
  ck_assert(!ethd__claim_empty(folder, own, message));
  ck_assert(holds("b.csv", "mine"));
  ethd__claim_release(&claim);
  ck_assert_int_eq(ethd__claim_folder(in("b.csv"), own, true, &claim, message), ETHD_E_FILE);
  ck_assert_ptr_nonnull(strstr(message, "b.csv: Not a directory"));
}

TEST(test_inputs_are_known) {
  put("a.csv", "in");
  put("b.csv", "other");
  ck_assert(ethd__claim_holds(folder, own, in("a.csv")));
  ck_assert(!ethd__claim_holds(folder, own, in("b.csv")));
  ck_assert(ethd__claim_holds(folder, own, folder));
  ck_assert_int_eq(symlink("a.csv", in("x.png")), 0);
  ck_assert(ethd__claim_holds(folder, own, in("x.png")));
}

/* ---- files ---- */

static int news(void) {
  char command[128], line[16] = "";
  snprintf(command, sizeof command, "ls -A %s | grep -c '[.]new$'", folder);
  FILE *pipe = popen(command, "r");
  ck_assert(pipe && fgets(line, sizeof line, pipe));
  pclose(pipe);
  return atoi(line);
}

/* What a killed program left goes with the next run; what a living one writes stays. */
TEST(test_left_files_go) {
  ethd_replace living;
  put("a.csv", "old");
  pid_t child = fork();
  if (child == 0) {
    ethd_replace dying;
    if (ethd_replace_begin(out, &dying, message) == ETHD_OK) raise(SIGKILL);
    _exit(1);
  }
  int code;
  ck_assert(waitpid(child, &code, 0) == child && WIFSIGNALED(code));
  ck_assert_int_eq(news(), 1);
  ck_assert(!ethd_replace_begin(out, &living, message));
  ck_assert_int_eq(news(), 1); /* the living one's */
  put("a.csv", "new");
  ck_assert_int_eq(news(), 1);
  ck_assert(holds("a.csv", "new"));
  fputs("newest", living.file);
  ck_assert(!ethd_replace_commit(&living, message));
  ck_assert(holds("a.csv", "newest"));
}

/* /dev/stdout is a file here: what was printed before and after stands around it. */
TEST(test_own_stdout_is_written_through) {
  int saved = dup(STDOUT_FILENO), file = open(out, O_RDWR | O_CREAT | O_TRUNC, 0666);
  fflush(stdout);
  dup2(file, STDOUT_FILENO);
  printf("before ");
  ethd_status status = ethd_text_write("/dev/stdout", "between", 7, message);
  printf(" after");
  fflush(stdout);
  dup2(saved, STDOUT_FILENO);
  ck_assert_int_eq(status, ETHD_OK);
  ck_assert(holds("a.csv", "before between after"));
  close(file);
  close(saved);
}

static bool refuses(const char *path, const char *says) {
  message[0] = 0;
  ethd_status status = ethd_text_write(path, "new", 3, message);
  return status == ETHD_E_FILE && strstr(message, says) && !strchr(message, '\n');
}

static bool is_link(const char *name) {
  struct stat info;
  return lstat(in(name), &info) == 0 && S_ISLNK(info.st_mode);
}

/* Only a regular file is replaced, or nothing. */
TEST(test_links_and_devices_stay) {
  put("b.csv", "old");
  ck_assert_int_eq(symlink("b.csv", out), 0);
  ck_assert(!ethd_text_write(out, "new", 3, message));
  ck_assert(is_link("a.csv") && holds("b.csv", "new"));
  unlink(in("b.csv"));
  ck_assert(refuses(out, "a.csv: is a link that leads nowhere; remove it first"));
  ck_assert(is_link("a.csv") && access(in("b.csv"), F_OK) != 0);
  unlink(out);
  ck_assert_int_eq(symlink("/dev/null", out), 0);
  ck_assert(refuses(out, "a.csv: is a link to something that isn't a file; name that itself"));
  ck_assert(is_link("a.csv"));
  unlink(out);
  int socket_fd = socket(AF_UNIX, SOCK_STREAM, 0);
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  strcpy(address.sun_path, out);
  ck_assert_int_eq(bind(socket_fd, (struct sockaddr *)&address, sizeof address), 0);
  ck_assert(refuses(out, "a.csv: isn't a file; nothing is replaced"));
  close(socket_fd);
}

/* /dev/stdout and its like name a descriptor that the program was started with, and no file of its own. */
TEST(test_descriptors_by_name) {
  char name[32];
  put("a.csv", "old");
  int file = open(out, O_WRONLY | O_APPEND);
  snprintf(name, sizeof name, "/dev/fd/%d", file);
  ck_assert(!ethd_text_write(name, " new", 4, message));
  ck_assert(holds("a.csv", "old new"));
  fcntl(file, F_SETFD, FD_CLOEXEC);
  ck_assert(refuses(name, "that descriptor isn't open for writing"));
  close(file);
  ck_assert(refuses(name, "that descriptor isn't open for writing"));
  file = open(out, O_RDONLY);
  snprintf(name, sizeof name, "/proc/self/fd/%d", file);
  ck_assert(refuses(name, "that descriptor isn't open for writing"));
  close(file);
  ck_assert(holds("a.csv", "old new"));
}

/* A file of ours never becomes standard output. */
TEST(test_streams_keep_their_numbers) {
  ethd_replace replace;
  int saved = dup(STDOUT_FILENO);
  fflush(stdout);
  close(STDOUT_FILENO);
  bool refused = refuses("/dev/stdout", "that descriptor isn't open for writing");
  ethd_status status = ethd_replace_begin(out, &replace, message);
  int number = status ? -1 : fileno(replace.file);
  dup2(saved, STDOUT_FILENO);
  close(saved);
  ck_assert(refused && !status);
  ck_assert_int_gt(number, STDERR_FILENO);
  ethd_replace_abandon(&replace);
}

/* ---- words ---- */

TEST(test_cells_of_text) {
  static const char *const cells[][2] = {{"=1+1", "'=1+1"},   {"+x", "'+x"},        {"-x", "'-x"},
                                         {"@x", "'@x"},       {"-1.5", "-1.5"},     {"+2", "+2"},
                                         {"-", "-"},          {"a=b", "a=b"},       {"\x1b[2J", "\" [2J\""},
                                         {"a\tb", "\"a b\""}, {"=a,b", "\"'=a,b\""}};
  char wanted[64];
  for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
    ethd_csv_out *csv = ethd_csv_create(out, "x", message);
    ck_assert_ptr_nonnull(csv);
    ethd_csv_text(csv, cells[i][0]);
    ethd_csv_row(csv);
    ck_assert(!ethd_csv_close(csv, message));
    snprintf(wanted, sizeof wanted, "x\n%s\n", cells[i][1]);
    ck_assert_msg(holds("a.csv", wanted), "%s", cells[i][0]);
  }
}

TEST(test_file_names) {
  static const char *const good[] = {"P01", "low", "0.3", "a_b-c", "-1", "x.csv"};
  static const char *const bad[] = {"",
                                    ".",
                                    "..",
                                    "../x",
                                    "/x",
                                    "a b",
                                    "a'b",
                                    "a;b",
                                    "a\nb",
                                    "\xc3\xa9",
                                    "a$b",
                                    "a`b",
                                    "0123456789012345678901234567890x"};
  char name[ETHD_FILE_NAME_MAX];
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) ck_assert_msg(ethd__file_word(good[i]), "%s", good[i]);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) ck_assert_msg(!ethd__file_word(bad[i]), "%s", bad[i]);
  const char *plain[] = {"trace", "offset", "0.3", NULL}, *odd[] = {"../..", "a'b;c", NULL};
  ethd__file_name(plain, ".csv", name);
  ck_assert_str_eq(name, "trace-offset-0.3.csv");
  ethd__file_name(odd, ".csv", name);
  ck_assert_str_eq(name, "_._..-a_b_c.csv");
  char longest[300];
  memset(longest, 'x', sizeof longest - 1);
  longest[sizeof longest - 1] = 0;
  const char *words[] = {longest, longest, NULL};
  ethd__file_name(words, ".csv", name);
  ck_assert_uint_eq(strlen(name), ETHD_FILE_NAME_MAX - 1);
  ck_assert_str_eq(name + strlen(name) - 5, "x.csv");
}

TEST(test_long_paths_keep_the_reason) {
  char path[2000];
  memset(path, 'p', sizeof path);
  path[0] = '/', path[sizeof path - 1] = 0;
  ck_assert_int_eq(ethd__say(message, ETHD_E_FILE, "%s: No such file or directory", path), ETHD_E_FILE);
  ck_assert_uint_eq(strlen(message), ETHD_MESSAGE_MAX - 1);
  ck_assert_ptr_nonnull(strstr(message, "ppp...ppp"));
  ck_assert_str_eq(message + strlen(message) - 28, "p: No such file or directory");
  ck_assert(!strncmp(message, "/ppp", 4));
  char exact[ETHD_MESSAGE_MAX];
  memset(exact, 'e', sizeof exact);
  exact[sizeof exact - 1] = 0;
  (void)ethd__say(message, ETHD_OK, "%s", exact);
  ck_assert_str_eq(message, exact);
}

FIXTURE(set_up, tear_down)
