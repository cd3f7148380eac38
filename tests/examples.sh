#!/bin/sh
# apps/examples, compiled against the installed tree and run: a wall, a law in ethd-tap, a driver that ethd_conform asks, and
# teleoperation over a line that delays, loses and reorders, and that dies.
set -u
work=$(mktemp -d)
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$work"
}
trap finish EXIT
failed=0
fail() { echo "FAILED $*"; failed=1; }
prefix=$work/usr
$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$prefix" install-files >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig" LD_LIBRARY_PATH="$prefix/lib"
export ETHD_DATA_DIR="$($PKG_CONFIG --variable=datadir ethd-drivers)"
strict="-std=gnu11 -O2 -Wall -Wextra -Werror ${SAN:+-fsanitize=$SAN}"
for source in apps/examples/*.c; do
  [ "$(wc -l <"$source")" -lt 150 ] || fail "$source has $(wc -l <"$source") lines: fewer than 150 are read"
done
compiled() { # NAME MODULE FLAGS...: as the first lines of its source say
  name=$1 module=$2
  shift 2
  $CC $strict "apps/examples/$name.c" -o "$work/$name" "$@" $($PKG_CONFIG --cflags --libs "$module") >"$work/cc" 2>&1 ||
    { fail "$name: $(cat "$work/cc")"; return 1; }
}

# ---- wall: the braking and the wall of README ----
compiled wall ethd && "$work/wall" >"$work/wall.out" || fail "wall: exit $?"
awk '{ gsub(/[^-+.e0-9 ]/, ""); rows++; least = $1 < least ? $1 : least; most = $3 > most ? $3 : most }
  END { exit !(rows == 80 && least < -0.001) }' "$work/wall.out" || fail "wall: $(tail -n 3 "$work/wall.out")"

# ---- law: tapped beside ours, since its configuration names it; swapped in by name, its taps differ ----
compiled law ethd -shared -fPIC && cp "$work/law" "$work/mine.so"
cp apps/config/wall.scene "$work"
{ sed '/^\[transition\]/,/^$/d' apps/config/n.ini; printf '\n[plugins]\nfile = mine.so\n[transition]\nlaw = mine\n'; } >"$work/mine.ini"
[ -n "${SAN:-}" ] || "$prefix/bin/ethd-tap" --config "$work/mine.ini" --transition mine,abrupt --taps 4 --speed low --csv "$work/mine.csv" >"$work/out" 2>&1 ||
  fail "the law: $(cat "$work/out")"
[ -n "${SAN:-}" ] || "$prefix/bin/ethd-tap" --config "$work/mine.ini" --taps 1 --speed low | grep -c '^[a-z]* *low  ' | grep -qx 5 ||
  fail "the configuration's own law isn't the fifth"
[ -n "${SAN:-}" ] || awk -F, '$2 == "mine" && $6 == "ok" { v[++n] = $9 } $2 == "abrupt" && $6 == "ok" { m++; d += $9 }
  END { for (i = 1; i <= n; i++) s += v[i]; exit !(n && m && s / n < 0.8 * d / m) }' "$work/mine.csv" || fail "the law's taps: $(cat "$work/mine.csv")"

# ---- driver: keeps its contract ----
compiled driver ethd-drivers && "$work/driver" >"$work/driver.out" || fail "driver: exit $?: $(cat "$work/driver.out")"
[ "$(grep -c ' kept ' "$work/driver.out")" = 10 ] || fail "driver: $(cat "$work/driver.out")"

# the same source as a shared object, of which only the table is used: the installed programs drive it
compiled driver ethd-drivers -shared -fPIC && cp "$work/driver" "$work/driver.so"
printf '[device]\ndriver = file:driver.so\n' >"$work/driver.ini"
"$prefix/bin/ethd-conform" --config "$work/driver.ini" --virtual --move >"$work/driver.out" 2>&1 || fail "driver.so: exit $?: $(cat "$work/driver.out")"
[ "$(grep -c ' kept ' "$work/driver.out")" = 10 ] || fail "driver.so: $(cat "$work/driver.out")"
"$prefix/bin/ethd-run" --config "$work/driver.ini" --virtual --duration 0.5 </dev/null >"$work/driver.out" 2>&1 || fail "driver.so: exit $?: $(cat "$work/driver.out")"
grep -q '^faults  *none' "$work/driver.out" && grep -q '^ticks  *[1-9]' "$work/driver.out" || fail "driver.so: $(cat "$work/driver.out")"

# ---- teleop: the line works; then it dies ----
compiled teleop ethd-drivers || exit 1
port=$((20000 + $$ % 20000))
alone=
chrt -r 40 true 2>/dev/null && alone="chrt -r 40"
teleop() { # NAME RING_SECONDS ROBOT_SECONDS: 20 ms on the way, every tenth datagram lost
  port=$((port + 1))
  $alone "$work/teleop" ring $port "$2" >"$work/$1.ring" 2>&1 &
  ring=$!
  children="$children $ring"
  sleep 0.5
  $alone "$work/teleop" robot $port "$3" 20 10 >"$work/$1.robot" 2>&1
  wait $ring
  echo $? >"$work/$1.code"
}
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a loop in true time"; exit $((failed ? 1 : 77)); }
# "N ms in contact, N swaps, N datagrams overtaken, at X mm with T Nm: sentence"
figures() { sed -n 's/^ring: \([0-9]*\) ms in contact, \([0-9]*\) swaps, \([0-9]*\) datagrams overtaken, at \([-0-9.]*\) mm with \([-0-9.e]*\) Nm: .*/\1 \2 \3 \4 \5/p' "$1"; }
both() {
  teleop works 4 5
  teleop dies 6 2
  cat "$work"/works.* "$work"/dies.*
  wrong=$(judge)
}
judge() {
  [ "$(cat "$work/works.code")" = 0 ] && grep -q ': no fault$' "$work/works.ring" || echo "with a line that works: $(cat "$work/works.ring")"
  figures "$work/works.ring" | awk '!($1 > 1500 && $2 >= 3 && $3 > 10 && $4 > 240 && $4 < 252 && $5 < -0.1) { print "no contact, no swaps, or no line that overtakes" }'
  [ "$(cat "$work/dies.code")" = 1 ] && grep -q ': the application is gone' "$work/dies.ring" || echo "with a line that dies: $(cat "$work/dies.ring")"
  figures "$work/dies.ring" | awk '!($1 > 300 && $5 == 0) { print "it died before a contact, or torque is left" }'
  grep -q '^robot: .* gripper at 24' "$work/works.robot" || grep -q 'no orders' "$work/works.robot" || echo "the robot: $(cat "$work/works.robot")"
}
both
[ -z "$wrong" ] || both
skip=
if [ -n "$wrong" ]; then
  skip=$($alone "${PYTHON:-python3}" tests/peers/late.py 'a loop')
  [ $? = 77 ] || fail "$wrong ($skip)"
fi
[ $failed = 0 ] || exit 1
[ -z "$skip" ] || { echo "$skip"; exit 77; }
