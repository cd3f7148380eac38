#!/bin/sh
# All programs use the same step: each calls a law that counts its calls once a tick, and the law answers as pd does.
set -eu
. tests/begin.sh
fail() { echo "$*"; exit 1; }
COUNTING_FILE=$folder/steps
export COUNTING_FILE

# counted TICKS WHO: one process stepped so often
counted() {
  [ "$(cat "$COUNTING_FILE")" = "$1" ] || fail "$2: $(tr '\n' ' ' <"$COUNTING_FILE")steps, not $1"
  rm "$COUNTING_FILE"
}

echo 'halfplane -1 0 -0.238' >"$folder/wall.scene"
scene='[scene]\nfile = wall.scene\n'
printf "$scene[plugins]\nfile = $BUILD/tests/plugins/counting.so\n[tracking]\nlaw = counting-pd\n" >"$folder/counting.ini"
printf "$scene" >"$folder/pd.ini"
awk 'BEGIN {
  print "t_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps"
  for (i = 0; i < 250; i++) {
    t = i / 1000; x = 0.256 - 0.012 * sin(12 * t)
    printf "%.3f,%.9f,%.9f,%.9f,0.25,%.9f,0\n", t, 1.5707963 - (x - 0.25) / 0.25, 0.001 * sin(20 * t), x - 0.001, -0.144 * cos(12 * t)
  }
}' >"$folder/in.csv"

"$BUILD/bin/ethd-replay" --config "$folder/pd.ini" --in "$folder/in.csv" --out "$folder/pd.csv" >/dev/null
[ ! -e "$COUNTING_FILE" ] || fail "something else counts"
"$BUILD/bin/ethd-replay" --config "$folder/counting.ini" --in "$folder/in.csv" --out "$folder/counting.csv" >/dev/null
counted 250 ethd-replay
cmp "$folder/pd.csv" "$folder/counting.csv"
cut -d, -f7 "$folder/pd.csv" | grep -q 2 || fail "the movement never touches the wall"

"$BUILD/bin/ethd-tap" --config "$folder/counting.ini" --taps 2 --transition offset --record "$folder/rec" >/dev/null
ticks=$("$BUILD/bin/ethd-replay" --verify "$folder/rec" --plugins | grep -o '[0-9]* ticks' | cut -d' ' -f1)
[ "${ticks:-0}" -gt 500 ] || fail "ethd-tap: only ${ticks:-0} ticks"
[ "$(wc -l <"$COUNTING_FILE")" = 2 ] && [ "$(sort -u "$COUNTING_FILE")" = "$ticks" ] ||
  fail "ethd-tap, ethd-replay --verify: $(tr '\n' ' ' <"$COUNTING_FILE")steps, not $ticks each"
echo "250 ticks replayed, $ticks tapped and replayed again, each counted once"
