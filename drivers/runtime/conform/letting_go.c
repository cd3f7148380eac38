/* Questions about the end of a torque: not renewed, no message, `safe`, a new start. */
#include "conform/letting_go.h"

#include <math.h>

#define LAPSE 0.05  /* s after which no torque may remain; measured over two windows of half this time */
#define SPACINGS 4  /* least number of sample spacings in a window, which is longer on a slow bus */
#define NUDGE 0.002 /* s: such a short torque moves almost nothing, but a driver may remember it */
#define LEFT 0.25   /* share of an acceleration that may remain, by friction or a slope */
#define SILENCE 1.0 /* s without any message */

/* Returns the length of a window, s; two windows show an acceleration. */
static double window(const ethd__conform_rig *r) { return fmax(LAPSE / 2, SPACINGS * ethd__conform_rig_spacing(r)); }

/* Returns false if the push is too weak to be measured in the steps of the angle. */
static bool is_pushed(const ethd__conform_rig *r, double acceleration, ethd_conform_answer *a) {
  double least = ethd__conform_rig_least(r, window(r));
  if (acceleration > 0 && acceleration >= least) return true;
  return ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED,
                                  "%+.3g rad/s^2 under %g Nm, but %.3g is needed: use more torque", acceleration,
                                  r->def->torque, least),
         false;
}

/* Pushes in the other direction first, with a held torque, and returns the acceleration at the end, rad/s^2. If the
   speed no longer rises then, the device is blocked, and the end of a torque would be invisible; the result is then 0,
   and the answer says so. */
static double held(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_begin(def, &r, a)) return 0;
  ethd__conform_rig_settle(&r);
  double pushed = -ethd__conform_rig_acceleration(&r, 0, -def->torque, 1, window(&r));
  (void)ethd__conform_rig_acceleration(&r, 0, -def->torque, 1, window(&r));
  double end = -ethd__conform_rig_acceleration(&r, 0, -def->torque, 1, window(&r));
  ethd__conform_rig_end(&r);
  if (!is_pushed(&r, pushed, a)) return 0;
  if (end >= 0.1 * pushed && end >= ethd__conform_rig_least(&r, window(&r))) return end;
  return ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED,
                                  "%.3g rad/s^2, but %.3g after the torque was held for %g s: an obstacle blocks it",
                                  pushed, end, 4 * window(&r)),
         0;
}

/* A torque that is not renewed must end. */
ethd_verdict ethd__conform_watchdog(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  double most = LEFT * held(def, a);
  if (!(most > 0) || !ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_settle(&r);
  double pushed = ethd__conform_rig_acceleration(&r, 0, def->torque, 1, window(&r));
  (void)ethd__conform_rig_acceleration(&r, 0, def->torque, 0, window(&r));
  double left = ethd__conform_rig_acceleration(&r, 0, def->torque, 0, window(&r));
  ethd__conform_rig_end(&r);
  if (!is_pushed(&r, pushed, a)) return a->verdict;
  if (left <= most)
    return ethd__conform_rig_answer(a, ETHD_VERDICT_KEPT, "%.3g rad/s^2 under torque, %.3g after %g s without a write",
                                    pushed, left, 2 * window(&r));
  return ethd__conform_rig_answer(a, ETHD_VERDICT_AT_RISK,
                                  "none: still %.3g of %.3g rad/s^2, %g s after the last write", left, pushed,
                                  2 * window(&r));
}

/* Enabled and without a message from this computer, not even from the I/O threads, a device should remove the torque by
   itself. */
ethd_verdict ethd__conform_silence(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (def->device->is_virtual)
    return ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "not possible on a virtual clock");
  if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  if (!r.units) {
    ethd__conform_rig_end(&r);
    return ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "none of its drivers has I/O");
  }
  ethd__conform_rig_settle(&r);
  double pushed = ethd__conform_rig_acceleration(&r, 0, def->torque, 1, window(&r));
  ethd__conform_rig_settle(&r);
  ethd__conform_rig_hush(&r, SILENCE);
  ethd__conform_rig_run(&r, LAPSE, 0, 0);
  double left = ethd__conform_rig_acceleration(&r, 0, def->torque, 1, window(&r));
  ethd__conform_rig_end(&r);
  if (!is_pushed(&r, pushed, a)) return a->verdict;
  if (left <= LEFT * pushed)
    return ethd__conform_rig_answer(
        a, ETHD_VERDICT_KEPT,
        "it removes the torque by itself: %.3g rad/s^2 under torque, %.3g after %g s without a message", pushed, left,
        SILENCE);
  return ethd__conform_rig_answer(a, ETHD_VERDICT_AT_RISK,
                                  "it has no watchdog: after %g s without a message %.3g of %.3g rad/s^2", SILENCE,
                                  left, pushed);
}

ethd_verdict ethd__conform_safe(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_open(def, &r))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "open: %.140s", r.message);
  ethd_device_safe(r.device); /* before it was started */
  ethd_device_close(r.device);
  double most = LEFT * held(def, a);
  if (!(most > 0) || !ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_settle(&r);
  double pushed = ethd__conform_rig_acceleration(&r, 0, def->torque, 1, window(&r));
  ethd_device_safe(r.device);
  ethd_device_safe(r.device);
  ethd__conform_rig_run(&r, 0.01, 0, def->torque);
  double left = ethd__conform_rig_acceleration(&r, 0, def->torque, 1, window(&r));
  ethd__conform_rig_stop(&r);
  ethd_device_safe(r.device); /* and once stopped */
  ethd_device_close(r.device);
  if (!is_pushed(&r, pushed, a)) return a->verdict;
  return ethd__conform_rig_answer(a, left <= most ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "%.3g rad/s^2 under torque, %.3g with the same torque once safe", pushed, left);
}

ethd_verdict ethd__conform_restart(const ethd_conform_def *def, ethd_conform_answer *a) {
  ethd__conform_rig r;
  if (!ethd__conform_rig_begin(def, &r, a)) return a->verdict;
  ethd__conform_rig_settle(&r);
  ethd__conform_rig_run(&r, NUDGE, 0, def->torque);
  ethd__conform_rig_stop(&r);
  ethd_status status = ethd__conform_rig_start(&r);
  if (status < 0) {
    ethd__conform_rig_end(&r);
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "started anew: %s", ethd_status_sentence(status));
  }
  /* a good arm may still move from the push: only a gain of speed shows a remaining torque */
  double left = ethd__conform_rig_acceleration(&r, 0, 0, 0, window(&r));
  double pushed = ethd__conform_rig_acceleration(&r, 0, def->torque, 1, window(&r));
  ethd__conform_rig_end(&r);
  if (!is_pushed(&r, pushed, a)) return a->verdict;
  return ethd__conform_rig_answer(a, left <= LEFT * pushed ? ETHD_VERDICT_KEPT : ETHD_VERDICT_BROKEN,
                                  "started again: %.3g rad/s^2 before the first write, %.3g under torque", left,
                                  pushed);
}
