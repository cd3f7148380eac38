/* The plant's numbers as a table: the keys of a plant file, and the check of a definition. */
#ifndef ETHD__SIM_PLANT_H
#define ETHD__SIM_PLANT_H

#include <stddef.h>

#include "ethd/sim.h"
#include "text/key.h"

/* The keys of a plant file, each of which it must have. */
extern const ethd__key_row ethd__plant_rows[];
extern const size_t ethd__plant_row_count;

/* Checks each row, and the conditions between rows; the error's name is "section.key". [main] */
ethd_status ethd__plant_check(const ethd_plant *plant, ethd_error *error);
ethd_status ethd__sim_check(const ethd_sim_def *def, ethd_error *error);

#define ETHD__PLANT "q" /* the default plant */

/* Returns the path of a plant's file, relative to `folder`. "q" is q.plant there, else among the files installed with
   the programs (ETHD_DATA_DIR, by default ../share/ethd of the program's folder). The caller frees it; NULL: no memory.
   [main] */
char *ethd__plant_path(const char *plant, const char *folder);

/* ethd_plant_load with `name` for the file in messages. [main] */
ethd_status ethd__plant_read(const char *path, const char *name, ethd_plant *out, char message[ETHD_MESSAGE_MAX]);

/* Fills the error, returns its status. [main] */
ethd_status ethd__sim_refuse(ethd_error *error, ethd_status status, const char *name, double found, double min,
                             double max);

#endif
