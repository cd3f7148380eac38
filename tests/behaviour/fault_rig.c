#include "behaviour/fault_rig.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "behaviour/fault_drive.h"
#include "behaviour/fault_ring.h"
#include "unit/mock_counter.h"

#define TURN 6.283185307179586
#define WALL "halfplane -1 0 -0.238\n" /* the ring meets it at FAULT_WALL */

void fault_rig_fail(const char *format, ...) {
  va_list args;
  va_start(args, format);
  vfprintf(stdout, format, args);
  va_end(args);
  putchar('\n');
  exit(1);
}

static fault_rig *arm;

/* ---- a law that misbehaves when told to ---- */

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  ethd_status status = ethd_tracking_pd.step(p, state, in, tau);
  tau[0] += arm->law_adds;
  arm->clock += arm->law_takes;
  return arm->law_says ? arm->law_says : status;
}

static ethd_tracking_law moody;

/* ---- the arm as a driver ---- */

static ethd_status arm_open(const ethd_device_def *def, void **device, char *message) {
  (void)def, (void)message;
  *device = arm;
  return ETHD_OK;
}

static ethd_status arm_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  fault_rig *r = device;
  (void)now_ns;
  r->clock += r->jump_ns;
  *out = r->now;
  out->time_ns += r->shift_ns - r->suspended;
  if (out->have & ETHD_HAVE_CENTRE) out->sample_ns += r->shift_ns - r->suspended;
  for (int j = 0; j < 2; j++)
    if (r->unplugged[j]) out->q[j] = (double)NAN;
  if (r->lag > 0) {
    out->have |= ETHD_HAVE_DQ;
    memcpy(out->dq, r->speeds[(r->moved - r->lag) % FAULT_LAG_MAX], sizeof out->dq);
  }
  if (r->kind == FAULT_RING) out->have &= ~(int64_t)(ETHD_HAVE_RAYS | ETHD_HAVE_RING);
  if (r->blind) out->have &= ~(int64_t)(ETHD_HAVE_CENTRE | ETHD_HAVE_RING);
  return ETHD_OK;
}

static ethd_status arm_write(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  fault_rig *r = device;
  (void)now_ns;
  r->written = *command;
  return ETHD_OK;
}

static void arm_safe(void *device) ETHD_RT { ((fault_rig *)device)->written = (ethd_command){.safe = 1}; }
static ethd_status arm_stop(void *d) { return (void)d, ETHD_OK; }
static void arm_close(void *d) { (void)d; }
static ethd_limits arm_limits(const void *d) { return (void)d, ethd_limits_device(); }

static const ethd_driver driver = {.size = sizeof driver,
                                   .abi = ETHD_DRIVER_ABI,
                                   .id = "arm",
                                   .brief = "simulated arm",
                                   .open = arm_open,
                                   .read = arm_read,
                                   .write = arm_write,
                                   .safe = arm_safe,
                                   .stop = arm_stop,
                                   .close = arm_close,
                                   .limits = arm_limits};
static const ethd_driver *const from[] = {&driver, &ethd_driver_counter, &ethd_driver_servo, &ethd_driver_ring, NULL};

/* ---- opening ---- */

static void setup_of(fault_rig *r, void (*change)(ethd_setup *setup)) {
  ethd_error error;
  if (ethd_scene_parse(WALL, strlen(WALL), &r->scene, &error)) fault_rig_fail("scene: %s", error.name);
  r->setup = ethd_setup_default();
  r->setup.scene = r->scene;
  ethd_setup_transition(&r->setup, &ethd_transition_offset);
  r->setup.limits = ethd_limits_device();
  r->setup.limits.torque = FAULT_TORQUE;
  r->setup.limits.torque_rate = 2000;
  r->setup.limits.speed = 1.2;
  r->setup.limits.stop_time = 1;
  r->setup.limits.step_time = 300e-6;
  r->setup.dynamics = (ethd_dynamics){{0.1173, 0.25}, 0.398, 1.267, 0.071e-3}; /* the plant's */
  const double space[4] = {0.15, 0.42, 0.10, 0.40};
  memcpy(r->setup.limits.workspace, space, sizeof space);
  moody = ethd_tracking_pd;
  moody.step = track;
  double p[ETHD_PARAMS_MAX];
  memcpy(p, r->setup.tracking_p, sizeof p);
  ethd_setup_tracking(&r->setup, &moody);
  memcpy(r->setup.tracking_p, p, sizeof p);
  if (change) change(&r->setup);
  if (ethd_control_create(&r->setup, &r->control, &error)) fault_rig_fail("setup: %s", error.name);
}

static void sim_of(fault_rig *r, uint64_t number) {
  char message[ETHD_MESSAGE_MAX];
  ethd_error error;
  ethd_sim_tap tap;
  ethd_sim_def def = {.arm = r->setup.arm,
                      .ring_radius = r->setup.ring_radius,
                      .period = r->setup.period,
                      .step = 1e-3,
                      .tolerance = ETHD_SIM_FAST};
  if (ethd_plant_load("apps/config/n.plant", &def.plant, message)) fault_rig_fail("%s", message);
  def.plant.reading = r->kind == FAULT_RING;
  def.plant.count = TURN / FAULT_COUNTS;
  r->motor = def.plant.force_limit * r->setup.arm.link1;
  def.plant.force_limit = 1000; /* a hand is stronger */
  ethd_sim_draw(&def.plant, 1, number, number % 2 ? 0.4 : 0.2, (ethd_vec){0.25, 0.25}, &tap);
  if (ethd_sim_create(&def, &r->sim, &error) || ethd_sim_start(r->sim, &tap)) fault_rig_fail("sim: %s", error.name);
  ethd_sim_read(r->sim, &r->now);
}

static void open_device(fault_rig *r) {
  static const char *const ids[] = {"arm", "arm, counter", "servo", "arm, ring"};
  const ethd_setting counter[] = {{"counter.counts_per_turn", "100", 1},
                                  {"counter.ratio", "392", 2},
                                  {"counter.freeze_torque", "0.4", 3},
                                  {"counter.reverse_torque", "0.15", 4},
                                  {"counter.inertia", "0.0073", 5}};
  char map[64];
  snprintf(map, sizeof map, "/tmp/ethd-rig-%d.map", (int)getpid());
  const ethd_setting servo[] = {{"map", map, 1}, {"port", r->server.port, 2}};
  const ethd_setting ring[] = {{"ring.port", board.port, 1}, {"ring.calibration", board.calibration, 2}};
  ethd_device_def def = {&r->setup, NULL, 0, "apps/config", "rig.ini", 1, NULL};
  char message[ETHD_MESSAGE_MAX];
  if (r->kind == FAULT_COUNTER) def.settings = counter, def.setting_count = 5;
  if (r->kind == FAULT_BUS) def.settings = servo, def.setting_count = 2;
  if (r->kind == FAULT_RING) def.settings = ring, def.setting_count = 2;
  if (r->kind == FAULT_BUS) fault_drive_map(map);
  if (ethd_device_open(ids[r->kind], from, &def, &r->device, message)) fault_rig_fail("%s", message);
  if (r->kind == FAULT_BUS) unlink(map);
  for (int i = 0; ethd_device_start(r->device); i++) /* a busy machine's drive may be late, once or twice */
    if (i == 4) fault_rig_fail("start");
}

static void open_loop(fault_rig *r) {
  ethd_loop_def def = ethd_loop_default();
  ethd_error error;
  def.device = r->device;
  def.control = r->control;
  def.clock = &r->clock;
  def.suspended = &r->suspended;
  def.soft_start = 0;
  def.rows = 16;
  def.heartbeat = 0.1;
  if (ethd_loop_create(&def, &r->loop, &error) || ethd_loop_start(r->loop, &error))
    fault_rig_fail("loop: %s", error.name);
}

void fault_rig_open(fault_rig *r, fault_device kind, uint64_t tap, void (*change)(ethd_setup *setup)) {
  memset(r, 0, sizeof *r);
  arm = r;
  r->kind = kind;
  r->shows = -1;
  r->volts = 480;
  r->every = 1;
  fault_rig_mark(r);
  setup_of(r, change);
  sim_of(r, tap);
  mock_counter_install();
  fault_drive_counts(r);
  if (kind == FAULT_BUS) {
    mock_start(&r->server, 0);
    r->server.act = fault_drive_act;
    r->server.user = r;
    fault_drive_registers(r);
  }
  if (kind == FAULT_RING) fault_board_plug();
  open_device(r);
  if (kind == FAULT_RING) fault_board_run();
  open_loop(r);
}

void fault_rig_mark(fault_rig *r) {
  ethd_counters c = {0};
  if (r->control) ethd_control_counters(r->control, &c);
  memcpy(r->base, c.faults, sizeof r->base);
  for (int i = 0; i < ETHD_FAULT_COUNT; i++) r->seen[i] = r->grave[i] = -1;
}

void fault_rig_close(fault_rig *r) {
  ethd_loop_destroy(r->loop);
  (void)!ethd_device_stop(r->device);
  ethd_device_close(r->device);
  if (r->kind == FAULT_BUS) mock_stop(&r->server);
  if (r->kind == FAULT_RING) fault_board_unplug();
  ethd_control_destroy(r->control);
  ethd_sim_destroy(r->sim);
  ethd_scene_destroy(r->scene);
}

/* ---- a tick ---- */

static void take_torque(fault_rig *r) {
  int on = r->kind == FAULT_BUS ? r->server.words[MOCK_STATUS] & 2 : !r->written.safe;
  for (int j = 0; j < 2; j++) {
    double bus = FAULT_RATIO * FAULT_TORQUE_UNIT * (int16_t)r->server.words[MOCK_TORQUE1 + j];
    r->torque[j] = !on ? 0 : r->kind == FAULT_BUS ? bus : r->written.torque[j];
    r->most = fmax(r->most, fabs(r->torque[j]));
    if (!isfinite(r->torque[j])) r->most = (double)INFINITY;
  }
}

/* The joints' true ones. */
static void note_speeds(fault_rig *r) {
  ethd_truth truth;
  ethd_pose pose;
  ethd_sim_truth(r->sim, &truth);
  ethd_arm_pose(&r->setup.arm, r->now.q, &pose);
  ethd_vec w = ethd_mat_mul(pose.j_inv, (ethd_vec){truth.ring_v[0], truth.ring_v[1]});
  memcpy(r->speeds[r->moved++ % FAULT_LAG_MAX], &w, sizeof w);
}

/* `periods` of true time. */
static void move_arm(fault_rig *r, int64_t periods) {
  ethd_command c = {.safe = 0};
  for (int j = 0; j < 2; j++) {
    double motor = r->torque[j] + (r->kind == FAULT_BUS ? r->more * FAULT_RATIO : 0);
    c.torque[j] = fmax(-r->motor, fmin(r->motor, motor)) + r->shove[j];
  }
  for (int64_t i = 0; i < periods; i++) ethd_sim_write(r->sim, &c);
  ethd_sim_read(r->sim, &r->now);
  note_speeds(r);
}

void fault_rig_suspend(fault_rig *r, int64_t periods) {
  r->suspended += periods * (int64_t)rint(1e9 * r->setup.period);
  move_arm(r, periods);
}

static void note(fault_rig *r, int64_t bits, int64_t *at) {
  for (int row = 1; row < ETHD_FAULT_COUNT; row++)
    if (bits & ETHD_FAULT_BIT(row) && at[row] < 0) at[row] = r->tick;
}

static void take_events(fault_rig *r) {
  ethd_event e;
  ethd_counters c;
  ethd_control_counters(r->control, &c);
  for (int row = 1; row < ETHD_FAULT_COUNT; row++)
    if (c.faults[row] > r->base[row] && r->seen[row] < 0) r->seen[row] = r->tick;
  note(r, r->stepped ? r->row.trace.sense.grave : 0, r->grave);
  while (ethd_control_poll(r->control, &e) == ETHD_OK)
    if (e.kind == ETHD_EVENT_FAULT && e.value == 1 && r->grave[e.code] < 0) r->grave[e.code] = r->tick;
}

void fault_rig_tick(fault_rig *r) {
  int64_t before = r->clock;
  if (r->kind == FAULT_COUNTER) fault_drive_counts(r);
  if (r->kind == FAULT_BUS) fault_drive_registers(r);
  if (r->kind == FAULT_RING) fault_board_tick(&r->now);
  if (!r->gone) ethd_loop_beat(r->loop);
  ethd_loop_tick(r->loop);
  r->stepped = 0;
  while (!r->lazy && ethd_loop_take(r->loop, &r->row) == ETHD_OK) {
    r->stepped = 1;
    r->lost += r->row.lost;
  }
  if (r->kind == FAULT_BUS) fault_drive_watch(r);
  take_torque(r);
  take_events(r);
  int64_t period = (int64_t)rint(1e9 * r->setup.period), passed = (r->clock - before + period - 1) / period;
  move_arm(r, passed > 1 ? passed : 1);
  r->tick++;
}
