#!/bin/sh
# Programs that were compiled with other headers than this library's: each is refused in one sentence, and nothing of its
# memory is written but what it gave.
. tests/begin.sh
if [ -n "${SAN:-}" ]; then echo "SKIP: the program here isn't sanitized, the library would be"; exit 77; fi

cat >"$folder/app.c" <<'EOF'
#include <ethd/ethd.h>
#include <stdio.h>
#include <string.h>

static struct {
  unsigned char before[512];
  ethd_setup setup;
  unsigned char behind[512];
} box;

static int changed(const volatile unsigned char *at, int count) {
  int n = 0;
  for (int i = 0; i < count; i++) n += at[i] != 7;
  return n;
}

/* Everything that writes a setup or limits which the program has made. */
static int write_all(void) {
  ethd_error error;
  memset(&box, 7, sizeof box);
  box.setup = ethd_setup_default();
  box.setup.limits = ethd_limits_device();
  ethd_limits other = ethd_limits_torque(1);
  box.setup.limits = ethd_limits_narrower(&box.setup.limits, &other);
  ethd_setup_tracking(&box.setup, &ethd_tracking_pd);
  ethd_setup_contact(&box.setup, &ethd_contact_spring);
  ethd_setup_transition(&box.setup, &ethd_transition_predictive);
  ethd_setup_velocity(&box.setup, ETHD_VELOCITY_LOWPASS);
  ethd_setup_fit(&box.setup, ETHD_FIT_KASA);
  ethd_setup_filter(&box.setup, ETHD_FILTER_CA);
  (void)!ethd_setup_choose(&box.setup, "contact", "spring", ethd_laws, &error);
  (void)!ethd_setup_set(&box.setup, "arm.delay", 0.001, &error);
  (void)!ethd_setup_set(&box.setup, "limits.joints[3]", 1, &error);
  return changed(box.before, sizeof box.before) + changed(box.behind, sizeof box.behind);
}

/* The same on the stack, where a struct that is too long for its place runs over its neighbours. */
static int on_the_stack(void) {
  volatile unsigned char low[256];
  memset((void *)low, 7, sizeof low);
  ethd_setup setup = ethd_setup_default();
  volatile unsigned char middle[256];
  memset((void *)middle, 7, sizeof middle);
  ethd_limits limits = ethd_limits_none();
  volatile unsigned char high[256];
  memset((void *)high, 7, sizeof high);
  setup.limits = limits;
  return changed(low, sizeof low) + changed(middle, sizeof middle) + changed(high, sizeof high);
}

int main(void) {
  ethd_control *control;
  ethd_error error = {ETHD_OK};
  const int written = write_all() + on_the_stack();
  ethd_setup setup = ethd_setup_default();
  const ethd_status status = ethd_control_create(&setup, &control, &error), check = ethd_setup_check(&setup, NULL);
  printf("%d bytes, %d, %s, found %g of %g\n", written, status == check ? status : 99, status ? error.name : "",
         status ? error.found : 0, status ? error.max : 0);
  return 0;
}
EOF

# The same where the setup comes from a configuration, and of a loop.
cat >"$folder/device.c" <<'EOF'
#include <ethd/config.h>
#include <ethd/loop.h>
#include <stdio.h>

int main(void) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd_loop *loop;
  ethd_error error;
  const ethd_loop_def def = ethd_loop_default();
  if (ethd_config_load(NULL, &config, message) == ETHD_OK) puts("configuration read"), ethd_config_free(config);
  else printf("%s\n", message);
  if (ethd_loop_create(&def, &loop, &error) == ETHD_E_SIZE) printf("%s, found %g of %g\n", error.name, error.found, error.max);
  else printf("%s is missing\n", error.name);
  return 0;
}
EOF

# Gives what the program says when it was compiled with the headers in a folder.
says() { # INCLUDE -> sentence
  $CC -std=gnu11 -O0 -w -I"$1" "$folder/app.c" "$BUILD/libethd.a" -ldl -lm -o "$folder/app" && "$folder/app"
}
device_says() { # INCLUDE -> two sentences
  $CC -std=gnu11 -O0 -w -I"$1" "$folder/device.c" "$BUILD/libethd-drivers.a" "$BUILD/libethd.a" -linih -ljansson -lmodbus \
    -ldl -lm -lpthread -o "$folder/device" && "$folder/device"
}
cat >"$folder/sizes.c" <<'EOF'
#include <ethd/config.h>
#include <ethd/loop.h>
#include <stdio.h>
int main(void) {
  printf("setup=%zu sense=%zu limits=%zu counters=%zu ", sizeof(ethd_setup), sizeof(ethd_sense), sizeof(ethd_limits),
         sizeof(ethd_counters));
  printf("config=%zu def=%zu row=%zu", sizeof(ethd_config), sizeof(ethd_loop_def), sizeof(ethd_loop_row));
  return 0;
}
EOF
$CC -std=gnu11 -Iinclude -c "$folder/sizes.c" -o "$folder/sizes.o" &&
  $CC "$folder/sizes.o" "$BUILD/libethd-drivers.a" "$BUILD/libethd.a" -linih -ljansson -lmodbus -ldl -lm -lpthread -o "$folder/sizes" || fail "no sizes"
eval "$("$folder/sizes")"

is() { # WHAT INCLUDE EXPECTED
  said=$(says "$2" 2>&1)
  [ "$said" = "$3" ] || fail "$1: $said, not $3"
}
is "these headers" include "0 bytes, 0, , found 0 of 0"
other() { # WHAT FILE SED EXPECTED: with one struct changed
  rm -rf "$folder/include"
  cp -r include "$folder/include"
  sed -i "$3" "$folder/include/ethd/$2"
  cmp -s "include/ethd/$2" "$folder/include/ethd/$2" && fail "$1: nothing was changed"
  is "$1" "$folder/include" "$4"
}
device_is() { # WHAT CONFIGURATION LOOP: with the last headers
  said=$(device_says "$folder/include" 2>&1)
  [ "$said" = "$2
$3" ] || fail "$1: $said, not $2 and $3"
}
cp -r include "$folder/include"
device_is "these headers" "configuration read" "device is missing"
other "a shorter setup" control.h '/^  double v_hysteresis;/d' "0 bytes, -11, ethd_setup, found $((setup - 8)) of $setup"
other "a much shorter setup" control.h 's/_p\[ETHD_PARAMS_MAX\];/_p[1];/' \
  "0 bytes, -11, ethd_setup, found $((setup - 6 * 15 * 8)) of $setup"
other "a longer setup" control.h 's/^  double swap_time;/  double more[9];\n&/' \
  "0 bytes, -11, ethd_setup, found $((setup + 72)) of $setup"
other "shorter limits" guard.h '/^  double heat_time;/d' "0 bytes, -11, ethd_limits, found $((limits - 8)) of $limits"
other "longer limits" guard.h 's/^  double torque;/  double more[30];\n&/' \
  "0 bytes, -11, ethd_limits, found $((limits + 240)) of $limits"
# A driver's file whose limits are longer would run over the library's: its ABI differs.
$CC -shared -fPIC -w -I"$folder/include" -Itests drivers/hello/hello.c -DHELLO=ethd_driver_plugin -o "$folder/hello.so" || fail "hello isn't built"
said=$("$BUILD/bin/ethd-check" --driver "$folder/hello.so" 2>&1)
case $said in
*"it was built with an ethd_limits of $((limits + 240)) bytes, here it has $limits: build it"*) ;;
*) fail "a driver with longer limits: $said" ;;
esac
other "a longer sense" sense.h 's/^  X(double, q, 2/  X(double, more, 16, "1", "more") \\\n&/' \
  "0 bytes, -11, ethd_sense, found $((sense + 128)) of $sense"
device_is "a longer sense" "ethd_sense: a struct of other headers; compile again with this version's; found $((sense + 128)), allowed $sense to $sense" \
  "ethd_loop_row, found $((row + 128)) of $row"
other "more counters" control.h 's/^  uint64_t ticks, /&more, /' \
  "0 bytes, -11, ethd_counters, found $((counters + 8)) of $counters"
other "a longer list" control.h 's/ X(counters)$/& X(error)/' "0 bytes, -11, ethd_sizes, found 36 of 32"
other "a shorter list" control.h 's/ X(counters)$//' "0 bytes, -11, ethd_sizes, found 28 of 32"

other "a longer configuration" config.h 's/^  uint32_t plugin_count;/&\n  char more[64];/' "0 bytes, 0, , found 0 of 0"
device_is "a longer configuration" "ethd_config: a struct of other headers; compile again with this version's; found $((config + 64)), allowed $config to $config" \
  "device is missing"
other "a longer definition" loop.h 's/^  uint32_t rows; .*/&\n  char more[64];/' "0 bytes, 0, , found 0 of 0"
device_is "a longer definition" "configuration read" "ethd_loop_def, found $((def + 64)) of $def"

# A program that was linked before the symbols' version said 0.1 doesn't start.
echo 'ETHD_0 { global: ethd_*; };' >"$folder/old.map"
echo 'void ethd_setup_default(void) {}' >"$folder/old_library.c"
printf 'void ethd_setup_default(void);\nint main(void) { ethd_setup_default(); }\n' >"$folder/old.c"
$CC -shared -fPIC -Wl,-soname,libethd.so.0 -Wl,--version-script="$folder/old.map" "$folder/old_library.c" -o "$folder/libethd.so.0"
$CC "$folder/old.c" "$folder/libethd.so.0" -o "$folder/old"
LD_LIBRARY_PATH=$folder "$folder/old" || fail "the old program doesn't run with its own library"
said=$(LD_LIBRARY_PATH=$BUILD "$folder/old" 2>&1)
case $said in
*"version \`ETHD_0' not found"*) ;;
*) fail "an old program with this library: $said" ;;
esac
exit $failed
