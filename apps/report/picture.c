#include "report/picture.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/cli.h"
#include "text/error_text.h"

extern char **environ;

/* Runs gnuplot with what it says on stderr caught: its first line, if any. */
static int run(char *const argv[], char said[ETHD_MESSAGE_MAX / 2]) {
  posix_spawn_file_actions_t actions;
  int ends[2], code = -1;
  pid_t pid;
  *said = 0;
  if (pipe2(ends, O_CLOEXEC) != 0) return -1;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  int failed = posix_spawnp(&pid, "gnuplot", &actions, NULL, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  FILE *in = fdopen(ends[0], "r");
  char line[256];
  while (in && fgets(line, sizeof line, in)) /* the last line says most */
    if (line[strspn(line, " ^\r\n")]) snprintf(said, ETHD_MESSAGE_MAX / 2, "%.*s", (int)strcspn(line, "\r\n"), line);
  if (in) fclose(in);
  if (failed) {
    errno = failed;
    return -1;
  }
  while (waitpid(pid, &code, 0) < 0 && errno == EINTR) continue;
  errno = 0;
  return WIFEXITED(code) ? WEXITSTATUS(code) : 255;
}

static ethd_status said_no(const char *what, int code, const char *said, char *message) {
  if (code < 0 && errno == ENOENT)
    return ethd__say(message, ETHD_E_FILE, "gnuplot: not found; pictures need it (Debian: gnuplot-nox)");
  if (code < 0) return ethd__say(message, ETHD_E_FILE, "gnuplot: %s", strerror(errno));
  return ethd__say(message, ETHD_E_FILE, "gnuplot: %s: %s", what, *said ? said : "failed");
}

ethd_status ethd__picture_ready(char message[ETHD_MESSAGE_MAX]) {
  char said[ETHD_MESSAGE_MAX / 2];
  char *argv[] = {(char *)"gnuplot", (char *)"-e", (char *)"set terminal pngcairo", NULL};
  int code = run(argv, said);
  return code ? said_no("pngcairo", code, said, message) : ETHD_OK;
}

ethd_status ethd__picture_draw(const char *script, const char *settings, char message[ETHD_MESSAGE_MAX]) {
  char said[ETHD_MESSAGE_MAX / 2], name[64];
  snprintf(name, sizeof name, "plot/%s", script);
  char *found = ethd__data_path(name), *path = realpath(found, NULL); /* the settings may change the folder */
  free(found);
  if (!path) return ethd__say(message, ETHD_E_FILE, "%s: %s", name, strerror(errno));
  char *argv[] = {(char *)"gnuplot", (char *)"-e", (char *)settings, path, NULL};
  int code = run(argv, said);
  free(path);
  return code ? said_no(script, code, said, message) : ETHD_OK;
}

char *ethd__picture_quote(const char *text) {
  char *out = malloc(2 * strlen(text) + 1), *to = out;
  if (!out) return NULL;
  for (; *text; text++) {
    if (*text == '\'') *to++ = '\'';
    *to++ = (unsigned char)*text < ' ' ? ' ' : *text;
  }
  *to = 0;
  return out;
}
