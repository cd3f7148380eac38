/* Errors of a calibration: tables, a CSV file, a picture. */
#ifndef ETHD__APPS_CALIBRATE_REPORT_H
#define ETHD__APPS_CALIBRATE_REPORT_H

#include "calibrate/places.h"

/* Prints residuals and errors at left-out places for every level, with the chosen one marked, then its sensors. */
void ethd__calibration_print(const ethd__places *places, const ethd__calibration *chosen);

/* Writes a row for each usable reading: sensor, counts, dark, distance as placed and as found, its error. */
ETHD_MUST_CHECK ethd_status ethd__calibration_csv(const ethd__places *places, const ethd__calibration *chosen,
                                                  const char *path, char message[ETHD_MESSAGE_MAX]);

/* Draws the CSV file. */
ETHD_MUST_CHECK ethd_status ethd__calibration_draw(const char *csv, const char *png, char message[ETHD_MESSAGE_MAX]);

#endif
