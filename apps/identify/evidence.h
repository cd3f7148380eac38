/* What recordings say of an arm in motion: commands and encoders tick by tick, and when readings came. Nothing that only
   a simulation knows is looked at. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_EVIDENCE_H
#define ETHD_APPS_IDENTIFY_EVIDENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ethd/config.h"
#include "ethd/record.h"

#define ETHD__BACK 8 /* ticks of commands before the first tick that counts: the longest delay */

/* Ticks without a gap, in which the device had the torque that was commanded and the finger wasn't near the ring. */
typedef struct ethd__passage {
  size_t first, count;
  uint32_t recording;
} ethd__passage;

/* A reading of the ring, and between which instants it was delivered. */
typedef struct ethd__delivery {
  int64_t sample_ns, after_ns, at_ns;
  uint32_t recording;
  ethd_vec finger; /* m in R_0, NaN where rays came instead */
  ethd_vec centre; /* m, the finger's from the ring's, NaN where something else came */
  size_t tick;     /* with which it was delivered */
  double age;      /* s of the reading at that tick */
  bool near;       /* the finger is near the ring */
} ethd__delivery;

#define ETHD__TOUCH_BEFORE 0.045 /* s of a touch before its first reading that is near, */
#define ETHD__TOUCH_AFTER 0.075  /* and from it on */

/* The ticks about a touch that nothing interrupts: the finger comes from afar, and stays at the ring for a while. */
typedef struct ethd__onset {
  size_t first, begin; /* its first tick; commands are known from `begin` on */
  int count;
  uint32_t recording;
  size_t delivery; /* the first of those that were delivered within it or later */
  double gap;      /* m: of ring and finger, as the configuration has them */
} ethd__onset;

typedef struct ethd__evidence {
  ethd_arm arm;
  double period, ring_radius;
  double (*q)[2];      /* rad */
  double (*torque)[2]; /* Nm, commanded at the tick */
  size_t count;
  ethd__passage *stretches;
  size_t stretch_count;
  ethd__delivery *deliveries;
  size_t delivery_count;
  ethd__onset *onsets;
  size_t onset_count;
  char **folders; /* of the recordings */
  uint32_t recording_count;
  size_t touched, unarmed; /* ticks left out: the finger was near; the torque isn't known */
  double clipped;          /* share of the moving ticks in which the guard cut the torque */
} ethd__evidence;

/* Adds the recording in `folder`, or those in folders below it. Refused: of another arm, period or ring than those
   before it. */
ETHD_MUST_CHECK ethd_status ethd__evidence_add(ethd__evidence *evidence, const char *folder,
                                               char message[ETHD_MESSAGE_MAX]);

/* Zero is fine. */
void ethd__evidence_free(ethd__evidence *evidence);

/* Finds the touches among a recording's rows, which begin at tick `base`; good: ticks whose torque and encoders are known.
   [in evidence_touches.c] */
void ethd__evidence_touches(ethd__evidence *evidence, const ethd_setup *setup, const ethd_trace *rows, size_t count,
                            const unsigned char *good, size_t base);

/* Whether a reading has the finger near the ring, and row[0] comes a period after row[-1]. [in evidence_rows.c] */
bool ethd__evidence_is_near(const ethd_setup *setup, const ethd_trace *row);
bool ethd__evidence_follows(const ethd__evidence *evidence, const ethd_trace *row);

/* The next: how many ticks of a recording's rows. [in evidence_rows.c] */
void ethd__evidence_rows(ethd__evidence *evidence, const ethd_setup *setup, const ethd_trace *rows, size_t count,
                         const unsigned char *armed);

#endif
