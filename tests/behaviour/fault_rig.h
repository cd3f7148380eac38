/* A whole tap with a fault: controller, loop on a virtual clock, a device, and behind the device's
   boundary the simulated arm with a finger in its ring.

     PLAIN    the arm as a driver of the test's own: what a sound sensor gives
     COUNTER  the same; the joints through the counter driver, from counts that a stand-in for the kernel has
     RING     the same; the finger through the proximity ring's driver, from frames on a pty
     BUS      the servo driver, over TCP, to a drive whose registers the arm's numbers are in

   Each tick: the sensors' numbers are put where the device finds them, the loop ticks, the torque that
   the drive then lets act moves the arm. */
#ifndef ETHD_TESTS_FAULT_RIG_H
#define ETHD_TESTS_FAULT_RIG_H

#include "ethd/loop.h"
#include "ethd/sim.h"
#include "servo/mock.h"

typedef enum fault_device { FAULT_PLAIN, FAULT_COUNTER, FAULT_BUS, FAULT_RING } fault_device;

#define FAULT_COUNTS 39200 /* of an encoder in a turn of the joint */
#define FAULT_MARKS 100    /* counts between two index marks */
#define FAULT_TORQUE 1.3   /* Nm: the limit */
#define FAULT_WALL 0.25    /* m: x of the ring's centre where it meets the wall */
#define FAULT_LAG_MAX 32   /* ticks */

typedef struct fault_rig fault_rig;

/* What breaks: called before each tick from the chosen one on; since: ticks since that. */
typedef void (*fault_inject)(fault_rig *r, int64_t since);

struct fault_rig {
  fault_device kind;
  ethd_sim *sim;
  ethd_scene *scene;
  ethd_setup setup;
  ethd_control *control;
  ethd_device *device;
  ethd_loop *loop;
  int64_t clock;
  ethd_sense now; /* what the sensors have at this tick */
  mock server;    /* BUS */
  uint64_t asked; /* requests that it had; and the ticks since the last */
  int64_t silent;
  uint64_t readings;
  double speeds[FAULT_LAG_MAX][2]; /* of the joints, rad/s: the last ones */
  int64_t moved;                   /* how many there were */
  /* of the tick that is over */
  int64_t tick;
  ethd_loop_row row;
  int32_t stepped;      /* 1: the controller was asked */
  ethd_command written; /* PLAIN, COUNTER: by the loop */
  double torque[2];     /* Nm at the joints, as the drive was told */
  /* what may break */
  double shove[2];             /* Nm at the joints, by a hand */
  int64_t slip[2];             /* counts that an encoder has lost */
  int32_t stuck[2], turned[2]; /* 1: an encoder stands, or counts the wrong way */
  int64_t from[2];             /* count at which that began */
  double more;                 /* Nm at the motors, that the drive gives too much */
  mock_kind act;               /* of the drive's next answers */
  int32_t code, acts, every;   /* exception's code; how many answers; each how manieth */
  uint16_t status, volts;      /* bits that the drive's status has too; its supply, 0.1 V */
  int32_t deaf;                /* 1: the drive hears nothing */
  uint16_t old_point;          /* not 0: the drive's first set-point is that, whatever is written */
  int32_t lazy;                /* 1: nobody takes the loop's rows */
  uint64_t lost;               /* rows, as those behind them say */
  int64_t jump_ns;             /* advance of the clock during the loop's read */
  int64_t shift_ns;            /* of the samples' instants */
  int64_t suspended;           /* ns for which the machine was, its clock with it */
  int64_t lag;                 /* age, in ticks, of the speeds that the drive gives, at least 1; 0: it gives none */
  double law_adds;             /* Nm, to the tracking torque of joint 1 */
  ethd_status law_says;
  int64_t law_takes;    /* ns of the clock */
  int32_t gone;         /* 1: the application's heart doesn't beat */
  int32_t unplugged[2]; /* 1: a joint is no number */
  int32_t blind;        /* 1: no reading of the finger arrives */
  /* seen since fault_rig_mark */
  int64_t seen[ETHD_FAULT_COUNT], grave[ETHD_FAULT_COUNT]; /* tick, -1: not yet */
  uint64_t base[ETHD_FAULT_COUNT];
  int64_t shows; /* tick at which the fault begins to show; -1: at once */
  int64_t marks; /* index marks of joint 1 that passed */
  double motor;  /* Nm at a joint: what a motor can give */
  double most;   /* Nm: the largest torque that the drive was told */
};

/* s: how long the servo waits for an answer, in true time: an overloaded machine gives none in 3 ms. */
extern double fault_rig_response;

/* A tap as drawn by this number; change, if any, has the last word on the setup. */
void fault_rig_open(fault_rig *r, fault_device kind, uint64_t tap, void (*change)(ethd_setup *setup));
void fault_rig_tick(fault_rig *r);
void fault_rig_suspend(fault_rig *r, int64_t periods); /* the arm moves on as it was driven */
void fault_rig_mark(fault_rig *r);                     /* from here on something may be seen */
void fault_rig_close(fault_rig *r);

/* Ends the test with a sentence. */
void fault_rig_fail(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));

#endif
