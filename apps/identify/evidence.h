/* Data of recordings of a moving arm: commands and encoders in each tick, and the times of readings. The true state of
   a simulation isn't used. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_EVIDENCE_H
#define ETHD__APPS_IDENTIFY_EVIDENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ethd/config.h"
#include "ethd/record.h"

#define ETHD__BACK 8 /* ticks before the first used one whose commands are kept: the longest delay */

/* Consecutive ticks at which the device applied the commanded torque and the finger wasn't near the ring. */
typedef struct ethd__passage {
  size_t first, count;
  uint32_t recording;
} ethd__passage;

/* A reading of the ring, and the two instants between which it was delivered. */
typedef struct ethd__delivery {
  int64_t sample_ns, after_ns, at_ns;
  uint32_t recording;
  ethd_vec finger; /* m in R_0; NaN if the reading has rays instead */
  bool near;       /* the finger is near the ring */
} ethd__delivery;

typedef struct ethd__evidence {
  bool plugins; /* the recordings' configurations may load their plugins */
  ethd_arm arm;
  double period, ring_radius;
  double (*q)[2];      /* rad */
  double (*torque)[2]; /* Nm, commanded at the tick */
  size_t count;
  ethd__passage *stretches;
  size_t stretch_count;
  ethd__delivery *deliveries;
  size_t delivery_count;
  char **folders; /* one for each recording */
  uint32_t recording_count;
  size_t touched, unarmed; /* ticks left out: finger near; torque unknown */
  double clipped;          /* share of the moving ticks at which the guard cut the torque */
  size_t not_numbers;      /* ticks with NaN as angle or torque */
  size_t uneven;           /* ticks that don't follow the one before by a period */
} ethd__evidence;

/* Adds the recording in `folder`, or those in folders below it. Refuses a recording whose arm, period or ring differs
   from that of the earlier ones. */
ETHD_MUST_CHECK ethd_status ethd__evidence_add(ethd__evidence *evidence, const char *folder,
                                               char message[ETHD_MESSAGE_MAX]);

/* An evidence that is all zero may be freed too. */
void ethd__evidence_free(ethd__evidence *evidence);

/* Returns to - from in s for any stamps: a difference that overflows wraps round. */
static inline double ethd__evidence_apart(int64_t from_ns, int64_t to_ns) {
  return 1e-9 * (double)(int64_t)((uint64_t)to_ns - (uint64_t)from_ns);
}

/* Cuts a recording's rows into passages. [in evidence_rows.c] */
void ethd__evidence_rows(ethd__evidence *evidence, const ethd_setup *setup, const ethd_trace *rows, size_t count,
                         const unsigned char *armed);

#endif
