#include "behaviour/fault_rows.h"

#include <math.h>

#include "behaviour/fault_ring.h"

/* ---- what breaks ---- */

static void late(fault_rig *r, int64_t since) { r->jump_ns = since == 0 ? 1500000 : 0; }
static void always_late(fault_rig *r, int64_t since) { (void)since, r->jump_ns = 1500000; }
static void very_late(fault_rig *r, int64_t since) { r->jump_ns = since == 0 ? 6500000 : 0; }

static void answer(fault_rig *r, int64_t since, mock_kind act, int32_t code, int32_t acts, int32_t every) {
  if (since) return;
  r->act = act;
  r->code = code;
  r->every = every;
  r->acts = acts;
}
static void no_answer(fault_rig *r, int64_t since) { answer(r, since, MOCK_DROP, 0, 1, 1); }
static void old_answer(fault_rig *r, int64_t since) { answer(r, since, MOCK_OLD, 0, 1, 1); }
static void bad_answer(fault_rig *r, int64_t since) { answer(r, since, MOCK_GARBLE, 0, 1, 1); }
static void bad_answers(fault_rig *r, int64_t since) { answer(r, since, MOCK_GARBLE, 0, 1000000, 2); }
static void refusal(fault_rig *r, int64_t since) { answer(r, since, MOCK_EXCEPTION, 2, 1, 1); }
static void reset(fault_rig *r, int64_t since) { answer(r, since, MOCK_RESET, 0, 1, 1); }
static void silence(fault_rig *r, int64_t since) { (void)since, r->deaf = 1; }
static void drive_fault(fault_rig *r, int64_t since) { (void)since, r->status = 1; }
static void too_much(fault_rig *r, int64_t since) { (void)since, r->more = 0.12; }
static void low_supply(fault_rig *r, int64_t since) { (void)since, r->volts = 100; }

static void one_jump(fault_rig *r, int64_t since) { r->slip[0] = since == 0 ? 3000 : 0; }
static void jump(fault_rig *r, int64_t since) { (void)since, r->slip[0] = 3000; }

/* Shows once the torque has changed by what moves a sound joint. */
static void freeze(fault_rig *r, int64_t since) {
  static double low, high;
  if (since == 0) low = high = r->torque[0];
  r->stuck[0] = 1;
  low = fmin(low, r->torque[0]);
  high = fmax(high, r->torque[0]);
  if (r->shows < 0 && high - low > 0.4) r->shows = r->tick;
}

/* Shows once the joint moves: ten counts, 0.4 mm of the ring. */
static void turn_round(fault_rig *r, int64_t since) {
  static double q;
  if (since == 0) q = r->now.q[0];
  r->turned[0] = 1;
  if (r->shows < 0 && fabs(r->now.q[0] - q) > 10 * 6.2831853 / FAULT_COUNTS) r->shows = r->tick;
}

/* Shows at the next mark, if there was one before. */
static void slip(fault_rig *r, int64_t since) {
  static int64_t marks;
  if (since == 0) marks = r->marks;
  if (r->shows < 0 && marks > 0 && r->marks > marks) r->shows = r->tick - 1;
  r->slip[0] = 5;
}

/* Show when the next frame is due. */
static void next_frame(fault_rig *r, int64_t since) {
  static uint64_t frames;
  if (since == 0) frames = board.frames;
  if (r->shows < 0 && board.frames > frames) r->shows = r->tick - 1;
}
static void lost_frame(fault_rig *r, int64_t since) {
  if (since == 0) board.drops = 1;
  next_frame(r, since);
}
static void damaged_frame(fault_rig *r, int64_t since) {
  if (since == 0) board.garbles = 1;
  next_frame(r, since);
}
static void silent_sensor(fault_rig *r, int64_t since) {
  board.silent = 1u << 5;
  next_frame(r, since);
}
static void silent_sensors(fault_rig *r, int64_t since) {
  board.silent = 0x1F;
  next_frame(r, since);
}
static void board_clock(fault_rig *r, int64_t since) {
  board.jump_us = 50000;
  next_frame(r, since);
}

/* Shows with the next reading: 30 mm off. */
static void displace(fault_rig *r, int64_t since, int readings) {
  static int left;
  if (since == 0) left = readings;
  if (!(r->now.have & ETHD_HAVE_CENTRE) || left == 0) return;
  if (r->shows < 0) r->shows = r->tick;
  r->now.centre[0] += 0.030;
  left--;
}
static void one_wrong_reading(fault_rig *r, int64_t since) { displace(r, since, 1); }
static void wrong_readings(fault_rig *r, int64_t since) { displace(r, since, -1); }

static void not_finite(fault_rig *r, int64_t since) { (void)since, r->law_adds = (double)NAN; }
static void strong(fault_rig *r, int64_t since) { r->law_adds = since < 150 ? 1000 : 0; }
static void twitch(fault_rig *r, int64_t since) { r->law_adds = since < 10 ? since % 2 ? 1.2 : -1.2 : 0; }
static void restless(fault_rig *r, int64_t since) { r->law_adds = since % 2 ? 1.2 : -1.2; }
static void slow_law(fault_rig *r, int64_t since) { r->law_takes = since < 3 ? 500000 : 0; }
static void failing_law(fault_rig *r, int64_t since) { (void)since, r->law_says = ETHD_E_LAW; }
static void no_number(fault_rig *r, int64_t since) { r->unplugged[1] = since < 2; }
static void clock_jump(fault_rig *r, int64_t since) { (void)since, r->shift_ns = 20000000; }
static void suspend(fault_rig *r, int64_t since) {
  if (since == 0) fault_rig_suspend(r, 6 + r->tick % 10);
}
static void emergency(fault_rig *r, int64_t since) { (void)since, ethd_loop_raise(r->loop, ETHD_FAULT_EMERGENCY_STOP); }
static void application_gone(fault_rig *r, int64_t since) { (void)since, r->gone = 1; }

static void finger_unseen(fault_rig *r, int64_t since) { r->blind = since < 16; }
static void finger_lost(fault_rig *r, int64_t since) { (void)since, r->blind = 1; }

/* Shows when the winding's model, worked out here once more, says so. */
static void warm(fault_rig *r, int64_t since, int row_is_grave) {
  static double heat;
  const ethd_limits *l = &r->setup.limits;
  double load = r->torque[0] / l->nominal_torque;
  heat = since == 0 ? 0 : heat + (1 - exp(-1e-3 / l->heat_time)) * (load * load - heat);
  const int64_t *seen = row_is_grave ? r->grave : r->seen;
  r->law_adds = seen[ETHD_FAULT_HEAT] < 0 ? 1000 : 0;
  double most = row_is_grave ? 1.05 : 0.9 + 0.1 * l->nominal_torque / fabs(r->torque[0]);
  if (r->shows < 0 && heat > most) r->shows = r->tick;
}
static void overload(fault_rig *r, int64_t since) { warm(r, since, 0); }
static void burn(fault_rig *r, int64_t since) { warm(r, since, 1); }

/* A hand throws the ring away from the wall, until something is seen. */
static void throw_ring(fault_rig *r, int row, int joint, double torque, int shows) {
  r->shove[joint] = r->seen[row] < 0 && r->grave[row] < 0 ? torque : 0;
  if (r->shows < 0 && shows) r->shows = r->tick;
}

static ethd_truth truth(const fault_rig *r) {
  ethd_truth out;
  ethd_sim_truth(r->sim, &out);
  return out;
}

static void hurl(fault_rig *r, int64_t since) {
  ethd_truth t = truth(r);
  (void)since;
  throw_ring(r, ETHD_FAULT_SPEED, 0, -6, hypot(t.ring_v[0], t.ring_v[1]) > r->setup.limits.speed);
}

static void push_to(fault_rig *r, double y) { throw_ring(r, ETHD_FAULT_WORKSPACE, 1, 3, truth(r).ring[1] > y); }
static void push_aside(fault_rig *r, int64_t since) {
  (void)since, push_to(r, r->setup.limits.workspace[3] - r->setup.limits.margin);
}
static void push_out(fault_rig *r, int64_t since) { (void)since, push_to(r, r->setup.limits.workspace[3]); }

/* What the motors have given the ring within the wall, by its true way; what they took there is forgotten once it is
   out, for nothing is stored. Shows when that is more than `most`. */
static void wall_gives(fault_rig *r, int64_t since, double most) {
  static ethd_vec was;
  static double given;
  ethd_truth t = truth(r);
  ethd_pose pose;
  ethd_arm_pose(&r->setup.arm, r->now.q, &pose);
  ethd_vec x = {t.ring[0], t.ring[1]};
  ethd_vec f = ethd_mat_mul_transposed(pose.j_inv, (ethd_vec){r->torque[0], r->torque[1]});
  if (since == 0)
    given = 0;
  else if (was.x < FAULT_WALL)
    given += ethd_vec_dot(f, ethd_vec_sub(x, was));
  else
    given = fmax(given, 0);
  was = x;
  if (r->shows < 0 && given > most) r->shows = r->tick;
}

/* A spring over the sampled loop's bound. */
static void active_wall(fault_rig *r, int64_t since) {
  const ethd_law *law = &r->setup.contact->law;
  ethd_error error;
  if (since == 0) {
    r->motor = r->setup.limits.torque;
    r->setup.contact_p[ethd_params_find(law->params, law->param_count, "k_e")] = 5000;
    r->setup.contact_p[ethd_params_find(law->params, law->param_count, "b_e")] = 0;
    if (ethd_control_post(r->control, &r->setup, &error)) fault_rig_fail("post: %s", error.name);
  }
  wall_gives(r, since, r->setup.limits.energy);
}

/* What the wall's damper is told of the speed is so old that it drives, and so does the damping that is added. */
static void old_speeds(fault_rig *r, int64_t since) {
  r->motor = r->setup.limits.torque;
  r->lag = 8;
  wall_gives(r, since, 2 * r->setup.limits.energy);
}

/* ---- setups ---- */

static void any_place(ethd_setup *s) {
  s->limits.speed = (double)INFINITY;
  for (int i = 0; i < 4; i++) s->limits.workspace[i] = (double)(i % 2 ? INFINITY : -INFINITY);
}
static void much_torque(ethd_setup *s) {
  s->limits.torque = 4;
  s->limits.torque_rate = (double)INFINITY;
  any_place(s);
}
static void little_rate(ethd_setup *s) { s->limits.torque_rate = 300; }
static void any_speed(ethd_setup *s) {
  s->limits.speed = (double)INFINITY;
  s->limits.workspace[3] = 0.275;
}

static void with_margin(ethd_setup *s) {
  any_speed(s);
  s->limits.margin = 0.015;
}
static void small_motors(ethd_setup *s) {
  any_place(s);
  s->limits.nominal_torque = 0.5;
  s->limits.heat_time = 2;
}

/* So weak that a tick at full torque takes them from warm to too hot. */
static void tiny_motors(ethd_setup *s) {
  any_place(s);
  s->limits.nominal_torque = 0.1;
  s->limits.heat_time = 0.15;
}
static void quick_speed(ethd_setup *s) { ethd_setup_velocity(s, ETHD_VELOCITY_DIFFERENCE); }
static void slow_speed(ethd_setup *s) { ethd_setup_velocity(s, ETHD_VELOCITY_LSQ); }
static void guarded_walls(ethd_setup *s) {
  much_torque(s);
  ethd_setup_transition(s, &ethd_transition_abrupt);
  s->limits.energy = 0.002;
}

#define DEGRADE ETHD_REACTION_DEGRADE
#define COUNT ETHD_REACTION_COUNTED
#define STOP ETHD_REACTION_STOP
#define ZERO ETHD_REACTION_ZERO

const fault_row fault_rows[] = {
    {1, COUNT, 0, FAULT_PLAIN, 20, 700, 1, late, NULL, "a tick takes 1.5 ms of the clock", 0},
    {2, STOP, 0, FAULT_PLAIN, 20, 700, 5, always_late, NULL, "every tick takes 1.5 ms", 0},
    {2, STOP, 0, FAULT_PLAIN, 20, 700, 1, very_late, NULL, "a tick takes 6.5 ms", 0},
    {4, COUNT, 0, FAULT_BUS, 20, 400, 1, no_answer, NULL, "the drive drops a question", 0},
    {5, ZERO, 0, FAULT_BUS, 20, 400, 5, silence, NULL, "the drive hears nothing; its watchdog lets go", 0},
    {6, COUNT, 0, FAULT_BUS, 20, 400, 1, old_answer, NULL, "the drive gives the answer before", 0},
    {7, COUNT, 0, FAULT_BUS, 20, 400, 1, bad_answer, NULL, "a bit of an answer is wrong", 0},
    {7, ZERO, 1, FAULT_BUS, 20, 400, 14, bad_answers, NULL, "a bit of every other answer is wrong", 0},
    {7, ZERO, 1, FAULT_BUS, 20, 400, 1, refusal, NULL, "the drive knows no such register", 0},
    {8, ZERO, 0, FAULT_BUS, 20, 400, 1, reset, NULL, "the connection is reset", 0},
    {9, ZERO, 0, FAULT_BUS, 20, 400, 1, drive_fault, NULL, "a fault bit in the drive's status", 0},
    {10, ZERO, 0, FAULT_BUS, 20, 400, 20, too_much, NULL, "the drive gives 1.2 Nm too much", 0},
    {11, COUNT, 0, FAULT_COUNTER, 20, 700, 1, one_jump, NULL, "3000 counts too many, once", 0},
    {11, ZERO, 1, FAULT_COUNTER, 20, 700, 2, jump, NULL, "3000 counts too many from now on", 0},
    {12, ZERO, 0, FAULT_COUNTER, 20, 250, 50, freeze, NULL, "a count stands; from a torque that changed by 0.4 Nm", 1},
    {13, ZERO, 0, FAULT_COUNTER, 20, 250, 20, turn_round, NULL, "a count runs the other way; from when it moves", 1},
    {14, COUNT, 0, FAULT_COUNTER, 60, 200, 1, slip, NULL, "5 counts are lost; from the next mark", 1},
    {15, DEGRADE, 0, FAULT_RING, 30, 300, 7, lost_frame, NULL, "a frame is lost; from when it is due", 1},
    {15, DEGRADE, 0, FAULT_RING, 30, 300, 7, damaged_frame, NULL, "a bit of a frame is wrong; from when it is due", 1},
    {18, DEGRADE, 0, FAULT_RING, 30, 80, 17, silent_sensor, NULL, "a sensor doesn't answer; from when it is due", 1},
    {18, STOP, 1, FAULT_RING, 30, 80, 17, silent_sensors, NULL, "five sensors don't answer; from when it is due", 1},
    {19, COUNT, 0, FAULT_PLAIN, 20, 300, 0, one_wrong_reading, NULL, "a reading is 30 mm off", 1},
    {19, STOP, 1, FAULT_PLAIN, 20, 300, 14, wrong_readings, NULL, "every reading is; from the first", 1},
    {20, DEGRADE, 0, FAULT_RING, 30, 300, 4, board_clock, NULL, "the board's clock jumps by 50 ms; from the next frame",
     1},
    {16, DEGRADE, 0, FAULT_PLAIN, 20, 700, 10, finger_unseen, NULL, "no reading for 16 ms", 0},
    {17, STOP, 0, FAULT_PLAIN, 20, 700, 30, finger_lost, NULL, "no reading any more", 0},
    {21, ZERO, 0, FAULT_PLAIN, 20, 700, 0, not_finite, NULL, "a law's torque is NaN", 0},
    {22, COUNT, 0, FAULT_PLAIN, 20, 80, 0, strong, much_torque, "a law's torque is 1 kNm too high", 0},
    {22, COUNT, 1, FAULT_PLAIN, 20, 80, 100, strong, much_torque, "for 150 ms", 0},
    {23, COUNT, 0, FAULT_PLAIN, 20, 80, 1, twitch, little_rate, "a law's torque goes 2.4 Nm up and down, 10 times", 0},
    {23, STOP, 1, FAULT_PLAIN, 20, 45, 20, restless, little_rate, "for ever", 0},
    {24, STOP, 0, FAULT_PLAIN, 20, 700, 3, hurl, NULL,
     "a hand throws the ring; from its true speed; by a low-pass, 1.3 ms", 1},
    {24, STOP, 0, FAULT_PLAIN, 20, 700, 2, hurl, quick_speed, "the same; by differences, 0.5 ms", 1},
    {24, STOP, 0, FAULT_PLAIN, 20, 700, 5, hurl, slow_speed, "the same; by a line through 8 samples, 3.5 ms", 1},
    {25, DEGRADE, 0, FAULT_PLAIN, 20, 700, 1, push_aside, with_margin, "a hand pushes the ring to the edge", 1},
    {25, STOP, 1, FAULT_PLAIN, 20, 700, 1, push_out, any_speed, "a hand pushes the ring out", 1},
    {26, DEGRADE, 0, FAULT_PLAIN, 20, 80, 2, overload, small_motors,
     "2.6 times the nominal torque; from when the model folds back", 1},
    {26, ZERO, 1, FAULT_PLAIN, 5, 25, 1, burn, tiny_motors, "13 times the nominal torque; from 105 %", 1},
    {27, DEGRADE, 0, FAULT_PLAIN, 20, 80, 50, active_wall, guarded_walls,
     "a spring of 5 kN/m; from when the motors have given 2 mJ", 1},
    {27, STOP, 1, FAULT_PLAIN, 20, 80, 50, old_speeds, guarded_walls,
     "the drive's speeds are 8 ms old; from when the motors have given 4 mJ", 1},
    {28, ZERO, 0, FAULT_BUS, 20, 400, 1, low_supply, NULL, "the drive's supply is 10 V", 0},
    {29, ZERO, 0, FAULT_PLAIN, 20, 700, 1, slow_law, NULL, "a law takes 0.5 ms of the clock", 0},
    {33, ZERO, 0, FAULT_PLAIN, 20, 700, 1, emergency, NULL, "raised by the application", 0},
    {34, STOP, 0, FAULT_PLAIN, 20, 700, 101, application_gone, NULL, "its heart stops", 0},
    {35, STOP, 1, FAULT_PLAIN, 20, 700, 1, clock_jump, NULL, "the samples' clock jumps by 20 ms", 0},
    {35, STOP, 1, FAULT_PLAIN, 20, 700, 1, suspend, NULL, "the machine is suspended for 6 to 15 ms", 0},
    {37, ZERO, 0, FAULT_PLAIN, 20, 700, 0, no_number, NULL, "a joint is NaN, twice", 0},
    {38, ZERO, 0, FAULT_PLAIN, 20, 700, 0, failing_law, NULL, "a law fails", 0},
};

const size_t fault_row_count = sizeof fault_rows / sizeof *fault_rows;
