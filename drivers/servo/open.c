/* Opens a servo: from a configuration to a drive that has answered. [main] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "servo/device.h"
#include "servo/wire.h"
#include "servo/words.h"
#include "text/error_text.h"
#include "text/text.h"

const ethd_param ethd__servo_params[ETHD__SERVO_PARAMS] = {
    [ETHD__SERVO_Q1] = {"q1", "rad", -100, 100, 0, "angle of joint 1 in the jig, at the stop or at the index mark"},
    [ETHD__SERVO_Q2] = {"q2", "rad", -100, 100, 0, "angle of joint 2 in the jig, at the stop or at the index mark"},
    [ETHD__SERVO_JOINT] = {"joint", "1|2", 0, 1, 0, "joint of a map that has one axis"},
    [ETHD__SERVO_SPEED] = {"speed", "m/s", 0.01, 10, 1.2,
                           "highest speed of the ring; above it the fault table's row 24 is met"},
    [ETHD__SERVO_HOME] = {"home", "jig|stop|index", 0, 2, 0,
                          "how the joints are found: by hand in a jig, or by moving to a stop or an index mark"},
    [ETHD__SERVO_HOME_SPEED] = {"home_speed", "rad/s", 1e-3, 2, 0.1, "speed towards the stop or mark"},
    [ETHD__SERVO_HOME_TORQUE] = {"home_torque", "Nm", 0, 100, 0,
                                 "largest torque of the search; 0: 0.15 of the torque limit"},
    [ETHD__SERVO_HOME_WAY1] = {"home_way1", "1|-1", 0, 1, 0, "sign of joint 1's motion towards its stop or mark"},
    [ETHD__SERVO_HOME_WAY2] = {"home_way2", "1|-1", 0, 1, 0, "sign of joint 2's motion towards its stop or mark"},
    [ETHD__SERVO_UNGUARDED] =
        {"unguarded", "no|yes", 0, 1, 0,
         "yes: enable although the guardian would end with this program and the torque would stay"},
};

const char *const ethd__servo_keys[] = {"map", "port", NULL};

typedef struct settings {
  const ethd_setting *map, *port;
  double p[ETHD__SERVO_PARAMS]; /* NAN: not given */
} settings;

/* ---- settings ---- */

static const char *file(const ethd_device_def *def) { return def->file ? def->file : "the defaults"; }

static ethd_status read_settings(const ethd_device_def *def, settings *out, char *message) {
  const ethd_setting *texts[2] = {NULL, NULL};
  *out = (settings){.map = NULL};
  for (int i = 0; i < ETHD__SERVO_PARAMS; i++) out->p[i] = i < ETHD__SERVO_SPEED ? NAN : ethd__servo_params[i].def;
  ethd_status status = ethd_settings_read(&ethd_driver_servo, def, out->p, texts, message);
  out->map = texts[0];
  out->port = texts[1];
  if (!status && !out->map)
    status =
        ethd__say(message, ETHD_E_ARGUMENT, "%s: device.map is missing: a servo needs its register map", file(def));
  return status;
}

static ethd_status load_map(const ethd_device_def *def, const settings *s, ethd__servo_map *map, char *message) {
  ETHD__FREED char *path = ethd__path_join(def->folder, s->map->value);
  if (!path) return ethd__no_memory(message, NULL);
  ethd_status status = ethd__servo_map_load(path, s->map->value, map, message);
  if (status || !s->port) return status;
  if (strlen(s->port->value) >= sizeof map->port)
    return ethd__say(message, ETHD_E_RANGE, "%s:%d: device.port: too long", file(def), s->port->line);
  strcpy(map->port, s->port->value);
  return ETHD_OK;
}

/* ---- opening ---- */

static ethd_status place_axes(ethd__servo_device *d, const ethd_device_def *def, const settings *s, char *message) {
  int both = 1;
  for (int i = 0; i < 2; i++) {
    d->joint[i] = d->map.roles[ETHD__SERVO_TORQUE1 + i] >= 0 ? i : -1;
    both &= d->joint[i] >= 0;
    d->feedback.home[i] = NAN;
  }
  int given = !isnan(s->p[ETHD__SERVO_JOINT]);
  if (both && given) return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.joint: the map has both joints", file(def));
  for (int i = 0; i < 2; i++) {
    if (d->joint[i] < 0) continue;
    if (!both && given) d->joint[i] = (int32_t)s->p[ETHD__SERVO_JOINT];
    double q = s->p[d->joint[i] ? ETHD__SERVO_Q2 : ETHD__SERVO_Q1];
    d->home[d->joint[i]] = q;
    d->feedback.home[i] = s->p[ETHD__SERVO_HOME] == ETHD__HOMING_JIG ? q : NAN;
  }
  return ETHD_OK;
}

static ethd_status make_cells(ethd__servo_device *d, char *message) {
  if (!ethd_cell_create(sizeof d->command, &d->commands, NULL) &&
      !ethd_cell_create(sizeof d->newest, &d->samples, NULL))
    return ETHD_OK;
  return ethd__no_memory(message, NULL);
}

static void count_unconfirmed(ethd__servo_device *d) {
  uint32_t n = ethd__servo_unconfirmed(&d->map);
  if (n)
    snprintf(d->unconfirmed, sizeof d->unconfirmed,
             "%u of %u register%s %s unconfirmed: check %s in the drive's manual (step 2)", n, d->map.count,
             ethd__s(d->map.count), n == 1 ? "is" : "are", n == 1 ? "its address" : "their addresses");
}

/* Rounding towards no torque leaves nothing of a torque that is smaller than the first count. */
static void say_coarse(ethd__servo_device *d, double limit) {
  for (int i = 0; i < 2; i++) {
    int32_t r = d->map.roles[ETHD__SERVO_TORQUE1 + i];
    double count = r < 0 ? 0 : ethd__servo_least(&d->map.registers[r]);
    double most = r < 0 ? 0 : fmin(limit, ethd__servo_most(&d->map.registers[r]));
    if (count > most && !d->coarse[0])
      snprintf(d->coarse, sizeof d->coarse,
               "one count of torque%d is %.3g Nm at the joint, over the limit of %.3g Nm: its torque is always 0",
               i + 1, count, most);
  }
}

static ethd_status make_feedback(ethd__servo_device *d, const ethd_device_def *def, const settings *s, char *message) {
  ethd_error error;
  ethd_status status = ethd__servo_feedback_make(&d->feedback, &d->map, def->setup->limits.torque,
                                                 1e-9 * (double)d->exchange_ns, &error);
  if (status) ethd_error_text(s->map->value, &error, message);
  for (int i = 0; i < 2 && !status; i++)
    if (d->joint[i] >= 0 && d->feedback.axes[i].counts)
      (void)!ethd__encoder_doubt(&d->feedback.axes[i].def, def->setup, d->joint[i], d->inertia[i],
                                 sizeof d->inertia[i]);
  return status;
}

/* More than the friction, which is a tenth of the largest torque or less, and no more than a stop can bear. */
#define HOME_SHARE 0.15

static ethd_status set_homing(ethd__servo_device *d, const ethd_device_def *def, const settings *s, char *message) {
  ethd__homing_method method = (ethd__homing_method)s->p[ETHD__SERVO_HOME];
  for (int i = 0; i < 2; i++) {
    int32_t torque = d->map.roles[ETHD__SERVO_TORQUE1 + i];
    if (torque < 0) continue;
    double most = fmin(ethd__servo_most(&d->map.registers[torque]), def->setup->limits.torque);
    double given = s->p[ETHD__SERVO_HOME_TORQUE];
    d->homing[i] = (ethd__homing_def){.method = method,
                                      .direction = s->p[ETHD__SERVO_HOME_WAY1 + d->joint[i]] > 0 ? -1 : 1,
                                      .speed = s->p[ETHD__SERVO_HOME_SPEED],
                                      .torque = given > 0 ? fmin(given, most) : HOME_SHARE * most};
    if (method != ETHD__HOMING_JIG && isnan(d->home[d->joint[i]]))
      return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.q%d is missing: its angle at the %s", file(def),
                       d->joint[i] + 1, method == ETHD__HOMING_STOP ? "stop" : "index mark");
    if (method == ETHD__HOMING_INDEX && d->map.roles[ETHD__SERVO_INDEX1 + i] < 0)
      return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.home = index needs a [register index%d] in %s", file(def),
                       i + 1, s->map->value);
  }
  return ETHD_OK;
}

/* The loop may hold a torque for two exchanges, at most 50 ms; and the divisor must leave the wire the time that it
   takes. */
static ethd_status check_pace(const ethd__servo_device *d, const settings *s, char *message) {
  int64_t most = ETHD__SERVO_OLD_MOST / 2;
  ethd__servo_wire wire = ethd__servo_wire_of(&d->map, (double)NAN);
  if (1e9 * wire.usual > (double)d->exchange_ns)
    return ethd__say(message, ETHD_E_RANGE,
                     "%s: bus.divisor: found %u, an exchange in %g ms; its %u message%s %.3g ms of wire, silence and "
                     "turnaround: choose from %u, a faster line, or fewer registers",
                     s->map->value, d->map.divisor, 1e-6 * (double)d->exchange_ns, wire.questions,
                     wire.questions == 1 ? " takes" : "s take", 1e3 * wire.usual,
                     ethd__servo_divisor_for(wire.usual, 1e-9 * (double)d->period_ns));
  if (d->exchange_ns <= most) return ETHD_OK;
  return ethd__say(message, ETHD_E_RANGE,
                   "%s: bus.divisor: found %u, an exchange in %g ms; at most %g ms are allowed: choose up to %lld",
                   s->map->value, d->map.divisor, 1e-6 * (double)d->exchange_ns, 1e-6 * (double)most,
                   (long long)(most / d->period_ns));
}

/* The remark about the guardian, which promises a time for those ends of the program that it outlives. */
static void say_guard(ethd__servo_device *d) {
  char limits[ETHD_MESSAGE_MAX];
  double bound = 1e-6 * (double)ethd__guardian_bound(&d->map, d->exchange_ns);
  const char *ends = ethd__guardian_ends();
  ethd__guardian_limits("", d->guardian.page && atomic_load(&d->guardian.page->spared), limits);
  if (d->unarmed)
    ethd__say(d->guarded, ETHD_OK, "the drive isn't enabled here: %s", d->unarmed);
  else if (ends)
    ethd__say(d->guarded, ETHD_OK,
              "device.unguarded is yes, and here the guardian ends with this program: a killed program leaves the "
              "torque on for ever; when it is only silent, the guardian writes zero within %.3g ms, then disables",
              bound);
  else
    ethd__say(d->guarded, ETHD_OK,
              "a guardian process writes zero torque within %.3g ms of this program's end or silence, then disables%s",
              bound, limits);
}

static void set_guard(ethd__servo_device *d, bool unguarded) {
  bool wanted = d->map.guardian == ETHD__SERVO_GUARD_ALWAYS ||
                (d->map.guardian == ETHD__SERVO_GUARD_AUTO && d->map.watchdog == ETHD__SERVO_WATCH_NONE);
  ethd__servo_link_make(&d->map, &d->link);
  if (!wanted) return;
  ethd__guardian_make(&d->map, &d->link.plan, d->exchange_ns, &d->guardian);
  d->unarmed = unguarded ? NULL : ethd__guardian_ends();
  say_guard(d);
}

/* Says how long an exchange takes, before any drive is asked. */
static void say_wire(ethd__servo_device *d) {
  ethd__servo_wire w = ethd__servo_wire_of(&d->map, (double)NAN);
  uint32_t least = ethd__servo_divisor_for(w.most, 1e-9 * (double)d->period_ns);
  if (d->map.transport == ETHD__SERVO_TCP)
    snprintf(d->wire, sizeof d->wire,
             "an exchange: %u message%s, %u bytes, every %g ms; over tcp only ethd-conform --probe can say how long it "
             "takes",
             w.questions, ethd__s(w.questions), w.bytes, 1e-6 * (double)d->exchange_ns);
  else
    snprintf(d->wire, sizeof d->wire,
             "an exchange: %u message%s, %u bytes, %.3g ms of wire, silence and turnaround at %g Bd%s, %.3g with slow "
             "registers; divisor %u gives it %g ms: %s, %u would hold",
             w.questions, ethd__s(w.questions), w.bytes, 1e3 * w.usual, (double)d->map.baud,
             d->map.turnaround > 0 ? "" : " (turnaround: not known, ethd-conform --probe measures it)", 1e3 * w.most,
             d->map.divisor, 1e-6 * (double)d->exchange_ns, d->map.divisor >= least ? "it holds" : "it doesn't hold",
             least);
}

/* Waits for the drive's first answer and for what it says of itself. */
static ethd_status meet(ethd__servo_device *d, char *message) {
  ethd_status status = ethd__servo_meet(d);
  return status ? ethd__say(message, status, "%s: %.*s", d->map_name, ETHD_MESSAGE_MAX / 2, d->link.message) : ETHD_OK;
}

ethd_status ethd__servo_prepare(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  settings s;
  *out = NULL;
  ethd_status status = read_settings(def, &s, message);
  if (status) return status;
  ethd__servo_device *d = *out = calloc(1, sizeof *d);
  if (!d) return ETHD_E_MEMORY;
  d->link.bus.fd = -1;
  pthread_mutex_init(&d->lock, NULL);
  atomic_init(&d->safe, 1);
  d->speed = s.p[ETHD__SERVO_SPEED];
  d->is_virtual = def->is_virtual;
  d->period_ns = (int64_t)rint(1e9 * def->setup->period);
  status = load_map(def, &s, &d->map, message);
  snprintf(d->map_name, sizeof d->map_name, "%s", s.map->value);
  d->exchange_ns = d->period_ns * d->map.divisor;
  if (!status) status = place_axes(d, def, &s, message);
  if (!status) status = set_homing(d, def, &s, message);
  if (!status) status = check_pace(d, &s, message);
  if (!status) status = make_cells(d, message);
  if (!status) status = make_feedback(d, def, &s, message);
  if (status) return status;
  set_guard(d, s.p[ETHD__SERVO_UNGUARDED] != 0);
  count_unconfirmed(d);
  say_coarse(d, def->setup->limits.torque);
  say_wire(d);
  return ETHD_OK;
}

/* Starts the guardian before the first connection, while the program has no line open yet. */
ethd_status ethd__servo_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__servo_prepare(def, out, message);
  ethd__servo_device *d = *out;
  if (!status && d->guarded[0]) {
    status = ethd__guardian_start(&d->guardian, message);
    say_guard(d);
  }
  return status ? status : meet(d, message);
}

void ethd__servo_close(void *device) {
  ethd__servo_device *d = device;
  if (!d) return;
  ethd__guardian_end(&d->guardian);
  ethd__servo_link_close(&d->link);
  ethd_cell_destroy(d->commands);
  ethd_cell_destroy(d->samples);
  pthread_mutex_destroy(&d->lock);
  free(d);
}
