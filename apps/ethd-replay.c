/* Runs recorded input through a law, in open loop; or verifies a recording. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/dropped.h"
#include "cli/law_fault.h"
#include "ethd/record.h"
#include "settings/config_parts.h"
#include "text/text.h"
#include "trace_in/trace_in.h"

static const char doc[] =
    "Runs recorded joint angles and finger movements through a control law, tick by tick, and writes the law's "
    "answers.\v"
    "IN needs the columns t_s,q1_rad,q2_rad and either xf_m,yf_m,vxf_mps,vyf_mps or t_ring_s,r0_m..r15_m. The columns "
    "dq1_radps,dq2_radps are optional. An empty cell in them or in the distances is a missing value. ethd-convert "
    "writes such a file. Torques are limited only if the configuration has [limits].\n\n"
    "Example:\n"
    "  ethd-replay --config smooth.ini --in finger.csv --out torque.csv\n"
    "  ethd-replay --verify recording/";

enum { OPTION_PLUGINS = 256 };

static const struct argp_option options[] = {
    {"config", 'c', "C.ini", 0, "configuration (default: built in)", 0},
    {"in", 'i', "IN.csv", 0, "recorded input", 0},
    {"out", 'o', "OUT.csv", 0, "write the law's answer, a row for each tick", 0},
    {"verify", 'v', "DIR", 0, "replay a recording and compare every field bit for bit", 0},
    {"plugins", OPTION_PLUGINS, NULL, 0, "with --verify: run the plugins of the recording", 0},
    {0},
};

static struct {
  const char *config, *in, *out, *verify;
  bool plugins, awaits; /* awaits: the folder of --verify is still to come */
} arg;

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'c': arg.config = text; return 0;
  case 'i': arg.in = text; return 0;
  case 'o': arg.out = text; return 0;
  case 'v':
    arg.awaits = strcmp(text, "--plugins") == 0; /* --verify --plugins DIR: the folder comes behind both */
    arg.plugins |= arg.awaits;
    if (arg.awaits) return 0;
    if (!strncmp(text, "--", 2)) argp_error(state, "--verify: found \"%s\", a folder comes first", text);
    arg.verify = text;
    return 0;
  case OPTION_PLUGINS: arg.plugins = true; return 0;
  case ARGP_KEY_ARG:
    if (arg.awaits && !arg.verify) {
      arg.verify = text;
      return 0;
    }
    argp_error(state, "\"%s\": no such argument", text);
    return 0;
  case ARGP_KEY_END:
    if (arg.verify && (arg.in || arg.out || arg.config))
      argp_error(state, "--verify takes no --config, --in or --out: a recording contains its configuration");
    else if (arg.awaits && !arg.verify)
      argp_error(state, "--verify: a recording's folder is needed");
    else if (arg.plugins && !arg.verify)
      argp_error(state, "--plugins belongs to --verify; a configuration of yours runs its plugins");
    else if (!arg.verify && (!arg.in || !arg.out))
      argp_error(state, "--in and --out are needed, or --verify");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static const char header[] = "t_s,tau1_Nm,tau2_Nm,tau1_raw_Nm,tau2_raw_Nm,beta,state,fex_N,fey_N,fdx_N,fdy_N,eps_m,d_"
                             "re_m,d_fe_m,v_n_mps,x_m,y_m,vx_mps,vy_mps,epsq1_rad,epsq2_rad";

static void put2(ethd_csv_out *out, const double v[2]) {
  ethd_csv_number(out, v[0]);
  ethd_csv_number(out, v[1]);
}

static void write_row(ethd_csv_out *out, double t, const ethd_trace *k, bool ring) {
  ethd_csv_number(out, t);
  put2(out, k->tau);
  put2(out, k->tau_raw);
  ethd_csv_number(out, k->beta);
  ethd_csv_integer(out, k->state);
  put2(out, k->fe);
  put2(out, k->fd);
  ethd_csv_number(out, k->eps);
  ethd_csv_number(out, k->d_re);
  ethd_csv_number(out, k->d_fe);
  ethd_csv_number(out, k->v_n);
  put2(out, k->x);
  put2(out, k->v);
  put2(out, k->eps_q);
  if (ring) {
    put2(out, k->xf);
    ethd_csv_number(out, k->rf);
  }
  ethd_csv_row(out);
}

static ethd_csv_out *open_out(bool ring, char message[ETHD_MESSAGE_MAX]) {
  char names[sizeof header + 16];
  snprintf(names, sizeof names, "%s%s", header, ring ? ",xf_m,yf_m,rf_m" : "");
  return ethd_csv_create(arg.out, names, message);
}

static void warn(const ethd__trace_in *in, size_t row, const char *what, const char *then) {
  fprintf(stderr, "%s: %s:%zu: %s; %s there\n", program_invocation_short_name, in->csv.path, ethd_csv_line(row), what,
          then);
}

/* A reaction of the guard is no failure; a law that fails is one. */
static bool is_guards(int64_t fault) { return fault == ETHD_FAULT_SPEED || fault == ETHD_FAULT_WORKSPACE; }

/* Steps through all rows; the first fault of either kind is said, the rest still runs. */
static int run(ethd_control *control, const ethd__trace_in *in, ethd_csv_out *out, const ethd_config *config) {
  int code = ETHD_EXIT_DONE;
  bool guarded = false;
  char text[ETHD_MESSAGE_MAX];
  for (size_t row = 0; row < in->csv.rows && !ethd__stop; row++) {
    ethd_sense sense = ethd__trace_in_sense(in, row);
    ethd_command command;
    ethd_trace trace;
    ethd__config_foreign(config, "a plugin's law");
    bool failed = ethd_control_step(control, &sense, &command, &trace) < 0;
    ethd__config_foreign(config, NULL);
    const ethd__law_fault by = ethd__law_fault_take(control, &config->setup);
    const char *what = by.law ? ethd__law_fault_text(&by, text) : ethd_fault_sentence((ethd_fault)trace.fault);
    if (failed && is_guards(trace.fault)) {
      if (!guarded) warn(in, row, what, "the guard brakes");
      guarded = true;
    } else if (failed && code == ETHD_EXIT_DONE) {
      warn(in, row, what, "the torque is 0");
      code = ETHD_EXIT_FAILED;
    }
    write_row(out, in->csv.values[row * in->csv.columns + (size_t)in->t], &trace, in->ring);
    ethd__progress(row + 1, in->csv.rows, "ticks");
  }
  return ethd__stop ? ETHD_EXIT_FAILED : code;
}

static void say(const ethd_control *control, const ethd_scene *scene, const ethd__trace_in *in) {
  ethd_counters c;
  ethd_control_counters(control, &c);
  printf("%s: %llu tick%s, scene queried in %llu", arg.out, (unsigned long long)c.ticks, ethd__s(c.ticks),
         (unsigned long long)c.queried);
  ethd__dropped_print(stdout, scene);
  if (in->ring) printf(", %llu frame%s dropped", (unsigned long long)c.readings_dropped, ethd__s(c.readings_dropped));
  printf("\n");
}

static int replay(void) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd__trace_in in;
  ethd_control *control;
  ethd_error error;
  ethd__need(ethd_config_load(arg.config, &config, message), message);
  ethd__need_plane(config);
  ethd__need(ethd__trace_in_read(arg.in, &in, message), message);
  config->setup.limits.latch = 0;
  ethd_status status = ethd_control_create(&config->setup, &control, &error);
  if (status < 0) {
    ethd_error_text(arg.config, &error, message);
    ethd__fail(ethd__exit_code(status), "%s", message);
  }
  ethd__refuse_input("--out", arg.out, "--in", arg.in);
  ethd__refuse_input("--out", arg.out, "--config", arg.config);
  ethd_csv_out *out = open_out(in.ring, message);
  if (!out) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  int code = run(control, &in, out, config);
  if (ethd__stop)
    ethd_csv_abandon(out);
  else if (ethd_csv_close(out, message) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  say(control, config->scene, &in);
  ethd_control_destroy(control);
  ethd__trace_in_free(&in);
  ethd_config_free(config);
  return code;
}

static int verify(void) {
  char message[ETHD_MESSAGE_MAX];
  ethd__need_recording(arg.verify);
  ethd_status status = ethd_recording_verify(arg.verify, arg.plugins, &ethd__stop, message);
  if (status >= 0) {
    printf("%s\n", message);
    return ETHD_EXIT_DONE;
  }
  ethd__fail(ethd__exit_code(status), "%s", message);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__catch_interrupt();
  ethd__receive(arg.verify);
  return ethd__end(arg.verify ? verify() : replay());
}
