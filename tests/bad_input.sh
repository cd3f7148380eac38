#!/bin/sh
# Bad input of every kind: exit 2, one line on stderr, and what stood at the output stays as it was.
. tests/begin.sh
bin=$BUILD/bin

# bad WHAT PATTERN COMMAND...: a short line, and what stood at the output stays
kept=$folder/out.csv
bad() {
  what=$1
  shift
  echo untouched >"$folder/out.csv"
  refuse 2 "$@"
  [ "$(wc -c <"$folder/err")" -lt 560 ] || fail "$what: a line of $(wc -c <"$folder/err") bytes"
  rm "$folder/out.csv"
  left=$(ls -A "$folder" | grep -v -x -e good.ini -e good.csv -e good.scene -e good.so -e 'bad\..*' -e out -e err -e state)
  [ -z "$left" ] || fail "$what: left behind: $left"
}

good() {
  "$@" >"$folder/out" 2>"$folder/err" || fail "good input: $*: $(cat "$folder/err")"
}

replay() { bad "$1" "$2" "$bin/ethd-replay" --config "$3" --in "$4" --out "$folder/out.csv"; }

cat >"$folder/good.ini" <<'END'
[scene]
file = good.scene
END
cat >"$folder/good.scene" <<'END'
halfplane -1 0 -0.238
END
cat >"$folder/good.csv" <<'END'
t_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps
0.000,1.57,0.00,0.25,0.25,0,0
0.001,1.57,0.01,0.25,0.25,0,0
0.002,1.57,0.02,0.25,0.25,0,0
END
good "$bin/ethd-replay" --config "$folder/good.ini" --in "$folder/good.csv" --out "$folder/out.csv"
good "$bin/ethd-check" "$folder/good.ini"
good "$bin/ethd-scene" info "$folder/good.scene"

# bad.X by name: the same faults for every kind of file
truncate -s 100M "$folder/bad.huge"
head -c 5000 "$bin/ethd-check" >"$folder/bad.binary"
: >"$folder/bad.empty"

# ---- names of files: none at all, and a plant without its configuration ----
for command in 'ethd-tap --config=' 'ethd-run --config=' 'ethd-replay --out=o.csv --in=' 'ethd-tap --finger='; do
  bad "$command" '"": a file.s name is needed' "$bin"/$command
done
for command in 'ethd-tap --taps 1 --plant' 'ethd-tune --plant'; do
  bad "$command" 'nowhere.ini: No such file or directory; the plant "nowhere" needs this configuration: put it there' "$bin"/$command nowhere
done

mkdir "$folder/bad.dir"
for recording in "$folder/bad.dir" "$folder/good.csv" nowhere; do
  for command in 'ethd-replay --verify' 'ethd-convert'; do
    bad "$command" 'no recording, whose tick.npy is needed: No.*; ethd-run --record makes one' "$bin"/$command "$recording" \
      $([ "$command" = ethd-convert ] && echo "$folder/bad.csv")
  done
done

# ---- configurations ----
config() { # WHAT PATTERN TEXT
  printf "$3" >"$folder/bad.ini"
  bad "check, $1" "$2" "$bin/ethd-check" "$folder/bad.ini"
  replay "replay, $1" "$2" "$folder/bad.ini" "$folder/good.csv"
}
replay 'missing configuration' 'no.ini: No such file' "$folder/no.ini" "$folder/good.csv"
replay 'a folder as configuration' 'is a folder' "$folder" "$folder/good.csv"
replay 'huge configuration' '104857600 bytes, at most 1048576' "$folder/bad.huge" "$folder/good.csv"
replay 'binary configuration' 'bad.binary:1: ' "$folder/bad.binary" "$folder/good.csv"
config 'duplicate' 'bad.ini:3: contact.k_e: occurs twice' '[contact]\nk_e = 1\nk_e = 2\n'
config 'a byte 0' 'bad.ini:2: a byte 0' '[contact]\n\000k_e = 1\n'
config 'missing scene' 'bad.ini:2: scene.file: .*no.scene: No such file' '[scene]\nfile = no.scene\n'

printf '[device]\ndriver = none\n' >"$folder/bad.ini"
bad 'unknown driver' 'bad.ini: device.driver: found "none"; sim, replay' "$bin/ethd-check" "$folder/bad.ini"

# ---- scenes ----
scene() { # WHAT PATTERN TEXT
  printf "$3" >"$folder/bad.scene"
  printf '[scene]\nfile = bad.scene\n' >"$folder/bad.ini"
  bad "info, $1" "$2" "$bin/ethd-scene" info "$folder/bad.scene"
  replay "replay, $1" "$2" "$folder/bad.ini" "$folder/good.csv"
}
scene_file() { # WHAT PATTERN FILE
  printf '[scene]\nfile = %s\n' "$3" >"$folder/bad.ini"
  bad "info, $1" "$2" "$bin/ethd-scene" info "$folder/$3"
  replay "replay, $1" "$2" "$folder/bad.ini" "$folder/good.csv"
}
scene_file 'missing scene' 'no.scene: No such file' no.scene
scene_file 'huge scene' 'bad.huge:1: ' bad.huge
scene_file 'binary scene' 'bad.binary:1: ' bad.binary
scene 'unknown shape' 'bad.scene:1: ellipse: .*; halfplane, .*circle.*, material are allowed' 'ellipse 0 0 1 2\n'
scene 'a shape of space' 'bad.scene:2: sphere, a shape of space: .*; halfplane, .*material are allowed' 'circle 0 0 1\nsphere 0 0 0 1\n'
scene 'an unknown material' 'bad.scene:1: material=soft: .*; a line "material soft k_e=2500" defines it' 'circle 0 0 1 material=soft\n'

# ---- traces ----
trace() { # WHAT PATTERN TEXT
  printf "$3" >"$folder/bad.csv"
  replay "$1" "$2" "$folder/good.ini" "$folder/bad.csv"
}
names=t_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps
row=,1.57,0,0.25,0.25,0,0
replay 'missing trace' 'no.csv: No such file' "$folder/good.ini" "$folder/no.csv"
replay 'empty trace' 'bad.empty: is empty' "$folder/good.ini" "$folder/bad.empty"
replay 'huge trace' 'bad.huge:1: ' "$folder/good.ini" "$folder/bad.huge"
replay 'binary trace' 'bad.binary:' "$folder/good.ini" "$folder/bad.binary"
trace 'a trace without rows' 'bad.csv' "$names\n"
trace 'an empty cell in a trace' 'bad.csv:2: q1_rad: ' "$names\n0,,0,0.25,0.25,0,0\n"
trace 'a missing column' 'bad.csv:1: ' "t_s,q1_rad\n0,1\n"
printf "$names\n1763665000.001$row\n1763665000.002$row\n" >"$folder/bad.dates" # seconds since 1970
good "$bin/ethd-replay" --in "$folder/bad.dates" --out "$folder/out.csv"
rm "$folder/out.csv"
trace 'time is beyond ns' 'bad.csv:2: t_s: ' "$names\n1e10$row\n"
trace 'time stands still' 'bad.csv:3: t_s: ' "$names\n0$row\n0$row\n"
trace 'time runs back' 'bad.csv:4: t_s: ' "$names\n0$row\n2$row\n1$row\n"

# ---- an output that is an input ----
cp "$folder/good.csv" "$folder/bad.csv"
same() { # PATTERN COMMAND...
  refuse 2 "$@"
  cmp "$folder/good.csv" "$folder/bad.csv" || fail "$*: its input was written over"
}
ln -s bad.csv "$folder/bad.link"
same 'out: .*bad.csv is the file of --in' "$bin/ethd-replay" --in "$folder/bad.csv" --out "$folder/bad.csv"
same 'out: .*bad.link is the file of --in' "$bin/ethd-replay" --in "$folder/bad.csv" --out "$folder/bad.link"
cp "$folder/good.scene" "$folder/bad.scene"
refuse 2 'out: .*bad.scene is the file of --in' "$bin/ethd-scene" convert --in "$folder/bad.scene" --out "$folder/bad.scene"
awk 'BEGIN { print "t_s,x_m,y_m"; for (i = 0; i < 120; i++) { t = i / 200; printf "%.4f,%.6f,0\n", t, 0.1 * cos(5 * t) } }' >"$folder/bad.csv"
cp "$folder/bad.csv" "$folder/bad.before"
for option in --csv --record --trace; do
  "$bin/ethd-tap" --taps 1 --speed 0.2 --finger "$folder/bad.csv" $option "$folder$([ $option != --csv ] || echo /bad.csv)" --force >"$folder/out" 2>"$folder/err"
  code=$?
  [ $option = --record ] || [ $code = 2 ] || fail "ethd-tap $option over its finger: exit $code: $(cat "$folder/err")"
  cmp "$folder/bad.csv" "$folder/bad.before" || fail "ethd-tap $option: its finger was written over"
done
rm -f "$folder"/tick.npy "$folder"/truth.npy "$folder"/taps.csv "$folder"/config.ini "$folder"/scene.scene "$folder"/events.csv
rm -f "$folder/bad.csv" "$folder/bad.link" "$folder/bad.before"

# ---- movements ----
finger() { # WHAT PATTERN TEXT
  printf "$3" >"$folder/bad.csv"
  bad "$1" "$2" "$bin/ethd-tap" --taps 1 --finger "$folder/bad.csv" --csv "$folder/out.csv"
}
bad 'missing movement' 'no.csv: No such file' "$bin/ethd-tap" --taps 1 --finger "$folder/no.csv" --csv "$folder/out.csv"
bad 'huge movement' 'bad.huge:1: ' "$bin/ethd-tap" --taps 1 --finger "$folder/bad.huge" --csv "$folder/out.csv"
finger 'a movement of one sample' 'bad.csv' 't_s,x_m,y_m\n0,0,0\n'
finger 'a movement without y' 'bad.csv:1: ' 't_s,x_m\n0,0\n1,1\n'
finger 'NaN in a movement' 'bad.csv:3: x_m: ' 't_s,x_m,y_m\n0,0,0\n0.01,nan,0\n0.02,0,0\n'
finger 'time runs back in a movement' 'bad.csv:3: t_s: ' 't_s,x_m,y_m\n0,0,0\n-0.01,0,0\n0.02,0,0\n'

# ---- plugins ----
cat >"$folder/bad.c" <<'END'
#include "ethd/plugin.h"
static ethd_status step(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)p, (void)state, (void)speed, (void)entering;
  *force = gap < 0 ? 1e3 * gap : 0;
  return ETHD_OK;
}
static const ethd_contact_law law = {
    .law = {sizeof law, ETHD_ABI, ETHD_CONTACT, 0, ID, "a spring of its own", NULL, 0, NULL, NULL}, .step = step};
static const ethd_law *const laws[] = {&law.law};
ETHD_API const ethd_plugin_entry ethd_plugin = {sizeof ethd_plugin, ETHD_ABI, "mine", "1.0", laws, 1};
END
compile() { ${CC:-cc} -Iinclude -fPIC -shared "-DID=\"$1\"" -o "$folder/$2" "$folder/bad.c"; }
plugin() { # WHAT PATTERN FILE
  printf '[plugins]\nfile = %s\n' "$3" >"$folder/bad.ini"
  bad "check, $1" "bad.ini:2: plugins.file: $2" "$bin/ethd-check" "$folder/bad.ini"
  bad "laws, $1" "plugins.file: $2" "$bin/ethd-check" --laws --plugin "$folder/$3" --csv "$folder/out.csv"
}
compile own good.so || fail 'the example plugin does not compile'
printf '[plugins]\nfile = good.so\n[contact]\nlaw = own\n' >"$folder/bad.ini"
good "$bin/ethd-check" "$folder/bad.ini"
good "$bin/ethd-check" --laws --plugin "$folder/good.so"
plugin 'missing plugin' '.*No such file' no.so
plugin 'empty plugin' '.*is empty' bad.empty
plugin 'huge plugin' '.*isn.t a shared object' bad.huge
plugin 'text as plugin' '.*isn.t a shared object\|.*is cut short' good.csv
plugin 'a program as plugin' '.*' bad.binary
size=$(wc -c <"$folder/good.so")
for share in 1 5 10 25 50 75 90 99; do
  head -c $((size * share / 100)) "$folder/good.so" >"$folder/bad.so"
  plugin "a plugin cut to $share %" '.*' bad.so
done
compile spring bad.so
plugin 'a law of a built-in name' 'the law spring of mine is there already' bad.so
printf '[plugins]\nfile = good.so\nfile = good.so\n' >"$folder/bad.ini"
bad 'a plugin twice' 'bad.ini:3: plugins.file: the law own of mine is there already' "$bin/ethd-check" "$folder/bad.ini"

# ---- a stack of 64 kB: it is widened where that is allowed (root), else one line says so ----
for command in 'ethd-tap --taps 1' 'ethd-run --virtual --duration 0.2' "ethd-check $folder/good.ini" 'ethd-check --laws'; do
  for as in "" "setpriv --bounding-set -sys_resource --inh-caps -sys_resource"; do
    [ -z "$as" ] || $as true 2>/dev/null || continue
    (ulimit -s 64 && exec $as "$bin"/$command) >"$folder/out" 2>"$folder/err" </dev/null
    code=$?
    [ $code = 0 ] || { [ $code = 1 ] && grep -q ': the stack may have 64 kB, 1024 are needed: ulimit -s 1024$' "$folder/err" && [ "$(wc -l <"$folder/err")" = 1 ]; } ||
      fail "a stack of 64 kB: $command: exit $code: $(cat "$folder/err")"
    [ -z "$as" ] || [ $code = 1 ] || fail "a stack of 64 kB, which can't be widened: $command: exit $code"
  done
done

[ $failed = 0 ]
