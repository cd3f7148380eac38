/* A study's folder: protocol, device, versions and data. All [main].

     study.ini      the study file, unchanged
     config.ini     the controller's configuration; scene.scene its walls; device.plant the simulated device
     movement.csv   the recorded movement, if all hands follow one; movements/ if they follow several
     conditions.csv the table of conditions, if the study has one
     device.folder  with people in a device: where relative paths of its settings start
     versions.txt   program, compiler, and the hash: SHA-256 of all files above but device.folder, concatenated
     README.md      the data dictionary, with JSON sidecars for programs; orders.csv, the planned orders */
#ifndef ETHD__APPS_STUDY_FOLDER_H
#define ETHD__APPS_STUDY_FOLDER_H

#include "cli/cli.h"
#include "study/protocol.h"
#include "tap/load.h"
#include "text/sha256.h"

#define ETHD_STUDY_FILE "study.ini"
#define ETHD_STUDY_TAPS "taps.csv"
#define ETHD_STUDY_SURVEY "survey.csv"
#define ETHD_STUDY_EVENTS "events.csv"
#define ETHD_STUDY_PARTICIPANTS "participants.csv"
#define ETHD_STUDY_RECORDINGS "taps"
#define ETHD_STUDY_PLANT "device.plant"
#define ETHD_STUDY_CONDITIONS_FILE "conditions.csv"
#define ETHD_STUDY_VERSIONS "versions.txt"
#define ETHD_STUDY_MOVEMENT "movement.csv"
#define ETHD_STUDY_MOVEMENTS "movements"
#define ETHD_STUDY_DEVICE_FOLDER "device.folder"
#define ETHD_STUDY_INPUT_MAX ((size_t)1 << 24) /* bytes of an input */

/* Loads the device that the protocol names. Exit 2 on a bad configuration or plant. */
void ethd__folder_device(const ethd__protocol *protocol, ethd__loaded *out);

/* Reads the conditions of a study that isn't in a folder yet. */
ETHD_MUST_CHECK ethd_status ethd__folder_conditions(ethd__protocol *protocol, char message[ETHD_MESSAGE_MAX]);

/* The contents of a new folder. */
typedef struct ethd__folder_parts {
  const ethd__protocol *protocol;
  const ethd__loaded *loaded;
  const char *finger; /* a recorded movement for all hands, NULL: none */
  uint32_t simulated; /* participants of a simulation; 0: a session */
} ethd__folder_parts;

/* Makes the folder, if it is missing, and its files; a folder with exactly this study stays unchanged. No file is
   overwritten: a folder with another study's or somebody's own files is refused, and also the folder from which the
   study is read. */
ETHD_MUST_CHECK ethd_status ethd__folder_make(const char *folder, const ethd__folder_parts *parts,
                                              char message[ETHD_MESSAGE_MAX]);

/* Gives the hash for the folder's versions.txt. */
ETHD_MUST_CHECK ethd_status ethd__folder_plan_hash(const ethd__folder_parts *parts, char out[ETHD_SHA256_TEXT],
                                                   char message[ETHD_MESSAGE_MAX]);

typedef struct ethd__folder {
  char *path;
  char *finger;       /* the movement for all hands, or the folder of movements; NULL: none */
  char *device;       /* where relative paths of [device] start; NULL: not in the folder */
  uint32_t simulated; /* participants of a simulation, as in its protocol; 0: a session */
  ethd__protocol protocol;
  ethd__loaded loaded;
  char hash[ETHD_SHA256_TEXT];
} ethd__folder;

/* Reads a folder by its own files alone, without the device: `loaded` is empty. */
ETHD_MUST_CHECK ethd_status ethd__folder_read(const char *folder, ethd__folder *out, char message[ETHD_MESSAGE_MAX]);
/* Reads a folder and loads its device. Exit 2 on a bad configuration or plant, and without `plugins` on a configuration
   that needs one. */
ETHD_MUST_CHECK ethd_status ethd__folder_open(const char *folder, bool plugins, ethd__folder *out,
                                              char message[ETHD_MESSAGE_MAX]);
void ethd__folder_close(ethd__folder *folder);

/* Returns how many participants the folder's simulation has; 0 for a session, or if its versions.txt lacks it. */
uint32_t ethd__folder_simulated(const char *folder);

/* Gives the SHA-256 of the folder's inputs, one after another. */
ETHD_MUST_CHECK ethd_status ethd__folder_hash(const char *folder, char out[ETHD_SHA256_TEXT],
                                              char message[ETHD_MESSAGE_MAX]);

#endif
