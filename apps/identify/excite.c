#include "identify/excite.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "run/session.h"
#include "run/summary.h"
#include "settings/config_parts.h"
#include "text/error_text.h"

#define DRY 15.0 /* s that a dry run lasts */
#define TRIES 12 /* dry runs, each with less torque, until the ring stays inside the box, */
#define LESS 0.75
#define USED 0.6     /* share of the box that the ring may use */
#define SPRING 1.0   /* joint stiffness times box over torque times link */
#define DAMPING 0.02 /* s: the spring's damping over its stiffness */

/* A session's results so far. */
typedef struct seen {
  ethd_vec at;
  double farthest, fastest; /* m, m/s */
  atomic_int fault;         /* latched, ends the recording; 0: none */
  atomic_bool over;         /* set before the stop that ends the session, which is no fault */
} seen;

static void take(void *seen_, const ethd__row *row) {
  seen *s = seen_;
  const ethd_trace *t = &row->plane.trace;
  if (atomic_load(&s->over)) return;
  s->farthest = fmax(s->farthest, fmax(fabs(t->x[0] - s->at.x), fabs(t->x[1] - s->at.y)));
  s->fastest = fmax(s->fastest, hypot(t->v[0], t->v[1]));
  if (!s->fault) atomic_store(&s->fault, (int)t->fault);
}

/* Returns whether the guard stopped the ring because it left its box. */
static bool left_box(const seen *s) { return s->fault == ETHD_FAULT_WORKSPACE || s->fault == ETHD_FAULT_SPEED; }

/* ---- the session's configuration ---- */

static bool stays(const char *section) {
  static const char *const gone[] = {"tracking", "contact", "transition", "scene", "plugins", "device"};
  for (size_t i = 0; i < sizeof gone / sizeof *gone; i++)
    if (!strcmp(gone[i], section)) return false;
  return true;
}

/* Writes the device's keys, each with its driver's name. A dry run has no faults by a script. */
static void put_device(FILE *out, const ethd_config *c, bool dry) {
  bool single = !strchr(c->device, ',');
  for (uint32_t i = 0; i < c->setting_count; i++) {
    const ethd_setting *s = &c->settings[i];
    if (dry && !strcmp(s->key, "inject")) continue;
    bool named = !single || !strncmp(s->key, c->device, strlen(c->device)) || !strcmp(s->key, "inject");
    fprintf(out, named ? "%.0s%s = %s\n" : "%s.%s = %s\n", c->device, s->key, s->value);
  }
}

/* Returns the session's configuration: the given one, but with the laws for excitation and the driver `excite` after
   the device, or after a simulated device for a dry run. */
static char *compose(const ethd__excitation *x, const ethd_config *c, double torque, bool dry) {
  ethd__printed text;
  FILE *out = ethd__print_begin(&text);
  const ethd_ini *ini = &ethd__config_whole(c)->ini;
  bool sim = !strcmp(c->device, "sim"), simulated = sim || dry;
  double stiffness = SPRING * x->share * torque * c->setup.arm.link1 / x->half;
  for (uint32_t i = 0; i < ini->count; i++)
    if (stays(ini->keys[i].section))
      fprintf(out, "[%s]\n%s = %s\n", ini->keys[i].section, ini->keys[i].key, ini->keys[i].value);
  fprintf(out, "[tracking]\nlaw = pd\nk_t = %.6g\nb_t = %.6g\n", stiffness, DAMPING * stiffness);
  fprintf(out, "[device]\ndriver = %s, excite\n", dry ? "sim" : c->device);
  if (sim || !dry) put_device(out, c, dry);
  if (simulated) fprintf(out, "sim.empty = yes\nsim.meet_x = %.10g\nsim.meet_y = %.10g\n", x->at.x, x->at.y);
  fprintf(out, "excite.torque = %.6g\nexcite.x = %.10g\nexcite.y = %.10g\nexcite.half = %.6g\n", x->share * torque,
          x->at.x, x->at.y, x->half);
  return ethd__print_end(&text);
}

/* ---- a session ---- */

static bool goes_on(const ethd__session *s, const seen *found, double seconds) {
  return !ethd__stop && !found->fault && ethd__session_lives(s) && ethd__session_time(s) < seconds * (1 - 1e-12);
}

static void run(ethd__session *s, const seen *found, double seconds) {
  while (goes_on(s, found, seconds)) {
    ethd__progress((uint64_t)(1e3 * ethd__session_time(s)), (uint64_t)(1e3 * seconds), "exciting");
    if (s->is_virtual) {
      ethd__session_tick(s);
    } else {
      usleep(5000);
      ethd__session_poll(s);
    }
  }
  ethd__progress(1, 1, "");
}

static void dry_run(const ethd__excitation *x, const ethd_config *c, double torque, seen *out) {
  static ethd__session session;
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *text = compose(x, c, torque, true);
  *out = (seen){.at = x->at};
  ethd__session_options o = {.config = x->config,
                             .text = text,
                             .folder = c->folder,
                             .is_virtual = true,
                             .sink = {out, take},
                             .loop = ethd_loop_default()};
  ethd_status status = ethd__session_open(&o, &session, message);
  if (status) ethd__fail(ethd__exit_code(status), "the dry run: %s", message);
  run(&session, out, fmin(DRY, x->seconds));
  atomic_store(&out->over, true);
  ethd__session_halt(&session, false);
  if (ethd__session_end(&session, message)) ethd__fail(ETHD_EXIT_FAILED, "the dry run: %s", message);
  ethd__session_free(&session);
}

static int record(const ethd__excitation *x, const ethd_config *c, double torque) {
  static ethd__session session;
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *text = compose(x, c, torque, false);
  seen out = {.at = x->at};
  ethd__session_options o = {.config = x->config,
                             .text = text,
                             .folder = c->folder,
                             .record = x->record,
                             .replace = x->replace,
                             .is_virtual = x->is_virtual,
                             .sink = {&out, take},
                             .loop = ethd_loop_default()};
  ethd__need(ethd__session_open(&o, &session, message), message);
  ethd__remarks_print(stderr, &session);
  run(&session, &out, x->seconds);
  atomic_store(&out.over, true);
  ethd__session_halt(&session, ethd__stop);
  ethd_status status = ethd__session_end(&session, message);
  ethd__summary_print(stdout, &session, x->record);
  if (status) fprintf(stderr, "%s: %s\n", program_invocation_short_name, message);
  ethd__session_free(&session);
  if (!status && left_box(&out))
    fprintf(stderr,
            "%s: the guard stopped the ring %.3g m from the middle of the box: put it there before the start, or "
            "use less --share or more --half\n",
            program_invocation_short_name, out.farthest);
  else if (!status && out.fault)
    fprintf(stderr, "%s: %s: correct it and record again\n", program_invocation_short_name,
            ethd_fault_sentence((ethd_fault)out.fault));
  return status || out.fault ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

/* ---- how much torque ---- */

static double torque_limit(const ethd__excitation *x, const ethd_config *c) {
  char message[ETHD_MESSAGE_MAX];
  ethd_device *device;
  const ethd_device_def def = {&c->setup, c->settings, c->setting_count, c->folder, c->path, x->is_virtual, NULL};
  ethd__need(ethd_device_open(c->device, NULL, &def, &device, message), message);
  ethd_limits limits = ethd_device_limits(device);
  ethd_device_close(device);
  double most = fmin(limits.torque, c->setup.limits.torque);
  if (!isnan(x->torque)) most = fmin(most, x->torque);
  if (!isfinite(most))
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: neither device nor configuration limits the torque: set limits.torque, or give --torque",
               x->config ? x->config : "the defaults");
  return most;
}

static void leave_if_stopped(void) {
  if (ethd__stop) ethd__fail(ETHD_EXIT_FAILED, "stopped before the device was enabled; nothing is recorded");
}

int ethd__excite(const ethd__excitation *given) {
  char message[ETHD_MESSAGE_MAX];
  ethd__excitation x = *given;
  ethd_config *config;
  ethd__need(ethd_config_load(x.config, &config, message), message);
  ethd__need_plane(config);
  (x.is_virtual ? ethd__catch_end : ethd__hold_device)(); /* from here on no print waits */
  double torque = torque_limit(&x, config);
  seen dry;
  dry_run(&x, config, torque, &dry);
  for (int i = 0; i < TRIES && !ethd__stop && (dry.fault || dry.farthest > USED * x.half); i++) {
    x.share *= LESS;
    dry_run(&x, config, torque, &dry);
  }
  leave_if_stopped();
  if (dry.fault)
    ethd__fail(ETHD_EXIT_FAILED, "in the dry run with %.3g Nm: %s: give a larger --half", x.share * torque,
               ethd_fault_sentence((ethd_fault)dry.fault));
  printf("torques up to %.3g Nm (%.0f %% of the limit), sines from 0.5 to 40 Hz, for %g s\n", x.share * torque,
         100 * x.share, x.seconds);
  printf("inside a box of %.3g x %.3g m about (%.3g, %.3g), which the guard holds\n", 2 * x.half, 2 * x.half, x.at.x,
         x.at.y);
  printf("dry run       on the simulated device: up to %.3g m from the middle, %.3g m/s\n", dry.farthest, dry.fastest);
  fflush(stdout);
  int code = record(&x, config, torque);
  ethd_config_free(config);
  return code;
}
