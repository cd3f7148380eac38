/* Folders of output: locked while a program writes into them, and never replaced in silence. All [main]. */
#ifndef ETHD_FILE_CLAIM_H
#define ETHD_FILE_CLAIM_H

#include <stdbool.h>

#include "ethd/config.h"

typedef struct ethd__claim {
  int fd;     /* -1: no claim */
  char *path; /* of the lock, FOLDER/.lock */
} ethd__claim;

#define ETHD_CLAIM_NONE ((ethd__claim){.fd = -1})

/* Makes the folder, unless it is there, and locks it until the claim is released or the process ends. `own` are patterns
   of the files that the caller writes (fnmatch; NULL ends them): a folder that holds one is refused, unless `force`; the
   refusal names the option --force. Refused too: a folder in which another program has a claim. */
ETHD_MUST_CHECK ethd_status ethd__claim_folder(const char *folder, const char *const *own, bool force, ethd__claim *out,
                                               char message[ETHD_MESSAGE_MAX]);

/* The same without a look at what is there; waits for another program's claim to end. */
ETHD_MUST_CHECK ethd_status ethd__claim_wait(const char *folder, ethd__claim *out, char message[ETHD_MESSAGE_MAX]);

/* No claim is fine. */
void ethd__claim_release(ethd__claim *claim);

/* Whether `path` is the folder, or a file in it that matches `own`: what is read there would be written over. */
bool ethd__claim_holds(const char *folder, const char *const *own, const char *path);

/* Removes what matches `own` from a folder that is claimed. */
ETHD_MUST_CHECK ethd_status ethd__claim_empty(const char *folder, const char *const *own,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
