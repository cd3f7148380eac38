#!/bin/sh
# How long the study's screen takes for a frame, with the mouse led through taps: one line. Needs Xvfb and xdotool.
#   BUILD=build sh tests/stress/frames.sh [1280x720 [TAPS]]
set -eu
export LC_ALL=C # awk's numbers have a point
BUILD=${BUILD:-build} size=${1:-1280x720} taps=${2:-30}
[ -z "${SAN:-}" ] || { echo "SKIP frames: the window's libraries aren't made for sanitizers"; exit 0; }
for program in Xvfb xdotool; do command -v $program >/dev/null || { echo "SKIP frames: no $program"; exit 0; }; done
folder=$(mktemp -d)
server= driver= study=
trap 'for p in $driver $study $server; do kill $p 2>/dev/null || :; done; rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM

# await FILE WORDS: a line in it, for 10 s
await() {
  for _ in $(seq 200); do
    grep -q . "$1" && return
    sleep 0.05
  done
  echo "FAILED frames: $2"
  cat "$folder"/said
  exit 1
}

: >"$folder/display"
Xvfb -displayfd 3 -screen 0 "${size}x24" 3>"$folder/display" >"$folder/server" 2>&1 &
server=$!
await "$folder/display" "Xvfb doesn't start"
DISPLAY=:$(cat "$folder/display")
export DISPLAY

cat >"$folder/short.study" <<END
[study]
participants = 1
strategies = smooth
speeds = low
training = 0
taps = $taps
attempts = $taps
survey = off
record = none
END
: >"$folder/said"
"$BUILD/bin/ethd-study" "$folder/short.study" --out "$folder/session" --screen="$size" >"$folder/said" 2>&1 &
study=$!
await "$folder/said" "the study doesn't start"

# Its first line says where the start and the wall are. A tap goes to the start, moves about there for a second, goes to the
# wall as hands do, and back. Space ends a page, and does nothing elsewhere.
awk -v taps="$taps" '
  function move(x, y) { printf "mousemove %d %d\nsleep 0.008\n", x0 + scale * x, y0 - scale * y }
  NR == 1 {
    gsub(/[^-+.e0-9]/, " ")
    for (i = 1; i <= NF; i++) if ($i ~ /^[-+]?[0-9.]+(e[-+]?[0-9]+)?$/) value[++n] = $i
    x0 = value[3]; scale = value[4]; y0 = value[5]; start = value[7]; middle = value[8]; wall = value[9]
    for (tap = 0; tap < taps + 5; tap++) {
      print "key space"
      for (i = 0; i < 150; i++) move(start + (i % 16 < 8) / scale, middle)
      for (i = 0; i <= 80; i++) { u = i / 80; move(start + (wall - 0.004 - start) * u * u * u * (10 - 15 * u + 6 * u * u), middle) }
      for (i = 40; i >= 0; i--) move(start + (wall - 0.004 - start) * i / 40, middle)
    }
  }' "$folder/said" >"$folder/hand"
xdotool - <"$folder/hand" >"$folder/driver" 2>&1 &
driver=$!

code=0
wait $study || code=$?
study=
line=$(sed -n "s/^frames  */frames $size /p" "$folder/said")
[ $code = 0 ] && [ -n "$line" ] || { echo "FAILED frames: exit $code"; cat "$folder/said"; exit 1; }
echo "$line"
