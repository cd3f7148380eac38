/* What a calibration is worth: tables, a CSV file, a picture. */
#ifndef ETHD_CALIBRATE_REPORT_H
#define ETHD_CALIBRATE_REPORT_H

#include "calibrate/places.h"

/* Residuals and errors at left-out places of every level, the chosen one marked; then its sensors. */
void ethd__calibration_print(const ethd__places *places, const ethd__calibration *chosen);

/* A row for each usable reading: sensor, counts, dark, distance as placed and as found, its error. */
ETHD_MUST_CHECK ethd_status ethd__calibration_csv(const ethd__places *places, const ethd__calibration *chosen,
                                                  const char *path, char message[ETHD_MESSAGE_MAX]);

/* The CSV file drawn. */
ETHD_MUST_CHECK ethd_status ethd__calibration_draw(const char *csv, const char *png, char message[ETHD_MESSAGE_MAX]);

#endif
