/* Converts a sensor's counts to a distance.

     counts                              light that comes back falls with the distance, on a floor that is
       |*                                there without a finger (dark: stray light, the ring itself):
       | *
       |   *                               counts - dark = a / (d + d0)^p
       |       *        *        *         d = (a / (counts - dark))^(1/p) - d0
       |_ _ _ _ _ _ _ _ _ _ _ dark
       +---------------------------- d   or a table of (counts - dark, d), its points joined by
                                           straight lines in 1/sqrt(counts - dark)

   Levels, each with more numbers per sensor than the level before:
     none     the law of a typical sensor, nothing measured but dark
     common   one law, fitted to all sensors together
     gain     the common law with a and d0 of each sensor: a gain and an offset
     law      a, d0 and p of each sensor
     table    points of each sensor */
#ifndef ETHD__PROXIMITY_RING_CALIBRATION_H
#define ETHD__PROXIMITY_RING_CALIBRATION_H

#include "ethd/config.h"
#include "ethd/estimate.h"
#include "proximity_ring/frame.h"

enum { ETHD__POINTS_MAX = 24, ETHD__SERIAL_MAX = 48 };

#define ETHD__DISTANCE_MAX 0.1 /* m: a farther object counts as none */

typedef enum ethd__level {
  ETHD__LEVEL_NONE = 0,
  ETHD__LEVEL_COMMON,
  ETHD__LEVEL_GAIN,
  ETHD__LEVEL_LAW,
  ETHD__LEVEL_TABLE,
  ETHD__LEVEL_COUNT
} ethd__level;

extern const char *const ethd__level_names[ETHD__LEVEL_COUNT];

typedef struct ethd__sensor {
  double a;                                             /* counts m^p */
  double p;                                             /* 1 */
  double d0;                                            /* m */
  double dark;                                          /* counts; NaN: not measured yet */
  double residual;                                      /* m rms of its calibration, NaN: none */
  uint32_t points;                                      /* of the table; 0: the law */
  double above[ETHD__POINTS_MAX], at[ETHD__POINTS_MAX]; /* counts above dark, falling; m, rising */
  char serial[ETHD__SERIAL_MAX];
} ethd__sensor;

typedef struct ethd__calibration {
  ethd__level level;
  double residual; /* m rms over all sensors, NaN: none */
  char date[ETHD__SERIAL_MAX], serial[ETHD__SERIAL_MAX];
  ethd__sensor sensors[ETHD_RAYS];
} ethd__calibration;

/* Returns level none: a = 0.5, p = 2, d0 = 2.5 mm, which are typical of the sensor, not measured. [any] */
ethd__calibration ethd__calibration_default(void);

/* Returns the distance, m: NaN for a missing reading or an unknown dark, ETHD__DISTANCE_MAX at and below dark. A
   saturated reading gives the distance at which the sensor saturates. Our own exp and log make the bits equal
   everywhere. [any, rt-safe] */
double ethd__sensor_distance(const ethd__sensor *sensor, uint16_t counts) ETHD_RT;

/* Returns the counts at a distance, not rounded, and beyond the sensor's ceiling too. [any, rt-safe] */
double ethd__sensor_counts(const ethd__sensor *sensor, double distance) ETHD_RT;

/* ---- files ---- */

/* INI: [calibration] level, date, serial, residual; [law] a, p, d0; [sensor K] serial, dark, residual, a, p, d0
   or point0, point1, ... = COUNTS_ABOVE_DARK METRES. The level decides which keys a sensor may have. All [main]. */
ETHD_MUST_CHECK ethd_status ethd__calibration_parse(const char *text, size_t length, const char *name,
                                                    ethd__calibration *out, char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__calibration_load(const char *path, ethd__calibration *out,
                                                   char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__calibration_save(const ethd__calibration *calibration, const char *path,
                                                   char message[ETHD_MESSAGE_MAX]);

#endif
