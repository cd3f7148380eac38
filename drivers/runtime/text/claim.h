/* Output folders: locked while a program writes into them, and replaced only when that is asked for. All [main]. */
#ifndef ETHD__TEXT_CLAIM_H
#define ETHD__TEXT_CLAIM_H

#include <stdbool.h>

#include "ethd/config.h"

typedef struct ethd__claim {
  int fd;     /* -1: no claim */
  char *path; /* of the lock, FOLDER/.lock */
} ethd__claim;

#define ETHD_CLAIM_NONE ((ethd__claim){.fd = -1})

/* Makes the folder, unless it is there, and locks it until the claim is released or the process ends. `own` are
   patterns of the files that the caller writes (fnmatch; NULL ends them): a folder that holds one is refused
   unless `force` is set, and the refusal names the option --force; with `force`, a received folder's entry that isn't a
   regular file is refused. A folder that another program has claimed is refused too. */
ETHD_MUST_CHECK ethd_status ethd__claim_folder(const char *folder, const char *const *own, bool force, ethd__claim *out,
                                               char message[ETHD_MESSAGE_MAX]);

/* Does the same without looking at what is there, and waits for another program's claim to end. */
ETHD_MUST_CHECK ethd_status ethd__claim_wait(const char *folder, ethd__claim *out, char message[ETHD_MESSAGE_MAX]);

/* Releases the claim, if there is one. */
void ethd__claim_release(ethd__claim *claim);

/* Returns true if `path` is the folder, or a file in it that matches `own`: an input there would be overwritten. */
bool ethd__claim_holds(const char *folder, const char *const *own, const char *path);

/* Removes what matches `own` from a folder that is claimed. */
ETHD_MUST_CHECK ethd_status ethd__claim_empty(const char *folder, const char *const *own,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
