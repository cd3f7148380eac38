/* Describes a study for programs that read its tables and ticks: its protocol, its device, and how ticks become depths
   behind its wall. All [main]. */
#ifndef ETHD__APPS_DESCRIBE_DESCRIBE_H
#define ETHD__APPS_DESCRIBE_DESCRIBE_H

#include <stdbool.h>
#include <stddef.h>

#include "study/folder.h"

/* Writes into folder `out`, which must not exist or be empty: study.json, with the first folder's study; a simulated
   encounter under each of its strategies, encounter-LAW.csv (ethd__trace_write); and of several folders, which must be
   stations of one study, the tables that ethd-study --merge would make. plugins: run those of the folder's
   configuration. Exit 2 on a bad configuration or plant. *job: the folders' text isn't the cause of the refusal. */
ETHD_MUST_CHECK ethd_status ethd__describe(const char *const *folders, size_t count, bool plugins, const char *out,
                                           bool *job, char message[ETHD_MESSAGE_MAX]);

/* Simulates an encounter from approach to retreat, as figure 6 of the paper shows one, with the study's configuration
   and plant, and writes it into folder `out`. */
ETHD_MUST_CHECK ethd_status ethd__encounter_write(const ethd__folder *folder, const char *law, const char *out,
                                                  char message[ETHD_MESSAGE_MAX]);

#endif
