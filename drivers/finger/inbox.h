/* Passes a sensor's newest reading from its I/O thread to the control thread, with counts of earlier errors.

     I/O thread   ethd__inbox_put -> cell          [rt]   cell -> ethd__inbox_read -> sense, rows 15, 18, 20      */
#ifndef ETHD__FINGER_INBOX_H
#define ETHD__FINGER_INBOX_H

#include <pthread.h>
#include <stdbool.h>

#include "ethd/cell.h"
#include "ethd/driver.h"

/* A sensor's reading, with the counts up to it. */
typedef struct ethd__sighting {
  int64_t sample_ns, arrival_ns; /* CLOCK_MONOTONIC, or the virtual clock's */
  int64_t have;                  /* ETHD_HAVE_* */
  ethd_vec3 centre, v;           /* m, m/s; in the plane x and y count */
  double noise, v_noise;         /* m, m/s: sd of each axis; v_noise 0: v isn't known */
  uint64_t readings;             /* good readings */
  uint64_t lost;                 /* readings damaged, missing in the sequence, or out of order: row 15 */
  uint64_t refused;              /* complete readings that no finger can cause */
  uint64_t jumps;                /* jumps of the sender's clock: row 20 */
  uint32_t refused_in_a_row;     /* ETHD__REFUSED_MAX of them are row 18 */
} ethd__sighting;

#define ETHD__REFUSED_MAX 5

typedef struct ethd__inbox {
  ethd_cell *cell;
  pthread_mutex_t lock;  /* of `newest`, for figures */
  int64_t gap_ns;        /* if no reading comes for this time, at least one is lost */
  ethd__sighting newest; /* the I/O thread's */
  ethd__sighting taken;  /* the control thread's, as all that follows */
  uint64_t read, lost, jumps;
} ethd__inbox;

/* Opens an inbox, which is zero before; rate: Hz. The caller closes it, also after a failure. [main] */
ETHD_MUST_CHECK ethd_status ethd__inbox_open(ethd__inbox *inbox, double rate);
void ethd__inbox_close(ethd__inbox *inbox);

/* Passes `newest` to the control thread. [I/O] */
void ethd__inbox_put(ethd__inbox *inbox);

/* Sets `newest`'s instants. Each quick arrival improves the synchronisation of the sender's clock, which may move a
   reading before the last one; it then counts as taken just after the last one, since readings come in order. [I/O] */
void ethd__inbox_stamp(ethd__inbox *inbox, int64_t sample_ns, int64_t arrival_ns);

/* Counts a reading as good, or as one that no finger can cause. [I/O] */
void ethd__inbox_judge(ethd__inbox *inbox, bool is_good);

/* Gives a reading that is new at the tick's instant. A reading taken after this instant, during a late tick, waits for
   the next tick: a controller drops readings of the future. */
void ethd__inbox_read(ethd__inbox *inbox, int64_t now_ns, ethd_sense *out) ETHD_RT;
void ethd__inbox_read_space(ethd__inbox *inbox, int64_t now_ns, ethd_space_sense *out) ETHD_RT;

/* Fills a driver's figures, at most 4, and returns how many. [main] */
uint32_t ethd__inbox_figures(ethd__inbox *inbox, ethd_figure *out, uint32_t max);

#endif
