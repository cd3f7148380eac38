/* The fault table: faults, the time until each is noticed, the reactions. Counters, events, recordings, the summary of
   a run and the manual's page are made from these rows. Links from libethd.

   Reactions, from mild to hard:
     COUNTED  go on; the fault is counted
     DEGRADE  go on with restrictions: without a sensor, by prediction, with less torque
     STOP     brake the ring until it stands still, or remove its torque (ethd/guard.h); then do as ZERO does
     ZERO     no torque, the device is disabled; latched until acknowledged
   Zero torque is a safe state because the arm is counterweighted. A row has two reactions. The first is due as soon as
   the row is seen, the second when it is grave: often, long or twice, as its sentence says. A row with only one
   reaction names it twice. REFUSE rows occur before anything moves; in a sense they are only counted.

   Device and loop report a row in the sense: they set bit i of `faults` for row i in every tick in which it lasts, and
   bit i of `grave` while the second reaction is due; bit i of `faults` need not be set then. One occurrence is a run of
   ticks without a gap; it is counted once and reported by one event. The controller's own rows work in the same way.

        faults  _____######______##____    two occurrences, two events
        grave   ________###___________     the second reaction is due: one more event

   The controller carries out the reactions. STOP and ZERO latch: the first such row stays in trace.fault until it is
   acknowledged; later rows don't replace it. If one tick has several, ZERO comes before STOP, then the lowest number
   counts. A ZERO also ends a STOP that is still braking. An acknowledgement counts once no row has called for STOP or
   ZERO for limits.clean_time. Replaying the senses replays the faults. */
#ifndef ETHD_FAULT_H
#define ETHD_FAULT_H

#include <stdint.h>

#include "ethd/base.h"

ETHD_BEGIN_DECLS

typedef enum ethd_reaction {
  ETHD_REACTION_NONE = 0,
  ETHD_REACTION_COUNTED = 1,
  ETHD_REACTION_DEGRADE = 2,
  ETHD_REACTION_STOP = 3,
  ETHD_REACTION_ZERO = 4,
  ETHD_REACTION_REFUSE = 5
} ethd_reaction;

/* X(row, NAME, first reaction, second, bound, sentence); bound: how soon it is noticed, in words; "x every": its
   register is read in each `every`-th exchange, as the servo's map says. SPEED checks the estimated speed, which lags
   behind the true one by ethd_velocity_lag: 1.3 ms with the default low-pass, half a tick with differences.
   REPLY_MISSING counts from when the map's `response` is over, and so does REPLY_BAD where libmodbus waits for the rest
   of noise that is shorter than an answer (drivers/servo/README.md). Event values: FINITE kind of law; LAW 100 kind -
   status; BUDGET ns; SPEED m/s; INPUT the bad field: ETHD_HAVE_*, or 0 for q; else 1 if the second reaction is due, 0
   if not. TORQUE and TORQUE_RATE are reported only when they last: over 0.1 s, over 20 ticks. */
#define ETHD_FAULTS(X)                                                                                    \
  X(1, OVERRUN, COUNTED, COUNTED, "1 tick", "a tick was late")                                            \
  X(2, OVERRUNS, STOP, STOP, "5 ms", "ticks are late too often, or one by more than 5 ms")                \
  X(3, LOOP, ZERO, ZERO, "5 ms", "the loop's thread doesn't run")                                         \
  X(4, REPLY_MISSING, COUNTED, COUNTED, "1 tick", "the servo didn't answer once")                         \
  X(5, FEEDBACK_OLD, ZERO, ZERO, "5 ms or 2 exchanges", "the servo's feedback is too old")                \
  X(6, REPLY_STALE, COUNTED, COUNTED, "1 exchange", "the servo's answer belonged to another question")    \
  X(7, REPLY_BAD, COUNTED, ZERO, "2 exchanges", "the servo's answers are damaged or refusals, too often") \
  X(8, LINK_LOST, ZERO, ZERO, "1 exchange", "the link to the servo is lost")                              \
  X(9, DRIVE, ZERO, ZERO, "1 exchange x every", "the drive reports a fault")                              \
  X(10, NOT_FOLLOWED, ZERO, ZERO, "20 ms", "the drive doesn't follow the torque")                         \
  X(11, ENCODER_JUMP, COUNTED, ZERO, "1 tick", "an encoder jumped, twice in 10 ms")                       \
  X(12, ENCODER_FROZEN, ZERO, ZERO, "50 ms", "an encoder stands still under torque")                      \
  X(13, ENCODER_REVERSED, ZERO, ZERO, "20 ms", "the arm runs away: an encoder or a motor is reversed")    \
  X(14, INDEX, COUNTED, REFUSE, "1 turn", "an encoder's index marks have the wrong distance")             \
  X(15, FRAME_LOST, DEGRADE, DEGRADE, "6.7 ms", "a frame of the proximity ring is lost or damaged")       \
  X(16, FINGER_OLD, DEGRADE, DEGRADE, "10 ms", "the finger wasn't seen for 10 ms: tracking fades")        \
  X(17, FINGER_LOST, STOP, STOP, "30 ms", "the finger wasn't seen for 30 ms")                             \
  X(18, SENSOR, DEGRADE, STOP, "5 frames", "a proximity sensor fails, or leaves fewer than 12 good ones") \
  X(19, ESTIMATE, COUNTED, STOP, "1 frame", "the finger's readings are implausible, five in a row")       \
  X(20, BOARD_CLOCK, DEGRADE, DEGRADE, "1 frame", "the proximity ring's clock jumped or started anew")    \
  X(21, FINITE, ZERO, ZERO, "same tick", "a law's output isn't a finite number in its range")             \
  X(22, TORQUE, COUNTED, COUNTED, "same tick", "a torque over its limit was cut")                         \
  X(23, TORQUE_RATE, COUNTED, STOP, "same tick", "a law's torque rises over its limit, 20 ticks long")    \
  X(24, SPEED, STOP, STOP, "1 tick + speed lag", "the ring is faster than its limit")                     \
  X(25, WORKSPACE, DEGRADE, STOP, "1 tick", "the ring is out of its workspace")                           \
  X(26, HEAT, DEGRADE, ZERO, "model", "a motor is too hot")                                               \
  X(27, ENERGY, DEGRADE, STOP, "50 ms", "a contact releases energy, and damping doesn't stop it")         \
  X(28, BUS_VOLTAGE, ZERO, ZERO, "1 exchange x every", "the drive's supply is out of its range")          \
  X(29, BUDGET, ZERO, ZERO, "1 tick", "a step ran over its time budget")                                  \
  X(30, PLUGIN, REFUSE, REFUSE, "load", "a plugin of another ABI, or with a bad table")                   \
  X(31, CONFIGURATION, REFUSE, REFUSE, "start", "an error in the configuration")                          \
  X(32, RECORDER, COUNTED, COUNTED, "1 tick", "the recorder lost rows")                                   \
  X(33, EMERGENCY_STOP, ZERO, ZERO, "1 tick", "the emergency stop was pressed")                           \
  X(34, APPLICATION, STOP, STOP, "100 ms", "the application has ended or was told to end")                \
  X(35, CLOCK, COUNTED, STOP, "1 tick", "the clock jumped by more than 5 ms")                             \
  X(36, SET_POINT, ZERO, ZERO, "the sequence", "the drive still holds an old set-point")                  \
  X(37, INPUT, ZERO, ZERO, "same tick", "a measurement isn't a possible number")                          \
  X(38, LAW, ZERO, ZERO, "same tick", "a law reported a failure")                                         \
  X(39, FINGER_OUT, STOP, STOP, "1 frame", "the finger is out of the cap, beyond its rim")

typedef enum ethd_fault {
  ETHD_FAULT_NONE = 0,
#define ETHD_FAULT_ROW(row, name, first, second, bound, sentence) ETHD_FAULT_##name = (row),
  ETHD_FAULTS(ETHD_FAULT_ROW)
#undef ETHD_FAULT_ROW
      ETHD_FAULT_COUNT
} ethd_fault;

/* The bit of a row in a sense. */
#define ETHD_FAULT_BIT(fault) ((int64_t)1 << (fault))

/* Returns a row's sentence, "no fault" for 0. [any, rt-safe] */
ETHD_API const char *ethd_fault_sentence(ethd_fault fault) ETHD_RT;

/* Returns as text how soon a row is noticed. [any, rt-safe] */
ETHD_API const char *ethd_fault_bound(ethd_fault fault) ETHD_RT;

/* Returns a row's first reaction, or with `grave` its second; ETHD_REACTION_NONE outside the table. [any, rt-safe] */
ETHD_API ethd_reaction ethd_fault_reaction(ethd_fault fault, int32_t grave) ETHD_RT;

ETHD_END_DECLS

#endif
