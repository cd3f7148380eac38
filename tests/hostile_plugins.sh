#!/bin/sh
# Plugins that hang or end the program, seen from the programs: they say which one it was, and exit 1 in time.
. tests/begin.sh

echo 'halfplane -1 0 -0.238' >"$folder/wall.scene"
config() { printf '[plugins]\nfile = %s/tests/plugins/%s.so\n[scene]\nfile = wall.scene\n[transition]\nlaw = broken\n' "$BUILD" "$1" >"$folder/$1.ini"; }
for plugin in hangs hangs_check exits exits_later writes_past rounds brief_escapes says_nan; do config $plugin; done

# ends PLUGIN SECONDS PATTERN COMMAND...: exit 1 within SECONDS, and one line that names the plugin
ends() {
  plugin=$1 most=$2 pattern=$3
  shift 3
  before=$(date +%s%N)
  timeout -s KILL 60 "$@" >"$folder/out" 2>"$folder/err" </dev/null
  code=$?
  spent=$((($(date +%s%N) - before) / 1000000))
  [ $code = 1 ] || fail "$plugin: exit $code: $(cat "$folder/out" "$folder/err")"
  grep -q -e "$pattern" "$folder/err" || fail "$plugin: no $pattern in: $(cat "$folder/err")"
  [ -n "${SAN:-}" ] || [ $spent -le $((most * 1000)) ] || fail "$plugin: $spent ms, $most s are allowed"
  echo "$plugin: exit $code after $spent ms: $(grep -e "$pattern" "$folder/err" | head -n 1)"
}

# A step that hangs: the simulated finger reaches the wall within the first second.
case ${SAN:-} in
  *thread*) ;; # its threads don't fit into the loop's stack
  *)
    ends hangs 20 "ethd-run: the law broken doesn't return" "$BUILD/bin/ethd-run" --config "$folder/hangs.ini" --record "$folder/hung" --duration 30
    grep -q "fault,the law broken doesn't return" "$folder/hung/events.csv" || fail "hangs: events.csv: $(cat "$folder/hung/events.csv")"
    grep -q "1 x the loop's thread doesn't run" "$folder/out" || fail "hangs: no row 3 in: $(cat "$folder/out")"
    "$BUILD/bin/ethd-replay" --help >/dev/null || fail "--help"
    ;;
esac

# A law that returns NaN, or a failure: its taps are faults, and the table names the law, its kind and the fault.
finite="a law's output isn't a finite number in its range"
"$BUILD/bin/ethd-tap" --config "$folder/says_nan.ini" --taps 2 >"$folder/out" || fail "says_nan: exit $?"
grep -qx "broken: the first fault: the transition law broken: $finite" "$folder/out" || fail "says_nan: $(cat "$folder/out")"
config fails
"$BUILD/bin/ethd-tap" --config "$folder/fails.ini" --taps 2 >"$folder/out" || fail "fails: exit $?"
grep -qx "broken: the first fault: the transition law broken: a law reported a failure" "$folder/out" || fail "fails: $(cat "$folder/out")"
# also where the law is none of those that are compared: each program that steps says it in the same words
cat >"$folder/contact.c" <<'END'
#include <ethd/plugin.h>
static ethd_status step(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)p, (void)state, (void)speed, (void)entering;
  *force = gap < 0 ? 0.0 / 0.0 : 0;
  return gap < 0 ? RETURNS : ETHD_OK;
}
static const ethd_contact_law law = {.law = {sizeof law, ETHD_ABI, ETHD_CONTACT, 0, "soft", "soft", 0, 0, 0, 0}, .step = step};
static const ethd_law *const laws[] = {&law.law};
const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "soft", "1.0", laws, 1};
END
printf 't_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps\n' >"$folder/into.csv"
awk 'BEGIN { for (i = 0; i < 6; i++) printf "%.3f,%.3f,0.15,0.27,0.285,-0.2,0\n", i / 1000, 1.45 + 0.002 * i }' >>"$folder/into.csv"
contact() { # STATUS SENTENCE
  $CC -shared -fPIC -Iinclude -DRETURNS="$1" "$folder/contact.c" -o "$folder/contact.so" || fail "$1 doesn't compile"
  printf '[plugins]\nfile = contact.so\n[scene]\nfile = wall.scene\n[contact]\nlaw = soft\n' >"$folder/contact.ini"
  said="the contact law soft: $2"
  "$BUILD/bin/ethd-tap" --config "$folder/contact.ini" --transition offset,smooth --taps 1 >"$folder/out" || fail "$1: exit $?"
  for law in offset smooth; do grep -qx "$law: the first fault: $said" "$folder/out" || fail "$1: $(cat "$folder/out")"; done
  "$BUILD/bin/ethd-run" --virtual --duration 3 --config "$folder/contact.ini" >"$folder/out" 2>"$folder/err" </dev/null
  [ "$(grep -cx "ethd-run: $said" "$folder/err")" = 1 ] || fail "$1: ethd-run: $(cat "$folder/err")"
  sed 's/-0.238/-0.2765/' "$folder/wall.scene" >"$folder/near.scene"
  sed 's/wall.scene/near.scene/' "$folder/contact.ini" >"$folder/into.ini"
  "$BUILD/bin/ethd-replay" --config "$folder/into.ini" --in "$folder/into.csv" --out "$folder/out.csv" >"$folder/out" 2>"$folder/err"
  [ $? = 1 ] && grep -q "into.csv:[2-5]: $said; the torque is 0 there" "$folder/err" || fail "$1: ethd-replay: $(cat "$folder/err")"
}
contact ETHD_OK "$finite"
printf '[study]\nparticipants = 1\nstrategies = smooth,offset\nspeeds = low\ntraining = 1\ntaps = 2\nattempts = 2\nsurvey = off\n[device]\nconfig = contact.ini\n' >"$folder/one.study"
"$BUILD/bin/ethd-study" "$folder/one.study" --quiet --out "$folder/study" >"$folder/out" 2>"$folder/err" || fail "a study: $(cat "$folder/err")"
[ "$(grep -cx "ethd-study: the contact law soft: $finite; its taps count as faults" "$folder/err")" = 1 ] || fail "a study: $(cat "$folder/err")"
contact ETHD_E_UNREACHABLE "out of the arm's reach"

# A step that hangs where no thread watches: the program's own alarm ends it.
hangs="a plugin's law doesn't return"
ends hangs 20 "ethd-run: $hangs" "$BUILD/bin/ethd-run" --virtual --duration 30 --config "$folder/hangs.ini"
ends hangs 20 "ethd-tap: $hangs" "$BUILD/bin/ethd-tap" --config "$folder/hangs.ini" --taps 1 --transition broken
printf 't_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps\n' >"$folder/in.csv"
awk 'BEGIN { for (i = 0; i < 300; i++) printf "%.4f,1.45,0.15,%.6f,0.25,-0.2,0\n", i / 1000, 0.27 - 0.0002 * i }' >>"$folder/in.csv"
sed 's/-0.238/-0.275/' "$folder/wall.scene" >"$folder/near.scene"
sed 's/wall.scene/near.scene/' "$folder/hangs.ini" >"$folder/near.ini"
ends hangs 20 "ethd-replay: $hangs" "$BUILD/bin/ethd-replay" --config "$folder/near.ini" --in "$folder/in.csv" --out "$folder/out.csv"

# A check that hangs, at load.
ends hangs_check 15 "ethd-check: the check of a plugin's law doesn't return" "$BUILD/bin/ethd-check" "$folder/hangs_check.ini"

# exit(0) in a constructor and in a step.
ends exits 5 "exits.so ended the program" "$BUILD/bin/ethd-check" "$folder/exits.ini"
ends exits 5 "exits.so ended the program" "$BUILD/bin/ethd-check" --laws --plugin "$BUILD/tests/plugins/exits.so"
ends exits_later 10 "a plugin's law ended the program" "$BUILD/bin/ethd-run" --virtual --duration 30 --config "$folder/exits_later.ini"
ends exits_later 10 "a plugin's law ended the program" "$BUILD/bin/ethd-tap" --config "$folder/exits_later.ini" --taps 1 --transition broken

# A law that writes past its state or rounds otherwise: the run goes on safely, and its end says what it was.
for plugin in writes_past rounds; do
  "$BUILD/bin/ethd-run" --virtual --duration 3 --config "$folder/$plugin.ini" >"$folder/out" 2>"$folder/err" </dev/null ||
    fail "$plugin: exit $?: $(cat "$folder/err")"
  grep -q 'fault: a law reported a failure' "$folder/err" || fail "$plugin: $(cat "$folder/err")"
  grep -q 'the transition law broken: a law ' "$folder/err" || fail "$plugin: which law? $(cat "$folder/err")"
done

# No text of a plugin steers the terminal.
"$BUILD/bin/ethd-check" --laws --plugin "$BUILD/tests/plugins/brief_escapes.so" >"$folder/out" 2>&1
[ $? = 2 ] || fail "brief_escapes: $(cat "$folder/out")"
if LC_ALL=C grep -q '[[:cntrl:]]' "$folder/out"; then fail "brief_escapes: a control character"; fi
[ $failed = 0 ] && echo 'every one of them is named'
exit $failed
