#!/bin/sh
# What identification, tuning and the search for a plant write: no input is written over and no output by another one, a
# journal loses nothing to a kill, a full disk, a second process or a damaged line, and a search that was ended says so.
set -u
bin=$BUILD/bin
python=${PYTHON:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failed=0
fail() { echo "FAILED $*"; failed=1; }

# refuse PATTERN COMMAND...: exit 2 and one line, before anything is worked out
refuse() {
  pattern=$1
  shift
  "$@" >out 2>err </dev/null
  code=$?
  [ $code = 2 ] && [ "$(wc -l <err)" = 1 ] && grep -q -e "$pattern" err || fail "$*: exit $code: $(cat err)"
}

# ---- an output that is an input, or another output ----
"$bin/ethd-identify" --excite --virtual --duration 6.158 --record sines >said || fail "a recording: exit $?"
cp "$bin/../share/ethd/n.plant" mine.plant
find . -type f ! -name out ! -name err ! -name before -exec md5sum {} + | sort >before
identify="$bin/ethd-identify sines --base mine.plant"
refuse 'out: mine.plant is the file of --base, which is only read' $identify --out mine.plant
refuse 'csv: ./mine.plant is the file of --base' $identify --csv ./mine.plant
for file in tick.npy config.ini events.csv; do
  refuse "out: sines/$file belongs to the recording sines, which is only read" $identify --out "sines/$file"
done
refuse 'plot: sines/events.csv belongs to the recording' $identify --plot sines/events.png
refuse 'csv: ./fit is the file of --out, too' $identify --out fit --csv ./fit
ln -s events.csv sines/other
refuse 'csv: sines/other belongs to the recording' $identify --csv sines/other
rm sines/other
cp "$bin/../share/ethd/n.ini" "$bin/../share/ethd/wall.scene" .
md5sum ./n.ini ./wall.scene >>before
tune="$bin/ethd-tune --plant mine.plant --config n.ini --points 8 --taps 20"
refuse 'plot: found "mine.plant", a file .png is needed' $tune --csv x.csv --plot mine.plant
refuse 'csv: ./x is the file of --out, too' $tune --out x --csv ./x
refuse 'plot: x.png is the file of --csv, too' $tune --csv x.png --plot x.png
cp "$bin/../share/ethd/n.plant" "$bin/../share/ethd/n.ini" .
refuse 'out: n.plant is the file of the plant that the search begins from' env ETHD_DATA_DIR=. "$bin/ethd-explain" --out n
refuse 'work: x.ini is the file of --out, too\|out: x.ini is the file of --work' "$bin/ethd-explain" --out x --work x.ini
refuse 'plot: ring.png is the file of --csv, too' "$bin/ethd-calibrate" --self-test --csv ring.png --plot ring.png
md5sum --quiet -c before || fail "an input was changed"
# devices take what several write
"$bin/ethd-identify" sines --base mine.plant --out /dev/null --csv /dev/null >said 2>err || fail "/dev/null twice: $(cat err)"

# ---- the journal of a search for a plant ----
search="$bin/ethd-explain --population 8 --generations 0 --taps 10 --without limits"
$search --work whole >whole.txt 2>err || fail "a search: $(cat err)"
[ "$(wc -l <whole)" = 9 ] || fail "$(wc -l <whole) lines: $(cat whole)"
# limited BYTES COMMAND...: no file may be longer
limited() { "$python" -c 'import os, resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]),) * 2)
os.execv(sys.argv[2], sys.argv[2:])' "$@"; }
size=$(head -n 4 whole | wc -c)
{ limited $((size + 3)) $search --work full; echo $? >code; } 2>&1 | cat >said
[ "$(cat code)" = 1 ] && grep -q 'full: File too large' said || fail "a full disk: exit $(cat code): $(cat said)"
head -c "$(wc -c <full)" whole | cmp - full || fail "what was judged before the disk was full is gone: $(cat full)"
$search --work full >full.txt 2>err && cmp whole full && cmp whole.txt full.txt || fail "gone on after a full disk: $(cat err)"
# what is there needs no room: an earlier journal stays as it is
{ limited 20 $search --work full; echo $? >code; } 2>&1 | cat >said
cmp whole full && [ "$(cat code)" = 0 ] || fail "a journal is lost when the disk is full: exit $(cat code): $(cat full said)"

# killed at any moment, even within its first line
printf 'ethd-explain ' >killed
least=0
for pause in 0.02 0.1 0.3 0.5 0.9 1.5; do
  $search --work killed >/dev/null 2>&1 & # no function: the shell's own process would be killed
  sleep $pause
  kill -KILL $! 2>/dev/null
  wait $! 2>/dev/null
  lines=$(wc -l <killed)
  [ "$lines" -ge "$least" ] || fail "a kill takes $((least - lines)) lines"
  least=$lines
done
$search --work killed >killed.txt 2>err && cmp whole killed && cmp whole.txt killed.txt || fail "gone on after kills: $(cat err)"

# a line that is no number, one that is none to be compared, a file of something else
for line in abc nan -1 '' ' 1'; do
  { head -n 3 whole; echo "$line"; } >damaged
  cp damaged kept
  refuse 'damaged:4: no sum of misses' $search --work damaged
  cmp -s damaged kept || fail "a damaged journal was changed"
done
echo 'my notes' >notes
$search --work notes >out 2>err
[ $? = 1 ] && grep -q 'another --work' err && [ "$(cat notes)" = 'my notes' ] || fail "a file of something else: $(cat err notes)"

# two at once; a search that is ended says so, and writes no plant that isn't the search's
endless="$bin/ethd-explain --population 8 --generations 100000 --taps 10 --without limits --work shared"
$endless --out never >said 2>shared.err &
first=$!
lines_of() { if [ -f "$1" ]; then wc -l <"$1"; else echo 0; fi; }
while [ "$(lines_of shared)" -lt 2 ]; do sleep 0.05; done
refuse 'shared: another process works on this search' $endless
kill -TERM $first
wait $first
[ $? = 1 ] && grep -q 'stopped; nothing is written, and the same command goes on' shared.err || fail "a search that was ended: $(cat shared.err)"
[ ! -e never.plant ] && [ ! -e never.ini ] || fail "a search that was ended wrote its plant"

# ---- mounts of its own: standard output that is closed, and a full disk ----
# ---- a recording on a full disk, whose events end just before a block does: the row about it has its room ----
if unshare -rm true 2>/dev/null; then
  mkdir disk
  # a copy of /dev, so that nothing can replace the system's
  cat >"$folder/closed.sh" <<'END'
mount -t tmpfs tmpfs disk && mkdir disk/dev && cd disk || exit 9
ln -s /proc/self/fd dev/fd && ln -s /proc/self/fd/1 dev/stdout && touch dev/null && mount --bind /dev/null dev/null || exit 9
mount --rbind dev /dev || exit 9
tap="$1/ethd-tap --taps 1 --transition offset --speed low"
for name in stdout fd/1 ../dev/stdout; do
  $tap --csv /dev/$name >&- 2>err
  [ $? = 2 ] && [ "$(wc -l <err)" = 1 ] && grep -q "/dev/$name: " err || { echo "$name: $(cat err)"; exit 1; }
done
[ -L /dev/stdout ] && [ -z "$(ls /dev | grep new)" ] || { ls -l /dev; exit 1; }
$tap --csv /dev/stdout >both 2>err && [ "$(grep -c '^0,offset' both)" = 1 ] && grep -q 'm/s' both || { echo "written through: $(cat err both)"; exit 1; }
# what is printed goes into no file
$tap --csv taps.csv --record r >&- 2>err
[ $? = 1 ] && grep -q 'standard output: ' err && [ "$(wc -l <taps.csv)" = 2 ] || { echo "closed: $(cat err taps.csv)"; exit 1; }
"$1/ethd-replay" --verify r >said || { cat said; exit 1; }
END
  unshare -rm sh "$folder/closed.sh" "$bin" >said 2>&1 || fail "standard output is closed: $(cat said)"
  cat >"$folder/fill.sh" <<'END'
mount -t tmpfs -o size=1m tmpfs disk && cd disk || exit 9
whole=0
for count in $(seq 128 2 172); do
  { yes 'set contact.k_e 2000' | head -n "$count"; echo 'wait 9'; } | "$1/ethd-run" --virtual --duration 9 --record r >said 2>err
  [ "$(grep -c ',fault,the recorder lost rows: No space left on device$' r/events.csv)" = 1 ] && whole=$((whole + 1)) ||
    { echo "after $count settings, $(wc -c <r/events.csv) bytes:"; tail -n 2 r/events.csv; }
  rm -r r
done
[ $whole = 23 ]
END
  unshare -rm sh "$folder/fill.sh" "$bin" >said 2>&1 || fail "a full disk has no room for its event: $(cat said)"
else
  echo 'no mounts of its own: a recording on a full disk is left out'
fi
exit $failed
