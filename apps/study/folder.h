/* A study's folder: what was asked for, on which device, by which program. All [main].

     study.ini      the study file, as it was read
     config.ini     the controller's configuration; scene.scene its walls; device.plant the simulated device
     movement.csv   the recorded movement, when all hands follow one
     device.folder  with people: where relative paths of the device's settings start
     versions.txt   program, compiler, and the hash: SHA-256 of those four files one after another
     README.md      the data dictionary */
#ifndef ETHD_STUDY_FOLDER_H
#define ETHD_STUDY_FOLDER_H

#include "study/protocol.h"
#include "study/sha256.h"
#include "tap/load.h"

#define ETHD_STUDY_FILE "study.ini"
#define ETHD_STUDY_JOURNAL "journal"
#define ETHD_STUDY_TAPS "taps.csv"
#define ETHD_STUDY_SURVEY "survey.csv"
#define ETHD_STUDY_EVENTS "events.csv"
#define ETHD_STUDY_RECORDINGS "taps"

/* The device that the protocol names. Exit 2 on a bad configuration or plant. */
void ethd__folder_device(const ethd__protocol *protocol, ethd__loaded *out);

/* Makes the folder, unless it is there, and its files; leaves it as it is when it holds just this study. A folder with
   another study's files is refused, and one that the study itself is read from. finger: a recorded movement for all
   hands, or NULL. */
ETHD_MUST_CHECK ethd_status ethd__folder_make(const char *folder, const ethd__protocol *protocol,
                                              const ethd__loaded *loaded, const char *finger,
                                              char message[ETHD_MESSAGE_MAX]);

typedef struct ethd__folder {
  char *path;
  char *finger; /* the movement for all hands, NULL: none */
  char *device; /* where relative paths of [device] start, NULL: nothing of the kind is written down */
  ethd__protocol protocol;
  ethd__loaded loaded;
  char hash[ETHD_SHA256_TEXT];
} ethd__folder;

/* Back from the folder's own files alone, without the device: `loaded` is empty. */
ETHD_MUST_CHECK ethd_status ethd__folder_read(const char *folder, ethd__folder *out, char message[ETHD_MESSAGE_MAX]);
/* With the device. Exit 2 on a bad configuration or plant, and without `plugins` on a configuration that needs one. */
ETHD_MUST_CHECK ethd_status ethd__folder_open(const char *folder, bool plugins, ethd__folder *out,
                                              char message[ETHD_MESSAGE_MAX]);
void ethd__folder_close(ethd__folder *folder);

/* folder/name; exit 1 without memory. */
char *ethd__folder_path(const char *folder, const char *name);

#endif
