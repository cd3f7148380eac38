#!/bin/sh
# What a program says when something is missing leads on: each hint is followed as it stands. And one thing is one thing:
# "1 participant", not "1 participants".
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: plugins are built without the sanitizer"; exit 77; }
tree=$PWD
export PATH="$BUILD/bin:$PATH"
cd "$folder" || exit 1
try=yes
does() { # PATTERN COMMAND...
  pattern=$1
  shift
  "$@" >out 2>&1 </dev/null || fail "$*: exit $?: $(cat out)"
  grep -q -e "$pattern" out || fail "$*: no $pattern in: $(cat out)"
}

# ---- a plugin that is refused: which file, which law, what is wrong, what is allowed ----
plugin() { # NAME ID PARAMS COUNT
  cat >"$1.c" <<C
#include <ethd/plugin.h>
static ethd_status step(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)p, (void)state, (void)speed, (void)entering;
  *force = gap < 0 ? 1e3 * gap : 0;
  return ETHD_OK;
}
static const ethd_param params[] = {{"k", "N/m", 0, 1e4, 500, "stiffness"}, $3};
static const ethd_contact_law law = {
    .law = {sizeof law, ETHD_ABI, ETHD_CONTACT, 0, $2, "a spring", params, $4, NULL, NULL}, .step = step};
static const ethd_law *const laws[] = {&law.law};
const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "mine", "1.0", laws, 1};
C
  $CC -shared -fPIC -I"$tree/include" "$1.c" -o "$1.so" || fail "$1 doesn't compile"
  printf '[plugins]\nfile = %s.so\n' "$1" >"$1.ini"
}
refused() { # NAME ID PARAMS COUNT PATTERN
  plugin "$1" "$2" "$3" "$4"
  refuse 2 "$1.ini:2: plugins.file: $1.so: $5" ethd-check "$1.ini"
  refuse 2 "plugins.file: $1.so: $5" ethd-check --laws --plugin "$1.so"
}
row='{"b", "Ns/m", 0, 10, 5, "damping"}'
refused id '"My Law"' "$row" 2 'law 1 of 1: its id is "My Law", 1 to 31 of a-z 0-9 - are allowed'
refused no_id NULL "$row" 2 'law 1 of 1: its id is NULL, 1 to 31'
refused order '"mine"' '{"b", "Ns/m", 10, 0, 5, "damping"}' 2 'law mine: params: row 2, b: found min 10, max 0, default 5; min <= default'
refused default '"mine"' '{"b", "Ns/m", 0, 10, 50, "damping"}' 2 'law mine: params: row 2, b: found min 0, max 10, default 50; min'
refused name '"mine"' '{"B d", "Ns/m", 0, 10, 5, "damping"}' 2 'law mine: params: row 2: its name is "B d", 1 to 31 of a-z 0-9 _ are allowed'
refused twice '"mine"' '{"k", "Ns/m", 0, 10, 5, "damping"}' 2 'law mine: params: row 2, k: an earlier row has that name'
refused brief '"mine"' '{"b", "Ns/m", 0, 10, 5, "a\nb"}' 2 'law mine: params: row 2, b: its brief is "a?b", one line'
refused words '"mine"' '{"b", "one|two", 0, 5, 0, "damping"}' 2 'law mine: params: row 2, b: the words "one|two" with min 0, max 5'
refused rows '"mine"' "$row" 17 'law mine: params: 17 rows, at most 16 are allowed'
for pair in "wrong_abi:it was built for version 2 of the laws' interface, this is version 1: build it with these headers" \
  'no_step:law broken: it has no step' 'big_state:law broken: its state has [0-9]* bytes, at most 512' \
  'entry_id:ethd_plugin: its id is' 'brief_long:law broken: its brief is ".*\.\.\.", one line of 1 to 200' \
  'driver_canary:a driver, not a plugin with laws: \[device\] driver = file:NAME.so names it' \
  'no_symbol:no plugin: it has no symbol ethd_plugin'; do
  cp "$BUILD/tests/plugins/${pair%%:*}.so" .
  refuse 2 "plugins.file: ${pair%%:*}.so: ${pair#*:}" ethd-check --laws --plugin "${pair%%:*}.so"
done

# ---- a law that is named, and its file forgotten ----
plugin own '"own"' "$row" 2
printf '[contact]\nlaw = own\n' >forgot.ini
for command in 'ethd-check' 'ethd-tap --taps 1 --config' 'ethd-run --virtual --duration 1 --config'; do
  refuse 2 'forgot.ini:2: contact.law: found "own", .*; a law of a plugin needs its file too: \[plugins\] file = NAME.so' $command forgot.ini
done
printf '[plugins]\nfile = own.so\n' >>forgot.ini
does 'is valid' ethd-check forgot.ini
sed -i 's/^law = own/law = owm/' forgot.ini
refuse 2 'found "owm", .*, own is allowed; the files of \[plugins\] have no other law of this kind' ethd-check forgot.ini

# ---- a recording with a plugin: --plugins, wherever it stands ----
printf '[plugins]\nfile = own.so\n[contact]\nlaw = own\n' >own.ini
does 'Tapping study' ethd-tap --config own.ini --taps 6 --transition offset --speed low --record taps
refuse 2 'own.so is a program from outside of this folder; --plugins lets it run' ethd-replay --verify taps
does 'equal to the bit' ethd-replay --verify taps --plugins
does 'equal to the bit' ethd-replay --verify --plugins taps
does 'equal to the bit' ethd-replay --plugins --verify taps
refuse 2 "--verify: a recording's folder is needed" ethd-replay --verify --plugins
refuse 2 '--plugins lets it run' ethd-identify taps
refuse 2 'windows of 0.25 s' ethd-identify --plugins taps

# ---- a study with a plugin: its hint is the whole command ----
study='[study]\nparticipants = 1\nstrategies = smooth,offset\nspeeds = low\ntraining = 1\ntaps = 1\nattempts = 2\nsurvey = off\n'
printf "$study[device]\nconfig = own.ini\n" >own.study
does '' ethd-study own.study --quiet --out 'a study'
hint=$(sed -n 's/.*; \(ethd-report .*\) draws .*/\1/p' out)
[ "$hint" = "ethd-report --plugins 'a study'" ] || fail "the study's hint: $(cat out)"
if gnuplot -e 'set terminal pngcairo' </dev/null 2>/dev/null; then does 'a study/report/report.html' sh -c "$hint"; fi

# ---- a recording where a study is expected: the message names it, and the program that shows it ----
does 'Tapping study' ethd-tap --taps 1 --transition offset --speed low --record one
for command in 'ethd-report' 'ethd-study --resume'; do
  refuse 2 'one: a recording, not a study.s folder: ethd-replay --verify one checks it, ethd-convert one NAME.csv' $command one
done
does 'equal to the bit' ethd-replay --verify one
does 'ticks' ethd-convert one one.csv
refuse 2 'nowhere/study.ini: No such file' ethd-report nowhere

# ---- one of a kind ----
printf "$study" >one.study
does "isn't balanced with 1 participant;" ethd-study one.study --plan
does '' ethd-study one.study --quiet --simulate 1 --out sim
does 'taps of 1 participant at 1 point$' ethd-study --merge sim
refuse 2 'holds a simulation of 1 participant; another' ethd-study one.study --quiet --simulate 2 --out sim
does '' ethd-study one.study --quiet --out session
does '0 taps were missing; ethd-report session draws them' ethd-study --resume session
if gnuplot -e 'set terminal pngcairo' </dev/null 2>/dev/null; then
  does 'report.html' ethd-report session
  grep -q 'the sample is 1 participant, not the taps' session/report/report.html || fail "the page: 1 participant"
  ! grep -oE '(^|[^0-9.,])1 (participants|taps|cells|stations|sessions)[^.]{0,20}' session/report/report.html || fail "the page: one of a kind"
fi
printf 'circle 0.18 0.25 0.05\n' >one.scene
does '^one.scene: 1 object$' ethd-scene info one.scene
does '1 of 1 object,\|0 of 1 object,' ethd-scene info one.scene
[ $failed = 0 ] && echo 'hints lead on'
exit $failed
