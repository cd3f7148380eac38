/* Reaches files and folders by their paths. Every reader and writer of this project does so here, so that one rule
   holds for all: below a folder from another person (a received folder) no link is followed, and no path leads out of
   it.

   Functions return -1 or NULL on failure, with errno: ELOOP is a link and EXDEV a way out of a received folder, which
   ethd__file_why says in words. No descriptor is 0, 1 or 2, even where the program was started without these: what is
   printed would go into the file. All [main], except that each thread has received folders of its own. */
#ifndef ETHD__TEXT_FILE_H
#define ETHD__TEXT_FILE_H

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/stat.h>

#include "ethd/config.h"
#include "text/freed.h"

/* Received folders, innermost first. The caller keeps it until it leaves. */
typedef struct ethd__received {
  const char *folder; /* as its user named it; the path to it may have links */
  struct ethd__received *outer;
} ethd__received;

/* From here on, paths of this thread that begin with the folder's and a '/' are reached without links. */
void ethd__received_enter(ethd__received *received, const char *folder);
void ethd__received_leave(const ethd__received *received);

/* Returns true if the path begins so. */
bool ethd__file_is_received(const char *path);

/* As open: O_CLOEXEC and O_NOCTTY are always set. */
int ethd__file_open(const char *path, int flags, mode_t mode);

/* As stat; below a received folder as lstat. */
int ethd__file_look(const char *path, struct stat *out);
/* As lstat. */
int ethd__file_look_at(const char *path, struct stat *out);
/* Returns true if something is there, a link below a received folder too. */
bool ethd__file_taken(const char *path);

DIR *ethd__file_list(const char *folder);
/* As mkdir, but a folder that is there already is fine. */
int ethd__file_make_folder(const char *folder);
int ethd__file_remove(const char *path);
int ethd__file_remove_folder(const char *path);
int ethd__file_move(const char *from, const char *to);

/* Returns what errno says about a place; with it a message, and ETHD_E_FILE. */
const char *ethd__file_why(void);
ethd_status ethd__file_refuse(const char *path, char message[ETHD_MESSAGE_MAX]);

/* Opens a file to read it: a regular one; or, where the path isn't below a received folder, also a pipe, a terminal or
   /dev/null. Doesn't wait for a pipe's other end. */
int ethd__file_read(const char *path, struct stat *out, char message[ETHD_MESSAGE_MAX]);

/* Makes a new file to write at, in the place of a regular one that is there; a character device is opened as it is. */
int ethd__file_create(const char *path, char message[ETHD_MESSAGE_MAX]);

/* Opens a regular file to read it in parts; NULL: message. */
FILE *ethd__file_stream(const char *path, char message[ETHD_MESSAGE_MAX]);

/* Returns true if the file's first `end` bytes have a part that was never written and takes no room on the disk. */
bool ethd__file_has_hole(int fd, int64_t end);

#endif
