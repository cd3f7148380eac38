#!/bin/sh
# Folders, drawings and names from a stranger: they are looked at and nothing of theirs runs, nothing is read or written elsewhere,
# and a terminal obeys none of their words.
. tests/begin.sh
bin=$BUILD/bin
python=${PYTHON:-python3}

# Every way to run a command or to leave the folder ends in this file.
canary=$folder/canary
export canary
quiet() { # WHAT
  [ ! -e "$canary" ] || { fail "$1: a command of theirs ran"; rm -f "$canary"; }
}

# No script of the plots has a shell: neither system(), nor backquotes, nor a file that is a command.
! grep -nE 'system\(|`|"<|output *"\||shell|popen' apps/plot/*.gp || fail "a plot script runs commands"
# In C and in Python one module each runs gnuplot, no shell starts anything, and text reaches a page through one writer.
[ "$(grep -l 'spawnp' -r apps drivers --include='*.c')" = apps/cli/picture.c ] && [ "$(grep -l '"gnuplot"' -r apps/python/ethd_programs)" = apps/python/ethd_programs/report/pictures.py ] ||
  fail "gnuplot is run elsewhere"
! grep -rnE 'os\.system|shell *=|popen\(' apps/python/ethd_programs || fail "a program runs a shell"
[ "$(grep -l '_parts' -r apps/python/ethd_programs/report)" = apps/python/ethd_programs/report/page.py ] || fail "a page is written elsewhere"

# ---- a study's folder ----
printf '[study]\nname = small\nparticipants = 2\ntaps = 1\nattempts = 8\ntraining = 1\nsurvey = off\n' >"$folder/small.study"
"$bin/ethd-study" --quiet "$folder/small.study" --out "$folder/good" >"$folder/said" 2>&1 || fail "$(cat "$folder/said")"
pictures=no
gnuplot -e 'set terminal pngcairo' </dev/null 2>/dev/null && pictures=yes
copy() { rm -rf "$folder/bad"; cp -r "$folder/good" "$folder/bad"; }
report() { "$bin/ethd-report" "$folder/bad" --force "$@" >"$folder/said" 2>"$folder/err"; }

# A plant's name is a word for the picture; the same in every quoting that a shell or gnuplot knows.
for plant in "n'; system('touch \$canary'); x='" 'n"; system("touch $canary"); x="' '`touch $canary`' '$(touch $canary)' "n'.system('touch \$canary').'"; do
  copy
  printf "[device]\nplant = %s\n" "$plant" >>"$folder/bad/study.ini"
  report
  code=$?
  [ $pictures = no ] || [ $code = 0 ] || fail "plant $plant: exit $code: $(cat "$folder/err")"
  quiet "plant $plant"
done

# A law's name stands in file names.
for law in '/../../../x' "x'; system('touch \$canary'); '" '|touch $canary' '<touch $canary' '-e'; do
  copy
  awk -F, -v OFS=, -v law="$law" 'NR > 1 { $5 = law } 1' "$folder/good/taps.csv" >"$folder/bad/taps.csv"
  refuse 2 'taps.csv:[0-9]*: transition: found .*, a word of up to 31 letters' report
  quiet "transition $law"
  [ "$(find "$folder" -newer "$folder/bad/taps.csv" -name '*trace*' ! -path '*/report/*' | wc -l)" = 0 ] || fail "$law: written elsewhere"
done
copy
awk -F, -v OFS=, 'NR > 1 { $1 = "../../good/taps/P01" } 1' "$folder/good/taps.csv" >"$folder/bad/taps.csv"
report && fail "a participant who is a path"
grep -q 'participant: found' "$folder/err" || fail "a participant who is a path: $(cat "$folder/err")"

# The configuration's words are text on the page.
if [ $pictures = yes ]; then
  copy
  printf '[hand]\nsource = people\n' >>"$folder/bad/study.ini"
  echo /nowhere >"$folder/bad/device.folder"
  sed -i 's/,simulated,/,device,/' "$folder/bad/taps.csv"
  { cat "$folder/good/config.ini"; printf '\n[device]\ndriver = <script>alert(1)</script>&\n'; } | grep -v '^driver = sim' >"$folder/bad/config.ini"
  report
  page=$folder/bad/report/report.html
  if [ -e "$page" ]; then
    grep -q '&lt;script&gt;alert(1)&lt;/script&gt;&amp;' "$page" || fail "the driver isn't on the page"
    ! grep -q '<script' "$page" || fail "the driver is markup on the page"
  else
    fail "a driver's name: $(cat "$folder/err")"
  fi
  # a folder and a picture whose names are commands
  cp -r "$folder/good" "$folder/a 'b\`touch \$canary\`"
  "$bin/ethd-report" "$folder/a 'b\`touch \$canary\`" --out "$folder/|touch \$canary;" >"$folder/said" 2>"$folder/err" || fail "names: $(cat "$folder/err")"
  quiet "a folder's name"
  [ -s "$folder/|touch \$canary;/report.html" ] || fail "no page in a folder with an odd name"
fi

# ---- plugins that a folder brings along ----
cat >"$folder/evil.c" <<'END'
#include <stdio.h>
#include <stdlib.h>
__attribute__((constructor)) static void run(void) { FILE *f = fopen(getenv("canary"), "w"); if (f) fclose(f); }
int ethd_plugin;
END
${CC:-cc} -shared -fPIC -o "$folder/evil.so" "$folder/evil.c" 2>"$folder/err" || fail "$(cat "$folder/err")"
copy
printf '\n[plugins]\nfile = %s\n' "$folder/evil.so" >>"$folder/bad/config.ini"
report && fail "a report with a plugin"
grep -q 'config.ini:[0-9]*: plugins.file: .*evil.so is a program .*--plugins' "$folder/err" || fail "a plugin: $(cat "$folder/err")"
quiet "ethd-report"
"$bin/ethd-tap" --taps 1 --transition offset --speed low --record "$folder/rec" >/dev/null || fail "a recording"
printf '\n[plugins]\nfile = %s\n' "$folder/evil.so" >>"$folder/rec/config.ini"
"$bin/ethd-replay" --verify "$folder/rec" >"$folder/said" 2>"$folder/err" && fail "a recording with a plugin is verified"
grep -q 'evil.so is a program .*--plugins' "$folder/err" || fail "a recording's plugin: $(cat "$folder/err")"
"$bin/ethd-convert" "$folder/rec" "$folder/rec.csv" >"$folder/said" 2>&1 || fail "converting: $(cat "$folder/said")"
"$bin/ethd-study" --merge "$folder/bad" >"$folder/said" 2>&1
quiet "looking at a recording"
"$bin/ethd-replay" --verify "$folder/rec" --plugins >"$folder/said" 2>"$folder/err"
[ -e "$canary" ] || fail "--plugins doesn't load the plugin: the test sees nothing"
rm -f "$canary"

# ---- links, pipes, devices and holes that a folder brings along ----
mkdir "$folder/home" "$folder/other"
echo 'my thesis' >"$folder/home/thesis"
mine() { # WHAT: what isn't named stays as it was
  [ "$(cat "$folder/home/thesis")" = 'my thesis' ] || { fail "$1: a file elsewhere is written over"; echo 'my thesis' >"$folder/home/thesis"; }
  [ -z "$(ls -A "$folder/other")" ] || { fail "$1: a folder elsewhere is filled"; rm -rf "$folder/other"; mkdir "$folder/other"; }
  ! grep -q 'my thesis' "$folder/said" "$folder/out" "$folder/err" || fail "$1: a file elsewhere is shown"
}
# refused WHAT PATTERN COMMAND...: one line, and no wait
refused() {
  what=$1 pattern=$2
  shift 2
  refuse '[12]' "$pattern" timeout -s KILL 60 "$@"
  mine "$what"
}
for i in 1 2; do
  "$bin/ethd-study" apps/config/crowd.study --simulate 2 --shard $i/2 --out "$folder/crowd" --quiet >"$folder/said" 2>&1 || fail "$(cat "$folder/said")"
done
for name in taps.csv SHA256SUMS; do
  ln -s ../home/thesis "$folder/crowd/$name"
  refused "--merge over a link $name" "crowd/$name: is a link" "$bin/ethd-study" --merge "$folder/crowd"
  rm -f "$folder/crowd/$name" "$folder/crowd/taps.csv"
done
part=$folder/crowd/shard-1-of-2.sqlite
mv "$part" "$folder/shard"
mkfifo "$part"
refused '--merge of a pipe' 'shard-1-of-2.sqlite: is a pipe, a file is needed' "$bin/ethd-study" --merge "$folder/crowd"
rm "$part"
for target in /dev/zero "$folder/shard" ../home/thesis; do
  ln -s "$target" "$part"
  refused "--merge of a link to $target" 'shard-1-of-2.sqlite: is a link' "$bin/ethd-study" --merge "$folder/crowd"
  rm "$part"
done
cp "$folder/shard" "$part"
truncate -s 8G "$part"
(ulimit -v 1000000 && refused '--merge of a hole' 'shard-1-of-2.sqlite: has a hole' "$bin/ethd-study" --merge "$folder/crowd"; exit $failed) || failed=1
mv "$folder/shard" "$part"
"$bin/ethd-study" --merge "$folder/crowd" >"$folder/said" 2>"$folder/err" || fail "--merge: $(cat "$folder/err")"

# each file that is read: a link, a pipe, a device
for name in study.ini config.ini scene.scene device.plant taps.csv study.sqlite; do
  for kind in link pipe; do
    copy
    rm "$folder/bad/$name"
    if [ $kind = link ]; then ln -s ../home/thesis "$folder/bad/$name"; else mkfifo "$folder/bad/$name"; fi
    [ $name = study.sqlite ] || refused "ethd-report of a $kind $name" "bad/.*$name: is a $kind" "$bin/ethd-report" "$folder/bad"
    [ $name = taps.csv ] || refused "--resume of a $kind $name" "bad/.*$name: is a $kind\\|bad/.*$name: isn't a file" "$bin/ethd-study" --resume "$folder/bad" --quiet
    refused "--verify of a $kind $name" "$name is missing or can't be read" "$bin/ethd-study" --verify "$folder/bad"
  done
done
# SQLite's own journal beside the store, which it would read, follow and remove
for kind in link pipe; do
  copy
  if [ $kind = link ]; then ln -s ../home/thesis "$folder/bad/study.sqlite-journal"; else mkfifo "$folder/bad/study.sqlite-journal"; fi
  for way in --resume --export; do refused "$way beside a $kind" "study.sqlite-journal: is a $kind" "$bin/ethd-study" $way "$folder/bad"; done
done
copy
echo junk >"$folder/bad/study.sqlite-journal"
refused '--export beside a journal' 'its last change was cut short' "$bin/ethd-study" --export "$folder/bad"
copy
ln -s ../../home/thesis "$folder/bad/taps/note"
refused '--verify of a link that is new' "taps/note isn't listed" "$bin/ethd-study" --verify "$folder/bad"
copy
truncate -s 900G "$folder/bad/README.md"
refused '--verify of a hole' "README.md is missing or can't be read" "$bin/ethd-study" --verify "$folder/bad"
copy
mv "$folder/bad/taps" "$folder/taps"
ln -s ../taps "$folder/bad/taps"
refused 'recordings behind a link' "taps/P[^ ]* is missing" "$bin/ethd-study" --verify "$folder/bad"
rm -rf "$folder/taps"

# what is written: a report that is a link, or holds some
for target in ../../home/thesis ../../home/nothing /dev/null; do
  for name in report.html tidy.csv boxes.png .lock; do
    copy
    mkdir "$folder/bad/report"
    ln -s "$target" "$folder/bad/report/$name"
    refused "a report's $name is a link to $target" "bad/report/$name: is" "$bin/ethd-report" --force "$folder/bad"
    [ ! -e "$folder/home/nothing" ] || { fail "a report's $name makes a file elsewhere"; rm "$folder/home/nothing"; }
  done
done
copy
ln -s ../other "$folder/bad/report"
refused 'a report that is a link' 'bad/report: is a link' "$bin/ethd-report" "$folder/bad"
refused 'a report that is a link, --force' 'bad/report: is a link' "$bin/ethd-report" --force "$folder/bad"

# recordings
record() { rm -rf "$folder/rec"; cp -r "$folder/kept" "$folder/rec"; }
"$bin/ethd-run" --virtual --duration 0.5 --record "$folder/kept" </dev/null >"$folder/said" 2>&1 || fail "$(cat "$folder/said")"
read_all() { # WHAT PATTERN
  refused "$1, ethd-replay" "$2" "$bin/ethd-replay" --verify "$folder/rec"
  refused "$1, ethd-identify" "$2" "$bin/ethd-identify" "$folder/rec"
}
for name in tick.npy events.csv config.ini; do
  record
  rm "$folder/rec/$name"
  ln -s "../kept/$name" "$folder/rec/$name"
  read_all "a link $name" "rec/$name: is a link"
  rm "$folder/rec/$name"
  mkfifo "$folder/rec/$name"
  read_all "a pipe $name" "rec/$name: is a pipe"
  [ $name = config.ini ] || refused "a pipe $name, ethd-convert" "rec/$name: is a pipe" "$bin/ethd-convert" "$folder/rec" "$folder/rec.csv"
done
record
mkfifo "$folder/pipe"
for scene in ../pipe /dev/zero "$folder/home/thesis" ../home/thesis; do
  printf '[scene]\nfile = %s\n' "$scene" >"$folder/rec/config.ini"
  read_all "the scene $scene" 'config.ini:2: scene.file: .*leads out of the folder'
done
# a hole takes no memory; rows that were never written are no rows
record
truncate -s 8G "$folder/rec/tick.npy"
truncate -s 900M "$folder/rec/events.csv"
(ulimit -v 4000000 && refused 'text with a hole' 'events.csv: a byte 0' "$bin/ethd-replay" --verify "$folder/rec"; exit $failed) || failed=1
cp "$folder/kept/events.csv" "$folder/rec/events.csv"
(ulimit -v 1000000 && "$bin/ethd-replay" --verify "$folder/rec") >"$folder/said" 2>&1 || fail "rows before a hole: $(cat "$folder/said")"
"$python" - "$folder/rec/tick.npy" <<'END'
import re, sys
with open(sys.argv[1], "r+b") as file:
    head = file.read(8192)
    count = re.search(rb"'shape': \((\d+),\), } *", head)
    file.seek(count.start())
    file.write(b"'shape': (4000000,), }".ljust(len(count.group())))
END
read_all 'rows in a hole' 'tick.npy: has a hole: some of its 4000000 rows were never written'

# ---- waits end by a signal, for files of one's own too ----
# ends WHAT SIGNAL COMMAND...: the command waits, and ends within a few seconds of the signal
ends() {
  what=$1 signal=$2
  shift 2
  timeout -s KILL 60 "$python" -c 'import signal, subprocess, sys, time
signal.signal(signal.SIGINT, signal.SIG_DFL) # a background job has it ignored, and a program leaves it so
command = subprocess.Popen(sys.argv[2:], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
time.sleep(0.5)
assert command.poll() is None, "it did not wait"
command.send_signal(getattr(signal, "SIG" + sys.argv[1]))
command.wait(10)' "$signal" "$@" 2>"$folder/err" || fail "$what: $(tail -n 1 "$folder/err")"
}
for signal in INT TERM; do
  ends "--in of a pipe, $signal" $signal "$bin/ethd-replay" --in "$folder/pipe" --out "$folder/out.csv"
  ends "--out to a pipe, $signal" $signal "$bin/ethd-scene" convert --in apps/config/wall.scene --out "$folder/pipe"
  ends "--config of a pipe, $signal" $signal "$bin/ethd-tap" --config "$folder/pipe"
done
mkdir "$folder/bin"
printf '#!/bin/sh\nexec sleep 30\n' >"$folder/bin/gnuplot"
chmod +x "$folder/bin/gnuplot"
ends 'gnuplot' INT env "PATH=$folder/bin:$PATH" "$bin/ethd-scene" info apps/config/wall.scene --plot "$folder/x.png"
# nobody reads: the pipe is full
"$python" -c 'for i in range(20000): print(f"{i * 1e-3:.3f},1.57,0,0.25,0.25,0,0")' | sed '1i t_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps' >"$folder/long.csv"
ends 'a full pipe' INT "$bin/ethd-replay" --in "$folder/long.csv" --out /dev/stdout
# a device gives no end
refused '/dev/zero' 'zero: is a device, a file is needed' "$bin/ethd-replay" --in /dev/zero --out "$folder/out.csv"
[ "$("$bin/ethd-scene" info /dev/stdin <apps/config/wall.scene | wc -l)" -gt 1 ] && [ "$(cat apps/config/wall.scene | "$bin/ethd-scene" info /dev/stdin | wc -l)" -gt 1 ] ||
  fail 'a pipe of one'"'"'s own is not read'

# ---- pictures ----
echo 'halfplane -1 0 -0.238' >"$folder/wall.scene"
for picture in '|touch $canary;.png' '<touch $canary.png' '| touch $canary #.png'; do
  (cd "$folder" && "$bin/ethd-scene" info wall.scene --plot "$picture") >"$folder/said" 2>"$folder/err"
  [ $? = 2 ] && grep -q -e '--plot: found .*, a file .png is needed' "$folder/err" || fail "--plot $picture: $(cat "$folder/err")"
  (cd "$folder" && "$bin/ethd-calibrate" --self-test --csv ring.csv --plot "$picture") >"$folder/said" 2>"$folder/err"
  [ $? = 2 ] || fail "ethd-calibrate --plot $picture: $(cat "$folder/err")"
  quiet "--plot $picture"
done
if [ $pictures = yes ]; then
  cp "$folder/wall.scene" "$folder/|touch \$canary;'.scene"
  (cd "$folder" && "$bin/ethd-scene" info "|touch \$canary;'.scene" --plot "-odd'\`name\`.png") >"$folder/said" 2>&1 &&
    [ -s "$folder/-odd'\`name\`.png" ] || fail "a scene of an odd name: $(cat "$folder/said")"
  quiet "a scene's name"
fi

# ---- a study's and an output's name on many cores ----
mkdir "$folder/a b;touch \$canary"
cp "$folder/small.study" "$folder/a b;touch \$canary/s'{}.study"
ETHD_STUDY=$bin/ethd-study sh apps/cluster/parallel.sh "$folder/a b;touch \$canary/s'{}.study" 2 "$folder/o {};touch \$canary" 2 >"$folder/said" 2>&1 ||
  fail "parallel.sh: $(cat "$folder/said")"
quiet "parallel.sh"
[ -s "$folder/o {};touch \$canary/taps.csv" ] || fail "parallel.sh: no taps"

# ---- a terminal ----
cat >"$folder/terminal.py" <<'END'
import os, pty, sys
pid, fd = pty.fork()
if pid == 0:
    os.execv(sys.argv[2], sys.argv[2:])
out = b""
while True:
    try:
        data = os.read(fd, 65536)
    except OSError:
        break
    if not data:
        break
    out += data
os.waitpid(pid, 0)
open(sys.argv[1], "wb").write(out)
END
odd=$(printf 'evil\033]0;owned\007\233\302\233.scene')
cp "$folder/wall.scene" "$folder/$odd"
"$python" "$folder/terminal.py" "$folder/tty" "$bin/ethd-scene" info "$folder/$odd" </dev/null >/dev/null 2>&1
grep -aq 'evil?\]0;owned?' "$folder/tty" || fail "on a terminal: $(od -c "$folder/tty" | head)"
"$python" -c 'import sys; d = open(sys.argv[1], "rb").read().replace(b"\r\n", b""); sys.exit(any(c < 32 and c != 9 for c in d) or b"\xc2\x9b" in d)' "$folder/tty" ||
  fail "a terminal gets control characters: $(od -c "$folder/tty" | head)"
"$python" "$folder/terminal.py" "$folder/tty" "$bin/ethd-scene" info "$folder/no$odd" </dev/null >/dev/null 2>&1
! grep -aq "$(printf '\033')" "$folder/tty" || fail "a refusal on a terminal: $(od -c "$folder/tty" | head)"
"$bin/ethd-scene" info "$folder/$odd" | grep -aq "$(printf 'evil\033')" || fail "a pipe doesn't get the name as it is"

[ $failed = 0 ] && [ $pictures = no ] && { echo "SKIP: gnuplot (Debian: gnuplot-nox); all else passed"; exit 77; }
exit $failed
