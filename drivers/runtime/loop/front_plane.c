/* The loop's front for the plane: joints, torques, ethd_control. */
#include "loop/loop.h"

#include <math.h>
#include <string.h>

#define SAME(field)                                                                          \
  _Static_assert(offsetof(ethd_sense, field) == offsetof(ethd__sense_head, field) &&         \
                     offsetof(ethd_space_sense, field) == offsetof(ethd__sense_head, field), \
                 "the senses' head: " #field)
SAME(time_ns);
SAME(have);
SAME(missed);
SAME(step_ns);
SAME(faults);
SAME(grave);

#define TAIL offsetof(ethd_loop_row, share)
#define BEHIND(field)                                                                        \
  _Static_assert(offsetof(ethd_loop_row, field) - TAIL == offsetof(ethd__row_tail, field) && \
                     offsetof(ethd_space_row, field) - offsetof(ethd_space_row, share) ==    \
                         offsetof(ethd__row_tail, field),                                    \
                 "the rows' tail: " #field)
BEHIND(lost);
BEHIND(swaps);
BEHIND(marks);
BEHIND(armed);

static ethd_status read_joints(ethd_loop *l) ETHD_RT {
  if (!l->held) memset(&l->sense.plane, 0, sizeof l->sense.plane);
  return ethd_device_read(l->def.device, l->due, &l->sense.plane);
}

static void blind_joints(ethd_loop *l) ETHD_RT { l->sense.plane.q[0] = l->sense.plane.q[1] = (double)NAN; }

static void remember_joints(ethd_loop *l, bool is_new) ETHD_RT {
  ethd_sense *s = &l->sense.plane;
  ethd__joints *last = &l->last.joints;
  if (is_new) {
    *last = (ethd__joints){.time_ns = s->time_ns, .have = s->have & (ETHD_HAVE_DQ | ETHD_HAVE_AGE)};
    memcpy(last->q, s->q, sizeof s->q);
    memcpy(last->dq, s->dq, sizeof s->dq);
    memcpy(last->age, s->age, sizeof s->age);
    return;
  }
  s->time_ns = last->time_ns;
  s->have |= last->have;
  memcpy(s->q, last->q, sizeof s->q);
  memcpy(s->dq, last->dq, sizeof s->dq);
  memcpy(s->age, last->age, sizeof s->age);
}

static void rehearse_torque(ethd_loop *l) ETHD_RT {
  (void)!ethd_control_rehearse(l->def.control, &l->sense.plane, &l->command.plane);
}

static bool step_torque(ethd_loop *l) ETHD_RT {
  ethd_trace *trace = &l->row.plane.trace;
  (void)!ethd_control_step(l->def.control, &l->sense.plane, &l->command.plane, trace);
  return trace->swap != 0;
}

static bool is_safe_torque(const ethd_loop *l) ETHD_RT { return l->command.plane.safe; }

static ethd_status write_torque(ethd_loop *l, bool armed, double share) ETHD_RT {
  ethd_command *c = &l->command.plane;
  if (!armed) *c = (ethd_command){.safe = 1};
  for (int i = 0; i < 2 && armed; i++) c->torque[i] *= share;
  return ethd_device_write(l->def.device, l->due, c);
}

static void acknowledge_control(ethd_loop *l) ETHD_RT { ethd_control_acknowledge(l->def.control); }
static const ethd_law *law_of_control(const ethd_loop *l) ETHD_RT { return ethd_control_law(l->def.control); }

/* ---- [main] ---- */

static double period_of_control(const ethd_loop_def *def) { return ethd_control_period(def->control); }

static void counters_of_control(const ethd_loop *l, ethd_counters *out) { ethd_control_counters(l->def.control, out); }

static void restart_control(ethd_loop *l) { ethd_control_restart(l->def.control); }
static void start_control(ethd_loop *l) { ethd_control_heat(l->def.control, l->row.plane.heat); }
static bool control_has_fault(const ethd_loop *l) { return l->row.plane.trace.fault != 0; }

const ethd__loop_front ethd__loop_plane = {.row = sizeof(ethd_loop_row),
                                           .tail = TAIL,
                                           .read = read_joints,
                                           .blind = blind_joints,
                                           .remember = remember_joints,
                                           .rehearse = rehearse_torque,
                                           .step = step_torque,
                                           .is_safe = is_safe_torque,
                                           .write = write_torque,
                                           .acknowledge = acknowledge_control,
                                           .law = law_of_control,
                                           .period = period_of_control,
                                           .counters = counters_of_control,
                                           .restart = restart_control,
                                           .start = start_control,
                                           .has_fault = control_has_fault};
