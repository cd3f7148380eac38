#include "cli/picture.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/cli.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* ---- commands to gnuplot ---- */

/* gnuplot reads nothing within '..' but the doubled quote; a line end would end the string. */
static void put_string(FILE *to, const char *text) {
  putc('\'', to);
  for (; *text; text++) {
    if (*text == '\'') putc('\'', to);
    putc((unsigned char)*text < ' ' ? ' ' : *text, to);
  }
  putc('\'', to);
}

static void put_path(FILE *to, const char *path) {
  ETHD__FREED char *plain = NULL;
  if (*path == '/' || asprintf(&plain, "./%s", path) < 0) {
    put_string(to, path);
    return;
  }
  put_string(to, plain);
}

static bool is_out(const ethd__picture_value *v) { return strcmp(v->name, "out") == 0; }

/* The picture itself goes where this program opened its file, which gnuplot would reach through a link. */
static void put_value(FILE *to, const ethd__picture_value *v) {
  if (is_out(v)) {
    fputs("out = '/dev/stdout'\n", to);
    return;
  }
  fprintf(to, "%s = ", v->name);
  (v->is_file ? put_path : put_string)(to, v->text);
  putc('\n', to);
}

/* ---- running it ---- */

/* Keeps gnuplot's last line on stderr, which has the cause. */
static void listen(int end, char said[ETHD_MESSAGE_MAX / 2]) {
  FILE *in = fdopen(end, "r");
  char line[256];
  *said = 0;
  while (in && fgets(line, sizeof line, in))
    if (line[strspn(line, " ^\r\n")]) snprintf(said, ETHD_MESSAGE_MAX / 2, "%.*s", (int)strcspn(line, "\r\n"), line);
  if (in)
    fclose(in);
  else
    close(end);
}

/* Its picture goes to `out`. Returns -1 if it can't be started, errno says why. A signal that stops this program stops
   it. */
static int run(FILE *commands, int out, char said[ETHD_MESSAGE_MAX / 2]) {
  char *argv[] = {(char *)"gnuplot", (char *)"--default-settings", NULL};
  posix_spawn_file_actions_t actions;
  int ends[2], code = -1;
  pid_t pid;
  *said = 0;
  if (fflush(commands) != 0 || fseek(commands, 0, SEEK_SET) != 0 || pipe2(ends, O_CLOEXEC) != 0) return -1;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(commands), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  int failed = posix_spawnp(&pid, argv[0], &actions, NULL, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  listen(ends[0], said);
  if (failed) {
    errno = failed;
    return -1;
  }
  do
    if (ethd__stop) kill(pid, SIGTERM);
  while (waitpid(pid, &code, 0) < 0 && errno == EINTR);
  if (ethd__stop) strcpy(said, "stopped");
  errno = 0;
  return WIFEXITED(code) ? WEXITSTATUS(code) : 255;
}

static ethd_status said_no(const char *what, int code, const char *said, char *message) {
  if (code < 0 && errno == ENOENT)
    return ethd__say(message, ETHD_E_FILE, "gnuplot: not found; pictures need it (Debian: gnuplot-nox)");
  if (code < 0) return ethd__say(message, ETHD_E_FILE, "gnuplot: %s", strerror(errno));
  return ethd__say(message, ETHD_E_FILE, "gnuplot: %s: %s", what, *said ? said : "failed");
}

static ethd_status no_commands(char *message) {
  return ethd__say(message, ETHD_E_FILE, "gnuplot: its commands can't be written: %s", strerror(errno));
}

ethd_status ethd__picture_ready(char message[ETHD_MESSAGE_MAX]) {
  char said[ETHD_MESSAGE_MAX / 2];
  FILE *commands = tmpfile();
  if (!commands) return no_commands(message);
  fputs("set terminal pngcairo\n", commands);
  int nowhere = ethd__file_open("/dev/null", O_WRONLY, 0), code = run(commands, nowhere, said);
  if (nowhere >= 0) close(nowhere);
  ethd_status status = code ? said_no("pngcairo", code, said, message) : ETHD_OK;
  fclose(commands);
  return status;
}

/* The script's path is absolute, because gnuplot changes to the folder. */
static void put_commands(FILE *to, const char *script, const char *folder, const ethd__picture_value *values) {
  if (folder) fputs("cd ", to), put_path(to, folder), putc('\n', to);
  for (; values->name; values++) put_value(to, values);
  fputs("load ", to);
  put_path(to, script);
  putc('\n', to);
}

static ethd_status draw(FILE *commands, const char *script, const char *path, char *message) {
  char said[ETHD_MESSAGE_MAX / 2];
  ethd_replace picture;
  ethd_status status = ethd_replace_begin(path, &picture, message);
  if (status) return status;
  int code = run(commands, fileno(picture.file), said);
  if (!code) return ethd_replace_commit(&picture, message);
  status = said_no(script, code, said, message);
  ethd_replace_abandon(&picture);
  return status;
}

ethd_status ethd__picture_draw(const char *script, const char *folder, const ethd__picture_value *values,
                               char message[ETHD_MESSAGE_MAX]) {
  char name[64];
  snprintf(name, sizeof name, "plot/%s", script);
  ETHD__FREED char *found = ethd__data_path(name), *path = realpath(found, NULL);
  FILE *commands = path ? tmpfile() : NULL;
  if (!commands) return no_commands(message);
  put_commands(commands, path, folder, values);
  while (!is_out(values)) values++;
  ETHD__FREED char *out = ethd__path_join(folder, values->text);
  ethd_status status = out ? draw(commands, script, out, message) : ethd__no_memory(message, script);
  fclose(commands);
  return status;
}
