#!/bin/sh
# apps/examples, compiled against the installed tree and run: a wall, an effector in space, a cap on a finger, a law in ethd-tap, a driver that ethd_conform asks, and
# teleoperation over a line that delays, loses and reorders, that carries nonsense and surfaces that jump, and that dies.
. tests/begin.sh
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$folder"
}
trap finish EXIT
prefix=$folder/usr
$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$prefix" install-files >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig" LD_LIBRARY_PATH="$prefix/lib"
export ETHD_DATA_DIR="$($PKG_CONFIG --variable=datadir ethd-drivers)"
strict="-std=gnu11 -O2 -Wall -Wextra -Werror ${SAN:+-fsanitize=$SAN}"
for source in apps/examples/*.[ch]; do
  case $source in *_arm.c) most=200 ;; *) most=150 ;; esac
  [ "$(wc -l <"$source")" -lt $most ] || fail "$source has $(wc -l <"$source") lines: fewer than $most are read"
done
compiled() { # NAME MODULE FLAGS...: as the first lines of its source say
  name=$1 module=$2
  shift 2
  $CC $strict "apps/examples/$name.c" -o "$folder/$name" "$@" $($PKG_CONFIG --cflags --libs "$module") >"$folder/cc" 2>&1 ||
    { fail "$name: $(cat "$folder/cc")"; return 1; }
}

# ---- wall: the braking and the wall of README ----
compiled wall ethd && "$folder/wall" >"$folder/wall.out" || fail "wall: exit $?"
awk '{ gsub(/[^-+.e0-9 ]/, ""); rows++; least = $1 < least ? $1 : least; most = $3 > most ? $3 : most }
  END { exit !(rows == 80 && least < -0.001) }' "$folder/wall.out" || fail "wall: $(tail -n 3 "$folder/wall.out")"

# ---- space: within the stopping distance it slows down, and at the end it stands in the wall ----
compiled space ethd && "$folder/space" >"$folder/space.out" || fail "space: exit $?"
awk '{ rows++; if ($1 == "nan") next; d = $1; v = $6; state = $9; if (d < -1e-6 || (d > 0 && v * 0.001 + v * v / 16 > d + 1e-3)) bad = 1 }
  END { exit !(rows == 50 && !bad && d < 1e-4 && v < 1e-3 && state == 2) }' "$folder/space.out" || fail "space: $(tail -n 3 "$folder/space.out")"

# ---- cap: it stands in the wall when the finger comes to its inside, and stops when the finger leaves ----
compiled cap ethd -lm && "$folder/cap" >"$folder/cap.out" || fail "cap: exit $?"
awk '{ rows++; out = /beyond its rim/; if (out) left++; else if (left || $4 < -1e-4 || ($10 < 1e-4 && $4 > 1e-4)) bad = 1; else if ($10 < 1e-4 && /state 2/) met++ }
  END { exit !(rows == 30 && !bad && met > 5 && left && out) }' "$folder/cap.out" || fail "cap: $(cat "$folder/cap.out")"

# ---- law: tapped beside ours, since its configuration names it; swapped in by name, its taps differ ----
compiled law ethd -shared -fPIC && cp "$folder/law" "$folder/mine.so"
cp apps/config/wall.scene "$folder"
{ sed '/^\[transition\]/,/^$/d' apps/config/n.ini; printf '\n[plugins]\nfile = mine.so\n[transition]\nlaw = mine\n'; } >"$folder/mine.ini"
[ -n "${SAN:-}" ] || "$prefix/bin/ethd-tap" --config "$folder/mine.ini" --transition mine,abrupt --taps 4 --speed low --csv "$folder/mine.csv" >"$folder/out" 2>&1 ||
  fail "the law: $(cat "$folder/out")"
[ -n "${SAN:-}" ] || "$prefix/bin/ethd-tap" --config "$folder/mine.ini" --validity finger --taps 1 --speed low | grep -c '^[a-z]* *low  ' | grep -qx 5 ||
  fail "the configuration's own law isn't the fifth"
[ -n "${SAN:-}" ] || awk -F, '$2 == "mine" && $6 == "ok" { v[++n] = $9 } $2 == "abrupt" && $6 == "ok" { m++; d += $9 }
  END { for (i = 1; i <= n; i++) s += v[i]; exit !(n && m && s / n < 0.8 * d / m) }' "$folder/mine.csv" || fail "the law's taps: $(cat "$folder/mine.csv")"

# ---- driver: keeps its contract ----
compiled driver ethd-drivers && "$folder/driver" >"$folder/driver.out" || fail "driver: exit $?: $(cat "$folder/driver.out")"
[ "$(grep -c ' kept ' "$folder/driver.out")" = 10 ] || fail "driver: $(cat "$folder/driver.out")"

# the same source as a shared object; the installed programs use only its table
compiled driver ethd-drivers -shared -fPIC && cp "$folder/driver" "$folder/driver.so"
printf '[device]\ndriver = file:driver.so\n' >"$folder/driver.ini"
"$prefix/bin/ethd-conform" --config "$folder/driver.ini" --virtual --move >"$folder/driver.out" 2>&1 || fail "driver.so: exit $?: $(cat "$folder/driver.out")"
[ "$(grep -c ' kept ' "$folder/driver.out")" = 10 ] || fail "driver.so: $(cat "$folder/driver.out")"
"$prefix/bin/ethd-run" --config "$folder/driver.ini" --virtual --duration 0.5 </dev/null >"$folder/driver.out" 2>&1 || fail "driver.so: exit $?: $(cat "$folder/driver.out")"
grep -q '^faults  *none' "$folder/driver.out" && grep -q '^ticks  *[1-9]' "$folder/driver.out" || fail "driver.so: $(cat "$folder/driver.out")"

# a key that it doesn't have is refused; a damaged answer is counted and goes no further; the last word is no torque
printf 'colour = red\n' >>"$folder/driver.ini"
"$prefix/bin/ethd-run" --config "$folder/driver.ini" --virtual --duration 0.1 >"$folder/out" 2>&1 </dev/null
[ $? = 2 ] && grep -q 'driver.ini:3: device.colour: mine has no settings' "$folder/out" || fail "driver.so, a key: $(cat "$folder/out")"
cat >"$folder/inside.c" <<'END'
#include <ethd/cell.h>
#include <pthread.h>
#include <time.h>
static ethd_cell *one_writer; /* each put takes a while, so that a second one overlaps it */
static _Atomic int putting, met;
static void slow_put(ethd_cell *cell, const void *value) {
  if (cell == one_writer && putting++) met = 1;
  if (cell == one_writer) nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
  ethd_cell_put(cell, value);
  if (cell == one_writer) putting--;
}
#define ethd_cell_put slow_put
#define main program
#include "driver.c"
#undef main
#define EXPECT(what) if (!(what)) return puts(#what), 1
static const ethd_driver *const d = &ethd_driver_plugin;
static _Atomic int asked, served, end;
static void *serve(void *device) {
  for (int64_t now = 1; !end; d->service(device, 0, now++)) continue;
  return NULL;
}
static void *serve_when_asked(void *device) {
  for (int mine = 0; !end;)
    if (asked != mine) d->service(device, 0, ++mine), served = mine;
  return NULL;
}
static int restarts(bus *b) { /* an enabling starts the device anew while its I/O goes on */
  pthread_t io;
  one_writer = b->answers;
  if (pthread_create(&io, NULL, serve, b)) return 0;
  for (int i = 0; i < 300; i++) d->start(b);
  end = 1;
  pthread_join(io, NULL);
  one_writer = NULL, end = 0;
  return !met;
}
static int damages(bus *b) { /* each damaged answer is told of, also if it comes while one reads */
  pthread_t io;
  const double q = b->q[0];
  int told = 1;
  b->q[0] = NAN;
  if (pthread_create(&io, NULL, serve_when_asked, b)) return 0;
  for (clock_t begin = clock(); told && clock() - begin < CLOCKS_PER_SEC;) {
    ethd_sense s = {0};
    for (int mine = ++asked; served != mine;) (void)!d->read(b, 0, &s);
    (void)!d->read(b, 0, &s);
    told = s.faults != 0;
  }
  end = 1;
  pthread_join(io, NULL);
  b->q[0] = q;
  return told;
}
int main(void) {
  ethd_setup setup = ethd_setup_default();
  const ethd_device_def def = {.setup = &setup, .folder = ".", .is_virtual = 1};
  const ethd_command pull = {.torque = {0.5, -0.5}};
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_sense s = {0};
  void *device;
  if (d->open(&def, &device, message) || d->start(device)) return puts("open, start"), 1;
  bus *b = device;
  EXPECT(d->write(b, 1000000, &pull) == ETHD_OK && d->service(b, 0, 1000000) == ETHD_OK && d->read(b, 1000000, &s) == ETHD_OK);
  EXPECT(b->taken.torque[0] == 0.5 && !s.faults && s.time_ns == 1000000);
  const double q = s.q[0], bad[] = {NAN, INFINITY, -1e9};
  for (int i = 0; i < 3; i++) {
    s = (ethd_sense){0};
    b->q[0] = bad[i];
    EXPECT(d->service(b, 0, 2000000) < 0 && d->read(b, 2000000, &s) == ETHD_STATUS_STALE);
    EXPECT(s.q[0] == q && s.time_ns == 1000000 && s.faults == ETHD_FAULT_BIT(ETHD_FAULT_REPLY_BAD));
  }
  b->q[0] = q;
  s = (ethd_sense){0};
  EXPECT(d->service(b, 0, 3000000) == ETHD_OK && d->read(b, 3000000, &s) == ETHD_OK && !s.faults && s.time_ns == 3000000);
  EXPECT(d->write(b, 4000000, &pull) == ETHD_OK && d->service(b, 0, 4000000) == ETHD_OK && b->taken.torque[0] == 0.5);
  EXPECT(d->service(b, 0, 5000000) == ETHD_OK && b->w[0] > 0 && d->start(b) == ETHD_OK && d->service(b, 0, 6000000) == ETHD_OK);
  EXPECT(b->taken.torque[0] == 0 && b->w[0] == 0);
  EXPECT(restarts(b));
  EXPECT(damages(b));
  EXPECT(d->stop && d->stop(b) == ETHD_OK && b->taken.torque[0] == 0 && b->taken.torque[1] == 0);
  d->close(b);
  return 0;
}
END
$CC $strict -Iapps/examples "$folder/inside.c" -o "$folder/inside" $($PKG_CONFIG --cflags --libs ethd-drivers) >"$folder/out" 2>&1 &&
  "$folder/inside" >"$folder/out" 2>&1 || fail "driver, from inside: $(cat "$folder/out")"

# ---- teleop: the line works; it dies; it carries nonsense, and a surface that jumps ----
compiled teleop ethd-drivers && compiled robot ethd || exit 1
for words in 'teleop' 'teleop 4777' 'teleop 4777 x' 'teleop 70000 1' 'robot 4777 1 20 101' 'robot 4777 1 201 0' 'robot 0 1 20 10'; do
  "$folder/"$words >"$folder/out" 2>&1 </dev/null
  [ $? = 2 ] && grep -q 'PORT SECONDS.* are needed' "$folder/out" || fail "$words: $(cat "$folder/out")"
done
env -u ETHD_DATA_DIR "$folder/teleop" $((20000 + $$ % 12000)) 1 >"$folder/out" 2>&1 </dev/null
[ $? = 1 ] && grep -q 'q.plant: No such file or directory; ETHD_DATA_DIR may name' "$folder/out" || fail "no plants: $(cat "$folder/out")"
# swaps far beyond what the controller's queue of events holds, each taken at the worst moment, between poll and post: a scene
# that it still has is never posted; Ctrl-C while nobody speaks is no failure of the robot
cat >"$folder/swaps.c" <<'END'
#include <ethd/ethd.h>
static const ethd_scene *has[3]; /* handed over, and not back yet as far as the program can know */
static int twice;
static ethd_status poll(ethd_control *control, ethd_event *event) {
  ethd_status status = ethd_control_poll(control, event);
  for (int i = 0; i < 3 && !status && event->scene; i++)
    if (has[i] == event->scene) has[i] = NULL;
  return status;
}
static void step(ethd_control *control) { /* takes what was posted */
  const ethd_sense sense = {.have = ETHD_HAVE_DQ, .q = {1.5, 0.1}};
  ethd_command command;
  (void)!ethd_control_step(control, &sense, &command, NULL);
}
static ethd_status post(ethd_control *control, const ethd_setup *setup, ethd_error *error) {
  static const ethd_scene *last;
  step(control);
  ethd_status status = ethd_control_post(control, setup, error);
  if (status || setup->bodies[0] == last) return status;
  last = setup->bodies[0];
  for (int i = 0; i < 3; i++) twice += has[i] == last;
  for (int i = 0; i < 3; i++)
    if (!has[i]) return has[i] = last, status;
  return twice++, status;
}
#define ethd_control_poll poll
#define ethd_control_post post
#define main program
#include "teleop.c"
#undef main
int main(void) {
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ethd_error error;
  strategy s = {.law = -1};
  ear e = {0};
  if (ethd_control_create(&setup, &control, &error)) return puts("control"), 1;
  for (int i = 0; i < 2; i++)
    if (ethd_scene_parse(shapes[i], strlen(shapes[i]), &s.scenes[i], &error)) return puts("shape"), 1;
  for (int i = 0; i < 1000; i++) {
    swap(control, &setup, &s, i / 2 % 2, i % 2);
    if (i % 5 == 4) step(control);
  }
  over = SIGINT;
  printf("%d swaps, %d of a scene that the controller has; %d\n", s.swaps, twice, meet(-1, &e));
  ethd_control_destroy(control);
  for (int i = 0; i < 2; i++) ethd_scene_destroy(s.scenes[i]);
  return !(s.swaps > 300 && !twice);
}
END
$CC $strict -Iapps/examples "$folder/swaps.c" -o "$folder/swaps" $($PKG_CONFIG --cflags --libs ethd-drivers) >"$folder/out" 2>&1 &&
  "$folder/swaps" >"$folder/out" 2>&1 && [ "$(wc -l <"$folder/out")" = 1 ] && grep -q '; 1$' "$folder/out" || fail "teleop's swaps: $(cat "$folder/out")"
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a loop in true time"; exit $((failed ? 1 : 77)); }
port=$((20000 + $$ % 12000)) # below those that a system hands out
alone=
chrt -r 40 true 2>/dev/null && alone="chrt -r 40"
python=${PYTHON:-python3}
in_back() { # NAME COMMAND...
  out=$folder/$1
  shift
  $alone "$@" >"$out" 2>&1 &
  child=$!
  children="$children $child"
}
ended() { # NAME PROCESS: its exit code
  wait "$2"
  echo $? >"$folder/$1.code"
}
teleop() { # NAME ORDER RING_SECONDS ROBOT_SECONDS: 20 ms on the way, every tenth datagram lost
  port=$((port + 1))
  for side in $2; do
    case $side in
      ring) in_back "$1.ring" "$folder/teleop" $port "$3"; ring=$child ;;
      robot) in_back "$1.robot" "$folder/robot" $port "$4" 20 10; robot=$child ;;
    esac
  done
  ended "$1.ring" $ring
  ended "$1.robot" $robot
}
beside() { # NAME PROGRAM ARGUMENTS SIDE ARGUMENTS: one of ours and a peer that sends nonsense, too
  port=$((port + 1))
  name=$1
  shift
  in_back "$name" "$folder/$1" $port $2
  shift 2
  one=$child
  in_back "$name.peer" "$python" tests/peers/teleop_peer.py "$1" $port $2
  ended "$name.peer" $child
  ended "$name" $one
}
# "N ms in contact, N swaps, pushed at V m/s at most; datagrams dropped: N overtaken, N of nonsense; at X mm with T Nm: sentence"
figures() {
  sed -n 's/^ring: \([0-9]*\) ms in contact, \([0-9]*\) swaps, pushed at \([0-9.]*\) .* dropped: \([0-9]*\) overtaken, \([0-9]*\) of nonsense; at \([-0-9.]*\) mm with \([-0-9.e]*\) Nm: .*/\1 \2 \3 \4 \5 \6 \7/p' "$folder/$1"
}
code() { cat "$folder/$1.code"; }
all() {
  teleop works 'ring robot' 4 5
  teleop dies 'robot ring' 6 2
  beside jumps teleop 4 robot '3.5 -0.02'
  beside robot_alone robot '6 20 10' ring 2
  for name in works.ring works.robot dies.ring dies.robot jumps jumps.peer robot_alone robot_alone.peer; do
    echo "$name, exit $(code $name): $(cat "$folder/$name")"
  done
  wrong=$(judge)
}
judge() {
  [ "$(code works.ring)" = 0 ] && grep -q ': no fault$' "$folder/works.ring" || echo "with a line that works: $(cat "$folder/works.ring")"
  figures works.ring | awk '!($1 > 1500 && $2 >= 3 && $4 > 10 && $5 == 0 && $6 > 240 && $6 < 252 && $7 < -0.1) { print "no contact, no swaps, or no line that overtakes" }'
  # the ring went first: the robot's gripper stays where the ring was
  [ "$(code works.robot)" = 1 ] && grep -q '^robot: the gripper at 24[0-9.]* mm, where it stays: no orders come' "$folder/works.robot" || echo "the robot: $(cat "$folder/works.robot")"
  [ "$(code dies.ring)" = 1 ] && grep -q ': the application has ended' "$folder/dies.ring" || echo "with a line that dies: $(cat "$folder/dies.ring")"
  figures dies.ring | awk '!($1 > 300 && $7 == 0) { print "it died before a contact, or torque is left" }'
  [ "$(code dies.robot)" = 0 ] || echo "the robot, that ends first: $(cat "$folder/dies.robot")"
  # 0.46 m/s without a bound on the wall's speed, which is 0.1 m/s
  [ "$(code jumps)" = 0 ] && grep -q ': no fault$' "$folder/jumps" || echo "with a surface that jumps: $(cat "$folder/jumps")"
  figures jumps | awk '!($1 > 1500 && $3 < 0.25) { print "the ring is thrown, or there was no contact" }'
  # nonsense goes no further and is counted; a side that stood still for LINK_DEAD, or for so long that the system dropped
  # datagrams, ends elsewhere or counts fewer
  figures jumps | awk -v sent="$(cat "$folder/jumps.peer")" '{ rows++; good = sent > 300 && $5 == sent && $4 > 10 } END { exit !(rows == 1 && good) }' ||
    echo "the ring hears $(cat "$folder/jumps.peer") datagrams of nonsense: $(cat "$folder/jumps")"
  grep -q "^robot: the gripper at 240.0 mm.*, $(cat "$folder/robot_alone.peer") datagrams of nonsense" "$folder/robot_alone" ||
    echo "the robot hears $(cat "$folder/robot_alone.peer") datagrams of nonsense: $(cat "$folder/robot_alone")"
}
all
[ -z "$wrong" ] || all
skip=
if [ -n "$wrong" ]; then
  skip=$($alone "$python" tests/peers/late.py 'a loop')
  [ $? = 77 ] || fail "$wrong ($skip)"
fi
# without the other side, each says so in time and nothing moves
"$folder/robot" $((port + 1)) 1 20 10 >"$folder/out" 2>&1 &
robot=$!
"$folder/teleop" $((port + 2)) 1 >"$folder/alone" 2>&1 </dev/null
[ $? = 1 ] && grep -qx "robot: no packets from it: start it with the same port" "$folder/alone" || fail "the ring alone: $(cat "$folder/alone")"
wait $robot
[ $? = 1 ] && grep -q 'no orders came' "$folder/out" || fail "the robot alone: $(cat "$folder/out")"
[ $failed = 0 ] || exit 1
[ -z "$skip" ] || { echo "$skip"; exit 77; }
