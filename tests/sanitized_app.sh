#!/bin/sh
# An application under a sanitizer, beside the library as it is built for everybody: the loop runs with its usual stack, and
# nothing is reported. ThreadSanitizer gets the suppression of drivers/README.md.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: the library itself is sanitized"; exit 77; }

cat >"$folder/app.c" <<'EOF'
#include <ethd/ethd.h>
#include <ethd/loop.h>
#include <stdio.h>
#include <time.h>

/* A device whose readings come from its I/O thread. */
typedef struct device {
  ethd_cell *cell;
  double q;
  int reads;
} device;

static void millisecond(void) {
  const struct timespec t = {0, 1000000};
  nanosleep(&t, NULL);
}
static device d;
static ethd_status open_it(const ethd_device_def *def, void **out, char *message) {
  return (void)def, (void)message, *out = &d, ETHD_OK;
}
static void close_it(void *it) { (void)it; }
static ethd_status start(void *d) { return ((device *)d)->q = 1.5, ETHD_OK; }
static ethd_status read_it(void *d_, int64_t now, ethd_sense *out) {
  device *d = d_;
  double reading[8];
  (void)ethd_cell_take(d->cell, reading);
  d->reads++;
  out->time_ns = now;
  out->q[0] = d->q;
  return ETHD_OK;
}
static ethd_status write_it(void *d, int64_t now, const ethd_command *c) { return (void)d, (void)now, (void)c, ETHD_OK; }
static void safe(void *d) { (void)d; }
static uint32_t units(const void *d) { return (void)d, 1; }
static ethd_status service(void *d, uint32_t unit, int64_t now) {
  const double reading[8] = {unit, (double)now};
  ethd_cell_put(((device *)d)->cell, reading);
  millisecond();
  return ETHD_OK;
}
static ethd_status push(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)speed, (void)entering;
  ((double *)state)[0]++;
  *force = gap < 0 ? p[0] * gap : 0;
  return ETHD_OK;
}

static const ethd_driver driver = {.size = sizeof driver, .abi = ETHD_DRIVER_ABI, .id = "app", .brief = "app", .open = open_it, .close = close_it, .start = start,
                                   .read = read_it, .write = write_it, .units = units, .service = service, .safe = safe};
static const ethd_param params[] = {{"k", "N/m", 0, 1e4, 100, "stiffness"}};
static const ethd_contact_law law = {.law = {sizeof law, ETHD_ABI, ETHD_CONTACT, 8, "app", "app", params, 1, NULL, NULL}, .step = push};

int main(void) {
  const char wall[] = "halfplane -1 0 -0.5";
  char message[ETHD_MESSAGE_MAX];
  ethd_setup setup = ethd_setup_default();
  ethd_scene *scene;
  ethd_control *control;
  ethd_loop *loop;
  ethd_error error;
  if (ethd_scene_parse(wall, sizeof wall - 1, &scene, &error)) return 2;
  setup.scene = scene;
  ethd_setup_contact(&setup, &law);
  if (ethd_control_create(&setup, &control, &error) || ethd_cell_create(8 * sizeof(double), &d.cell, &error)) return 3;
  ethd_loop_def def = ethd_loop_default();
  const ethd_driver *const drivers[] = {&driver, NULL};
  const ethd_device_def app = {.setup = &setup, .folder = "."};
  if (ethd_device_open("app", drivers, &app, &def.device, message)) return printf("%s\n", message), 8;
  def.control = control;
  if (ethd_loop_create(&def, &loop, &error)) return 4;
  if (ethd_loop_start(loop, &error)) return printf("start: %s %g\n", error.name, error.found), 5;
  for (int i = 0; i < 300; i++) {
    ethd_loop_row row;
    ethd_event event;
    while (ethd_loop_take(loop, &row) == ETHD_OK || ethd_control_poll(control, &event) == ETHD_OK) continue;
    setup.contact_p[0] = 100 + i;
    if (i % 50 == 10) (void)!ethd_control_post(control, &setup, &error);
    if (i % 100 == 60) (void)!ethd_loop_enable(loop);
    millisecond();
  }
  ethd_loop_stop(loop);
  if (ethd_loop_join(loop)) return 6;
  ethd_loop_destroy(loop);
  ethd_device_close(def.device);
  ethd_control_destroy(control);
  ethd_cell_destroy(d.cell);
  ethd_scene_destroy(scene);
  return d.reads > 10 ? 0 : 7;
}
EOF

awk '/^## An application under a sanitizer/ { here = 1 } here && /^```$/ { exit } here && inside; here && /^```text/ { inside = 1 }' \
  drivers/README.md >"$folder/suppressions"
[ -s "$folder/suppressions" ] || fail "drivers/README.md has no suppression"
export LD_LIBRARY_PATH=$BUILD TSAN_OPTIONS=suppressions=$folder/suppressions:halt_on_error=0
tried=0
for sanitizer in thread address,undefined; do
  $CC -std=gnu11 -O1 -g -fsanitize=$sanitizer -Iinclude "$folder/app.c" -L"$BUILD" -lethd-drivers -lethd -o "$folder/app" 2>"$folder/said" ||
    { echo "no -fsanitize=$sanitizer here"; continue; }
  timeout 120 "$folder/app" >"$folder/said" 2>&1
  code=$?
  grep -q 'unexpected memory mapping' "$folder/said" && { echo "this kernel's addresses are too random for $sanitizer"; continue; }
  tried=1
  [ $code = 0 ] && [ ! -s "$folder/said" ] || fail "$sanitizer, exit $code: $(head -n 20 "$folder/said")"
done
[ $tried = 1 ] || { echo "SKIP: $CC has no sanitizer"; exit 77; }
exit $failed
