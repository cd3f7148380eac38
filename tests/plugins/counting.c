/* The law pd, and a count of its steps. `counting_steps` is there for whoever has loaded this; when the
   process ends the count goes into the file that COUNTING_FILE names. */
#include <ethd/plugin.h>
#include <stdio.h>
#include <stdlib.h>

ETHD_API extern long counting_steps;
long counting_steps;

static ethd_status step(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  counting_steps++;
  return ethd_tracking_pd.step(p, state, in, tau);
}

static const ethd_param params[] = {
    {"k_t", "Nm/rad", 0, 1e4, 40, "as of pd"},
    {"b_t", "Nms/rad", 0, 1e3, 1, "as of pd"},
    {"derivative", "velocity|difference", 0, 1, 0, "as of pd"},
};

static const ethd_tracking_law counting = {
    .law = {sizeof(ethd_tracking_law), ETHD_ABI, ETHD_TRACKING, 64, "counting-pd", "pd that counts its steps", params,
            3, NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){"k_t", "b_t"},
};

static const ethd_law *const laws[] = {&counting.law};
const ethd_plugin_entry ethd_plugin = {sizeof(ethd_plugin_entry), ETHD_ABI, "counting", "1.0", laws, 1};

__attribute__((destructor)) static void tell(void) {
  const char *path = getenv("COUNTING_FILE");
  FILE *file = path ? fopen(path, "a") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", counting_steps);
  fclose(file);
}
