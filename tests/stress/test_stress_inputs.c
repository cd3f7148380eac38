/* Impossible measurements: NaN, infinities, huge and subnormal numbers and clocks that jump, in every word of the sense
   and every combination of what it holds. The tick gives a torque that is finite and within its limit, and raises
   ETHD_FAULT_INPUT exactly where the contract does; once acknowledged, the controller does what one does that never saw
   the impossible number. Then readings that stop, and what the filters make of them. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "ethd/control.h"
#include "ethd/estimate.h"
#include "stress/mass.h"

#define TORQUE 1.34 /* Nm */
#define WORDS_OF_SENSE (sizeof(ethd_sense) / sizeof(int64_t))
#define BEFORE 30

/* Type and name of every word. */
typedef struct sense_word {
  const char *name;
  size_t offset;
  char type; /* i, f */
} sense_word;

static size_t words(sense_word out[WORDS_OF_SENSE]) {
  size_t n = 0;
#define WORD(kind, field, number, unit, brief) \
  for (size_t i = 0; i < number; i++, n++)     \
    out[n] = (sense_word){#field, offsetof(ethd_sense, field) + 8 * i, #kind[0] == 'd' ? 'f' : 'i'};
  ETHD_SENSE_FIELDS(WORD)
#undef WORD
  return n;
}

/* ---- a good sense ---- */

/* Ring and finger go to and fro before and in a wall; the state of the laws used has no memory. */
static ethd_sense good(const ethd_arm *arm, int64_t tick) {
  ethd_sense s;
  double phase = 2 * M_PI * (double)tick / 400;
  ethd_vec ring = {0.255 + 0.006 * cos(phase), 0.25};
  memset(&s, 0, sizeof s);
  s.time_ns = tick * 1000000;
  ck_assert_int_eq(ethd_arm_angles(arm, ring, -1, s.q), ETHD_OK);
  s.finger[0] = ring.x - 0.001, s.finger[1] = ring.y;
  s.centre[0] = -0.001;
  s.ring[0] = ring.x, s.ring[1] = ring.y;
  s.sample_ns = s.time_ns;
  ethd_fit_rays(0.012, 0.0075, (ethd_vec){-0.001, 0}, s.rays);
  if (tick == 0)
    s.have = ETHD_HAVE_START;
  else if (tick % 3 == 0)
    s.have = ETHD_HAVE_CENTRE;
  return s;
}

static ethd_control *controller(const ethd_scene *scene, ethd_filter_method filter) {
  ethd_setup setup = ethd_setup_default();
  ethd_setup_transition(&setup, &ethd_transition_smooth);
  ethd_setup_filter(&setup, filter);
  setup.scene = scene;
  setup.limits.torque = TORQUE;
  return rig_control(&setup);
}

/* ---- what the contract says ---- */

static bool bad(const double *v, double most) { return !(fabs(v[0]) <= most && fabs(v[1]) <= most); }

static bool is_input_fault(const ethd_sense *s) {
  int64_t have = s->have;
  return bad(s->q, ETHD_SENSE_ANGLE_MAX) || ((have & ETHD_HAVE_DQ) && bad(s->dq, ETHD_SENSE_SPEED_MAX)) ||
         ((have & (ETHD_HAVE_FINGER | ETHD_HAVE_START)) && bad(s->finger, ETHD_SENSE_LENGTH_MAX)) ||
         ((have & ETHD_HAVE_FINGER) && bad(s->finger_v, ETHD_SENSE_SPEED_MAX)) ||
         ((have & ETHD_HAVE_RING) && bad(s->ring, ETHD_SENSE_LENGTH_MAX)) ||
         ((have & ETHD_HAVE_COMMANDED) && bad(s->commanded, ETHD_SENSE_FORCE_MAX)) ||
         ((have & ETHD_HAVE_AGE) && (bad(s->age, ETHD_SENSE_AGE_MAX) || !(s->age[0] >= 0) || !(s->age[1] >= 0)));
}

typedef struct inputs_tally {
  int64_t cases, wrong_fault, unsafe, lost;
  double torque, off;
} inputs_tally;

/* The most severe reaction that the rows of the fault table in this sense call for. */
static ethd_reaction called_for(const ethd_sense *s) {
  ethd_reaction most = ETHD_REACTION_NONE;
  for (int row = 1; row < ETHD_FAULT_COUNT; row++) {
    int grave = s->grave >> row & 1;
    if (!grave && !(s->faults >> row & 1)) continue;
    ethd_reaction reaction = ethd_fault_reaction((ethd_fault)row, grave);
    if (reaction <= ETHD_REACTION_ZERO && reaction > most) most = reaction;
  }
  return most;
}

/* A stop ends in zero torque, but damps on its way. */
static void judge_told(ethd_reaction reaction, const ethd_command *c, const ethd_trace *t, inputs_tally *sum) {
  if (!t->fault) sum->wrong_fault++;
  if (reaction == ETHD_REACTION_ZERO && (!c->safe || c->torque[0] != 0 || c->torque[1] != 0)) sum->unsafe++;
}

static void judge(const ethd_sense *s, ethd_status status, const ethd_command *c, const ethd_trace *t,
                  inputs_tally *sum) {
  int input = is_input_fault(s), said = t->fault == ETHD_FAULT_INPUT;
  double most = fmax(fabs(c->torque[0]), fabs(c->torque[1]));
  ethd_reaction told = called_for(s);
  if (!(most <= sum->torque)) sum->torque = most;
  if (told >= ETHD_REACTION_STOP) {
    judge_told(told, c, t, sum);
    return;
  }
  if (input != said || (input && status != ETHD_E_NOT_FINITE)) sum->wrong_fault++;
  if (!input && t->fault && t->fault != ETHD_FAULT_FINITE) sum->wrong_fault++;
  if (t->fault && (!c->safe || most != 0)) sum->unsafe++;
}

/* ---- one disturbance ---- */

typedef struct disturbance {
  const sense_word *word;
  uint64_t bits;
  int64_t have;
  int ticks;
} disturbance;

static void disturb(const ethd_arm *arm, const ethd_scene *scene, const disturbance *d, int after,
                    const double undisturbed[2], inputs_tally *sum) {
  ethd_control *control = controller(scene, ETHD_FILTER_CA);
  ethd_command c;
  ethd_trace t;
  for (int64_t k = 0; k < BEFORE + d->ticks + after; k++) {
    ethd_sense s = good(arm, k);
    int now = k >= BEFORE && k < BEFORE + d->ticks;
    if (now) {
      s.have = d->have;
      memcpy((char *)&s + d->word->offset, &d->bits, sizeof d->bits);
    }
    ethd_status status = ethd_control_step(control, &s, &c, &t);
    if (now) judge(&s, status, &c, &t, sum);
    /* a huge number causes faults until it has left the filters */
    if (t.fault && k >= BEFORE + d->ticks && k < BEFORE + d->ticks + 1000) ethd_control_acknowledge(control);
  }
  double off = hypot(c.torque[0] - undisturbed[0], c.torque[1] - undisturbed[1]);
  if (!(off <= sum->off)) sum->off = off;
  sum->cases++;
  ethd_control_destroy(control);
}

static const double numbers[] = {NAN,      INFINITY, -INFINITY, 1e300, -1e300, DBL_MAX,
                                 -DBL_MAX, 1e-310,   -5e-324,   -0.0,  1e17,   -1e9};
static const int64_t integers[] = {INT64_MIN, INT64_MAX, -1, 0, 1, (int64_t)1 << 40, -((int64_t)1 << 40)};

static const int64_t holds[] = {ETHD_HAVE_DQ,
                                ETHD_HAVE_CENTRE | ETHD_HAVE_RING,
                                ETHD_HAVE_DQ | ETHD_HAVE_FINGER,
                                ETHD_HAVE_RAYS | ETHD_HAVE_RING,
                                ETHD_HAVE_CENTRE,
                                ETHD_HAVE_RAYS,
                                ETHD_HAVE_START,
                                ETHD_HAVE_FINGER,
                                ETHD_HAVE_COMMANDED | ETHD_HAVE_AGE,
                                0,
                                63};

static void undisturbed(const ethd_arm *arm, const ethd_scene *scene, int ticks, double out[2]) {
  ethd_control *control = controller(scene, ETHD_FILTER_CA);
  ethd_command c = {{0, 0}, 0, 0};
  for (int64_t k = 0; k < ticks; k++) {
    ethd_sense s = good(arm, k);
    (void)ethd_control_step(control, &s, &c, NULL);
  }
  memcpy(out, c.torque, sizeof c.torque);
  ethd_control_destroy(control);
}

static void all_words(const ethd_arm *arm, const ethd_scene *scene) {
  const int after = 1600; /* ticks that a huge number takes to fade from a low-pass */
  sense_word list[WORDS_OF_SENSE];
  size_t count = words(list), hold_count = (size_t)pick(2, sizeof holds / sizeof *holds);
  inputs_tally sum = {0};
  for (int ticks = 1; ticks <= pick(1, 40); ticks += 39) {
    double calm[2];
    undisturbed(arm, scene, BEFORE + ticks + after, calm);
    for (size_t w = 0; w < count; w++)
      for (size_t h = 0; h < (ticks > 1 ? 4 : hold_count); h++) {
        bool is_double = list[w].type == 'f';
        size_t values = is_double ? sizeof numbers / sizeof *numbers : sizeof integers / sizeof *integers;
        for (size_t v = 0; v < values; v++) {
          disturbance d = {.word = &list[w], .have = holds[h], .ticks = ticks};
          memcpy(&d.bits, is_double ? (const void *)&numbers[v] : (const void *)&integers[v], sizeof d.bits);
          disturb(arm, scene, &d, after, calm, &sum);
        }
      }
  }
  within((double)sum.wrong_fault, 0, 0, "faults that the contract doesn't say, or misses");
  within((double)sum.unsafe, 0, 0, "faults without zero torque and the safe flag");
  bound(sum.torque, TORQUE, "largest torque of a disturbed tick");
  bound(sum.off, 1e-6, "1.6 s later: torque off an undisturbed controller's");
}

/* ---- readings that stop ---- */

/* The finger moves at v, then only the last reading comes again and again: it is late and doesn't count.
   The estimate goes on as the method says: x(t) = x + (v + v(t)) t/2 for each of them. */
static void frozen(const ethd_arm *arm, ethd_filter_method method) {
  const char *id = ethd_filter_methods[method].id;
  ethd_control *control = controller(NULL, method);
  ethd_command c;
  ethd_trace t;
  ethd_sense s, last;
  double at = 0, v = 0;
  memset(&last, 0, sizeof last);
  for (int64_t k = 0; k < 2000; k++) {
    double x = 0.25 - 1e-4 * (double)k, noise = k & 1 ? 1e-4 : -1e-4;
    memset(&s, 0, sizeof s);
    s.time_ns = k * 1000000;
    ck_assert_int_eq(ethd_arm_angles(arm, (ethd_vec){0.25, 0.25}, -1, s.q), ETHD_OK);
    if (k % 3 == 0) {
      s.have = k == 0 ? ETHD_HAVE_START : ETHD_HAVE_CENTRE;
      s.finger[0] = x, s.finger[1] = 0.25;
      s.centre[0] = k <= 999 ? x - 0.25 + noise : last.centre[0];
      s.sample_ns = k <= 999 ? s.time_ns : last.sample_ns;
      last = s;
    }
    (void)ethd_control_step(control, &s, &c, &t);
    if (k == 999) at = t.xf[0], v = t.vf[0];
  }
  ethd_counters counters;
  ethd_control_counters(control, &counters);
  within(t.xf[0] - at, (v + t.vf[0]) / 2, 1e-9, "%s: way of the finger, 1 s without a new reading", id);
  bound(fabs(t.vf[0]), 0.2, "%s: its speed then; before: 0.1", id);
  within((double)counters.readings_dropped, 333, 0, "%s: late readings dropped of 333", id);
  ethd_control_destroy(control);
}

TEST(test_inputs) {
  ethd_arm arm = ethd_setup_default().arm;
  ethd_scene *scene = rig_scene(RIG_WALL);
  all_words(&arm, scene);
  ethd_scene_destroy(scene);
  for (int m = 0; m < ETHD_FILTER_COUNT; m++) frozen(&arm, (ethd_filter_method)m);
}
