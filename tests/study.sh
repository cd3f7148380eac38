#!/bin/sh
# ethd-study: a session's data, order and replay; killed at any call, out of room, misused. No time is asserted.
# ETHD_STUDY_KILLS: how many random moments (6; make stress has 50).
. tests/begin.sh
mounted=
trap '[ -z "$mounted" ] || umount "$folder/small"; rm -rf "$folder"' EXIT
study=$BUILD/bin/ethd-study
python3=${PYTHON:-python3}
replay="$BUILD/bin/ethd-replay --verify"
kills=${ETHD_STUDY_KILLS:-6}

# ---- the paper's study: 3 x 3 x 4 ----
"$study" --out "$folder/paper" >"$folder/out" 2>&1 || fail "the paper's study: $(tail -n 1 "$folder/out")"
taps=$folder/paper/taps.csv
header=participant,block,part,attempt,transition,speed,seed,tap,valid,reason,v_rvo_mps,v_of_mps,d_max_m,v_rmin_mps,delta_s_ms,eps_m,t_rvo_s,t_of_s,t_seen_s,peak_force_n,finger_radius_m,commanded_mps,v_hand_mps,touch_depth_m,eps_felt_m,hand,movement,utc,by_ring,by_finger,checked
[ "$(head -n 1 "$taps")" = "$header" ] || fail "the header: $(head -n 1 "$taps")"
awk -F, 'NR > 1 && $3 == "test" && $9 { n[$1, $5, $6]++ } END { for (k in n) { cells++; bad += n[k] != 3 } exit cells != 12 || bad }' "$taps" ||
  fail "not three valid taps in each of 12 cells"
awk -F, 'NR > 1 && ($9 == 1) != ($10 == "ok")' "$taps" | grep . && fail "valid isn't what reason says"
order=$(awk -F, 'NR > 1 && $2 != last { printf "%s%s-%s-%s", sep, $3, $5, $6; sep = " "; last = $2 }' "$taps")
[ "$order" = "training-smooth-low test-offset-low test-smooth-low training-smooth-high test-offset-high test-smooth-high training-offset-low test-smooth-low test-offset-low training-offset-high test-smooth-high test-offset-high training-smooth-low test-offset-low test-smooth-low training-smooth-high test-offset-high test-smooth-high" ] ||
  fail "the order is $order"
awk -F, 'NR > 1 { if ($1 == id && $2 == block && $4 != attempt + 1) bad++; id = $1; block = $2; attempt = $4 } END { exit bad > 0 }' "$taps" ||
  fail "attempts don't count up"
[ "$(awk -F, 'NR > 1 && $5$6$7 == ""' "$folder/paper/survey.csv" | wc -l)" = 12 ] || fail "simulated people have answered"
hash=$(cd "$folder/paper" && cat study.ini config.ini scene.scene device.plant | sha256sum | cut -d' ' -f1)
grep -q "^hash $hash$" "$folder/paper/versions.txt" || fail "the hash isn't what versions.txt says"
[ "$(($(wc -l <"$taps") - 1))" = "$(ls "$folder/paper/taps" | wc -l)" ] || fail "not a folder per tap"
for tap in P01-02-001 P02-05-004 P03-06-002; do
  $replay "$folder/paper/taps/$tap" >"$folder/out" 2>&1 && grep -q 'equal to the bit' "$folder/out" || fail "$tap: $(cat "$folder/out")"
done
grep -rl "$(id -un)\|$(hostname)" "$folder/paper" --include=*.csv --include=*.txt --include=*.md | grep . && [ "$(id -un)" != root ] && fail "not anonymous"

# ---- a small one to kill: the same bytes as without the kills ----
cat >"$folder/small.study" <<'END'
[study]
name = small
participants = 2
taps = 1
attempts = 3
training = 1
survey = on
END
"$study" "$folder/small.study" --quiet --out "$folder/whole" >"$folder/out" 2>&1 || fail "the small study: $(cat "$folder/out")"
on() { (become "$@"); }
become() { # FOLDER: begins it or goes on
  if [ -f "$1/study.sqlite" ]; then set -- --resume "$1"; else set -- "$folder/small.study" --out "$1"; fi
  exec "$study" --quiet "$@"
}
same() { # FOLDER WHAT
  for what in taps.csv survey.csv study.ini; do cmp "$folder/whole/$what" "$1/$what" || fail "$2: $what"; done
  diff -r "$folder/whole/taps" "$1/taps" >"$folder/out" || fail "$2: $(head -n 3 "$folder/out")"
}

# Killed at random moments; each session that ends by itself is compared, and another one is begun.
at=0 whole=0
while [ $at -lt "$kills" ]; do
  become "$folder/random" >/dev/null 2>"$folder/err" &
  pid=$!
  sleep "$(awk -v seed="$at$whole$$" 'BEGIN { srand(seed); print rand() * 0.25 }')"
  kill -KILL $pid 2>/dev/null
  wait $pid 2>/dev/null
  if [ $? = 137 ]; then
    at=$((at + 1))
  else
    whole=$((whole + 1))
    same "$folder/random" "after $at random kills"
    rm -r "$folder/random"
  fi
  grep . "$folder/err" && fail "after $at kills: $(cat "$folder/err")"
done
on "$folder/random" >"$folder/out" 2>&1 || fail "after $kills random kills: $(cat "$folder/out")"
same "$folder/random" "after $kills random kills"

# At every call that changes the disk, one after another; a write is torn in the middle.
cat >"$folder/killer.c" <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>
static int due(void) {
  static long at = -1, n;
  if (at < 0) at = getenv("KILL_AT") ? atol(getenv("KILL_AT")) : 0;
  return at && ++n == at;
}
#define NEXT(name) __typeof__(&name) next = (__typeof__(&name))dlsym(RTLD_NEXT, #name); if (due())
#define TORN(name) ssize_t name(int fd, const void *b, size_t n, off_t o) { \
  NEXT(name) { (void)!next(fd, b, n / 2, o); raise(SIGKILL); } return next(fd, b, n, o); }
TORN(pwrite)
TORN(pwrite64)
ssize_t write(int fd, const void *b, size_t n) {
  NEXT(write) { (void)!next(fd, b, n / 2); raise(SIGKILL); }
  return next(fd, b, n);
}
int rename(const char *a, const char *b) { NEXT(rename) raise(SIGKILL); return next(a, b); }
int mkdir(const char *a, mode_t m);
int mkdir(const char *a, mode_t m) { NEXT(mkdir) raise(SIGKILL); return next(a, m); }
int renameat(int f, const char *a, int g, const char *b) { NEXT(renameat) raise(SIGKILL); return next(f, a, g, b); }
int fdatasync(int fd) { NEXT(fdatasync) raise(SIGKILL); return next(fd); }
int fsync(int fd) { NEXT(fsync) raise(SIGKILL); return next(fd); }
int unlink(const char *a) { NEXT(unlink) raise(SIGKILL); return next(a); }
int unlinkat(int fd, const char *a, int f) { NEXT(unlinkat) raise(SIGKILL); return next(fd, a, f); }
int ftruncate(int fd, off_t o) { NEXT(ftruncate) raise(SIGKILL); return next(fd, o); }
int ftruncate64(int fd, off_t o) { NEXT(ftruncate64) raise(SIGKILL); return next(fd, o); }
END
if [ -z "${SAN:-}" ] && ${CC:-cc} -shared -fPIC -o "$folder/killer.so" "$folder/killer.c" -ldl 2>"$folder/err"; then
  # each run dies at its k-th call: every call dies once, those of going on too
  call=0 dead=0
  while call=$((call % 97 + 1)); LD_PRELOAD=$folder/killer.so KILL_AT=$call on "$folder/call" >"$folder/out" 2>&1; [ $? = 137 ]; do
    dead=$((dead + 1))
    [ $dead -gt 2000 ] && { fail "it doesn't come to an end"; break; }
  done
  grep . "$folder/out" | grep -v 'taps*\( were missing\)*; ethd-report' && fail "killed $dead times: $(cat "$folder/out")"
  same "$folder/call" "killed $dead times at a call"
  [ $dead -gt 30 ] || fail "killed only $dead times"
fi

# ---- room: none left, more later ----
full() { # WHAT: refused in one line, nothing torn; then there is room again
  [ $code = 1 ] && [ "$(grep -c . "$folder/err")" = 1 ] && grep -q 'No space left\|File too large' "$folder/err" ||
    fail "$1: exit $code: $(cat "$folder/err")"
}
sed 's/^record = all/record = none/; s/^participants = .*/participants = 12/' "$BUILD/share/ethd/paper.study" >"$folder/short.study"
"$study" "$folder/short.study" --quiet --out "$folder/long" >"$folder/out" 2>&1 || fail "a long study: $(cat "$folder/out")"
(ulimit -f 120; "$study" "$folder/short.study" --quiet --out "$folder/quota" >/dev/null 2>"$folder/err"; exit $?)
code=$?
full "a quota"
"$study" --quiet --resume "$folder/quota" >"$folder/out" 2>&1 || fail "after a quota: $(cat "$folder/out")"
[ "$(wc -c <"$folder/long/study.sqlite")" -gt 130000 ] && cmp "$folder/long/taps.csv" "$folder/quota/taps.csv" || fail "a quota has changed the taps"
mkdir "$folder/small"
if mount -t tmpfs -o size=2m tmpfs "$folder/small" 2>"$folder/err"; then
  mounted=1
  "$study" "$folder/small.study" --quiet --out "$folder/small/s" >/dev/null 2>"$folder/err"
  code=$?
  full "a full disk"
  mount -o remount,size=64m "$folder/small" && on "$folder/small/s" >"$folder/out" 2>&1 || fail "a disk with room again: $(cat "$folder/out")"
  same "$folder/small/s" "a full disk"
else
  echo "no small file system here: $(cat "$folder/err")"
fi

# ---- two at once; damage; commands ----
mkfifo "$folder/in"
"$study" "$folder/small.study" --ask --out "$folder/at-work" <"$folder/in" >"$folder/out" 2>&1 &
pid=$!
exec 9>"$folder/in"
echo pause >&9
for _ in $(seq 200); do
  "$python3" -c 'import sqlite3, sys; sys.exit(not sqlite3.connect(f"file:{sys.argv[1]}?immutable=1", uri=True).execute("select 1 from event where event = ?", ["pause"]).fetchone())' "$folder/at-work/study.sqlite" 2>/dev/null && break
  sleep 0.05
done
for way in --resume --export; do
  "$study" $way "$folder/at-work" >"$folder/second" 2>"$folder/err"
  code=$?
  [ $code = 2 ] && [ "$(grep -c . "$folder/err")" = 1 ] && grep -q "at-work/study.sqlite: ethd-study, process $pid, is at work in it" "$folder/err" ||
    fail "two at once, $way: exit $code: $(cat "$folder/err")"
done
echo stop >&9
exec 9>&-
wait $pid
"$study" --quiet --resume "$folder/at-work" >"$folder/out" 2>&1 || fail "after two at once: $(cat "$folder/out")"
same "$folder/at-work" "two at once"
cp -r "$folder/whole" "$folder/damaged"
"$python3" - "$folder/damaged/study.sqlite" <<'END'
import sys
b = bytearray(open(sys.argv[1], "rb").read())
for page in range(4096, len(b), 4096): b[page] ^= 7 # of another kind
open(sys.argv[1], "wb").write(b)
END
kept=$folder/damaged/study.sqlite
refuse '[12]' 'study.sqlite: .*damaged\|malformed' "$study" --resume "$folder/damaged"
sed -i 's/^taps = .*/taps = 2/' "$folder/whole/study.ini"
refuse '[12]' 'begun with other files' "$study" --resume "$folder/whole"
printf 'note finger, cold\nbogus\npause\nnote in it\ngo\nabort\n' |
  "$study" "$folder/small.study" --ask --out "$folder/asked" >"$folder/out" 2>&1 || fail "commands: exit $?: $(cat "$folder/out")"
grep -q 'note WORDS, accept WORDS, reject WORDS, pause' "$folder/out" || fail "an unknown command"
[ "$(cut -d, -f5- "$folder/asked/events.csv" | tr '\n' ' ')" = 'event,detail open,libethd 0.1.0 note,"finger, cold" pause, note,in it abort, over, ' ] ||
  fail "events: $(cat "$folder/asked/events.csv")"
grep -q '^P01' "$folder/asked/taps.csv" && fail "P01 went on after abort"
grep -q '^P02' "$folder/asked/taps.csv" || fail "P02 wasn't asked"
"$study" "$folder/small.study" --quiet --participant 2 --out "$folder/parts" >/dev/null && "$study" --quiet --participant 1 --resume "$folder/parts" >/dev/null ||
  fail "participants apart"
sort "$folder/whole/taps.csv" >"$folder/a"; sort "$folder/parts/taps.csv" | cmp - "$folder/a" || fail "participants apart have other taps"

# ---- recorded fingers ----
awk 'BEGIN { print "t_s,x_m,y_m"; for (i = 0; i < 120; i++) { t = i / 200; printf "%.4f,%.6f,0\n", t, 0.1 * cos(5 * t) } }' >"$folder/swing.csv"
printf '[study]\nspeeds = 0.2\nparticipants = 1\nattempts = 4\nstrategies = offset\n' >"$folder/swing.study"
"$study" "$folder/swing.study" --finger "$folder/swing.csv" --out "$folder/swing" >"$folder/out" 2>&1 || fail "a recorded finger: $(cat "$folder/out")"
$replay "$folder/swing/taps/P01-02-001" >/dev/null || fail "a recorded finger's tap doesn't replay"
rm "$folder/swing.csv"
"$study" --resume "$folder/swing" >/dev/null || fail "a session needs a movement that isn't in it"

# ---- refusals ----
bad() { # PATTERN TEXT [ARGUMENTS]
  pattern=$1
  printf "$2" >"$folder/bad.study"
  shift 2
  refuse 2 "$pattern" "$study" "$folder/bad.study" --out "$folder/bad" "$@"
}
kept=$folder/bad
bad 'bad.study:2: study.tap: no key of this section; name, seed,' '[study]\ntap = 3\n'
bad 'bad.study:1: "walls": unknown section; study,' '[walls]\n'
bad 'bad.study:2: study.taps: found "0", a whole number from 1 to ' '[study]\ntaps = 0\n'
bad 'bad.study:2: study.taps: found "3.5"' '[study]\ntaps = 3.5\n'
bad 'bad.study:3: study.taps: occurs twice' '[study]\ntaps = 3\ntaps = 3\n'
bad 'bad.study:2: study.attempts: 2 attempts ' '[study]\nattempts = 2\n'
bad 'bad.study:2: study.order: found "any", paper|random|latin' '[study]\norder = any\n'
bad 'bad.study:2: study.strategies: smooth stands there twice' '[study]\nstrategies = smooth,smooth\n'
bad 'bad.study:2: study.strategies: .*found "rough"' '[study]\nstrategies = rough\n'
bad 'bad.study:2: study.speeds: found "9"; low, high' '[study]\nspeeds = low,9\n'
bad 'bad.study:2: validity.graze: found "nan"' '[validity]\ngraze = nan\n'
bad 'bad.study:2: hand.motion: stands there without' '[hand]\nmotion = x\n'
bad 'hand.source: recorded needs' '[hand]\nsource = recorded\n'
bad 'no_such_folder: no folder' '[hand]\nsource = recorded\nmotion = no_such_folder\n'
bad 'bad.study:2: grid.contact.k: ' '[grid]\ncontact.k = 1\n' --simulate 2
bad 'bad.study:2: grid.contact.k_e: .*found "-1"' '[grid]\ncontact.k_e = 2500,-1\n' --simulate 2
bad 'a session has no grid' '[grid]\ncontact.k_e = 1000\n'
bad 'nothing.ini: No such' '[device]\nconfig = ./nothing.ini\n'
bad 'none.scene: No such' '[scene]\nfile = ./none.scene\n'
printf 'square 1\n' >"$folder/odd.scene"
bad 'odd.scene:1: .*polygon' "[scene]\nfile = $folder/odd.scene\n"
bad 'participant: found 9' '[study]\n' --participant 9
refuse 2 'none.study: No such file' "$study" "$folder/none.study" --out "$folder/bad"
refuse 2 'holds a session; --resume' "$study" --out "$folder/paper"

# A study's own scene stands in the place of its configuration's, for any hand.
cmp "$folder/paper/scene.scene" "$BUILD/share/ethd/room.scene" || fail "the paper's study isn't in the room"
printf '[arm]\n[scene]\nfile = away.scene\n[contact]\nk_e = 2000\n' >"$folder/away.ini"
echo 'halfplane -1 0 -0.2' >"$folder/away.scene"
printf '[study]\nparticipants = 1\ntaps = 1\ntraining = 0\n[device]\nconfig = away.ini\n[scene]\nfile = near.scene\n' >"$folder/scene.study"
echo 'halfplane -1 0 -0.25' >"$folder/near.scene"
"$study" "$folder/scene.study" --quiet --out "$folder/scene" >"$folder/out" 2>&1 || fail "a study's scene: $(cat "$folder/out")"
cmp "$folder/scene/scene.scene" "$folder/near.scene" || fail "the study's scene isn't the folder's"
printf '[arm]\n[scene]\nfile = scene.scene\n[contact]\nk_e = 2000\n' | cmp - "$folder/scene/config.ini" || fail "the scene's line"

# another study doesn't replace a simulation, the same one goes on; and no study overwrites its own inputs
printf '[study]\ntaps = 1\nattempts = 3\ntraining = 0\n' >"$folder/one.study"
printf '[study]\ntaps = 2\nattempts = 3\ntraining = 0\n' >"$folder/other.study"
"$study" "$folder/one.study" --simulate 1 --out "$folder/sim" >/dev/null || fail "a simulation"
kept=$folder/sim/study.ini
refuse 2 'sim: holds study.ini, of another study' "$study" "$folder/other.study" --simulate 1 --out "$folder/sim"
refuse 1 'was finished before; nothing is added' "$study" "$folder/one.study" --simulate 1 --out "$folder/sim"
"$study" "$folder/one.study" --simulate 1 --shard 1/1 --out "$folder/sim" >"$folder/out" 2>&1 || fail "a worker's command again: $(cat "$folder/out")"
refuse 2 'holds a simulation of 1 participant; another folder is needed for 2' "$study" "$folder/one.study" --simulate 2 --out "$folder/sim"
mkdir "$folder/here"
cp "$BUILD/share/ethd/n.ini" "$folder/here/config.ini"
cp "$BUILD/share/ethd/wall.scene" "$folder/here"
printf '[device]\nconfig = config.ini\n' >"$folder/here/my.study"
kept=$folder/here/config.ini
refuse 2 'the study is made of files in it' sh -c "cd '$folder/here' && exec '$study' my.study --out ."
mkdir "$folder/notes"
echo mine >"$folder/notes/README.md"
kept=$folder/notes/README.md
refuse 2 'README.md' "$study" "$folder/one.study" --out "$folder/notes"

[ $failed = 0 ] && echo "$kills random kills of $((whole + 1)) sessions, ${dead:-no} at calls"
exit $failed
