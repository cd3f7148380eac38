#!/bin/sh
# ethd-run: commands, recordings that replay, telemetry, signals, a killed run, the virtual clock's repeatability.
# No time is asserted, only order.
. tests/begin.sh
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
run=$BUILD/bin/ethd-run
verify="$BUILD/bin/ethd-replay --verify"

replays() { $verify "$1" >"$folder/verify" 2>&1 && grep -q 'equal to the bit' "$folder/verify" || { fail "$1: $(cat "$folder/verify")"; }; }

cat >"$folder/device.ini" <<'END2'
[scene]
file = wall.scene
[transition]
law = offset
[limits]
speed = 5
stop_time = 1
END2
echo 'halfplane -1 0 -0.238' >"$folder/wall.scene"

# any law is swapped, and the recording says so
printf 'wait 0.3\ncontact spring\nwait 0.3\ncontact kelvin-voigt\nset contact.b_e 4\ncontact hunt-crossley\ntracking pd\ncontact\ncontact smooth\nwait 0.3\nstop\n' |
  "$run" --config "$folder/device.ini" --virtual --duration 2 --record "$folder/laws" >"$folder/laws.out" 2>&1 || fail "laws: exit $?: $(cat "$folder/laws.out")"
says "$folder/laws.out" '^ok: contact spring$' '^ok: contact hunt-crossley$' '^ok: tracking pd$' '^error: contact LAW$' '^error: .*found "smooth", .*spring.* is allowed'
"$BUILD/bin/ethd-replay" --verify "$folder/laws" >"$folder/laws.out" 2>&1 || fail "laws don't replay: $(cat "$folder/laws.out")"
grep -c '^.*,contact,' "$folder/laws/events.csv" | grep -qx 3 || fail "events of laws: $(cat "$folder/laws/events.csv")"

# ---- virtual: every command, equal bytes twice ----
script='status\nwait 0.3\ntransition smooth\nset contact.k_e 2000\nwait 0.2\ntransition abrupt\nack\nenable\nbogus\nset contact.k_e -1\nset contact.k_e\ntransition nowhere\nset limits.speed 0.001\nwait 0.3\nenable\nstatus\nack\nset limits.speed 5\nwait 0.1\nenable\nwait 0.4\nstatus\nstop\n'
for k in 1 2; do
  printf "$script" | "$run" --virtual --duration 100 --config "$folder/device.ini" --record "$folder/v$k" >"$folder/v$k.out" 2>"$folder/v$k.err" ||
    fail "virtual run $k: exit $?: $(cat "$folder/v$k.err")"
  replays "$folder/v$k"
done
sed "s|$folder/v2|$folder/v1|" "$folder/v2.out" | cmp - "$folder/v1.out" || fail "two virtual runs answer differently"
diff -r "$folder/v1" "$folder/v2" || fail "two virtual runs leave different recordings"
says "$folder/v1.out" '^ok: t 0.001 s, enabled, offset, transparent' '^ok: transition smooth$' '^ok: set contact.k_e 2000$' \
  '^error: there is no fault to acknowledge$' '^error: the device is enabled$' '^error: found "bogus"' \
  '^error: contact.k_e: found "-1", ' '^error: set SECTION.KEY VALUE$' '^error: .*nowhere' \
  '^error: a fault is latched: the ring is faster' '^ok: acknowledged; the device is disabled' '^ok: enabled$' \
  '^ok: t .* enabled, abrupt, .* no fault$' '^ok: stopping$' '^faults  *1 x the ring is faster than its limit$' 'virtual'
says "$folder/v1/events.csv" ',transition,smooth$' ',set,contact.k_e 2000$' ',clear,' ',start,enabled$' ',fault,' ',set,limits.speed 0$'

# periods longer than a torque may be held
for period in 0.0601 0.1; do
  printf '[loop]\nperiod = %s\n' $period >"$folder/slow.ini"
  "$run" --virtual --duration 5 --config "$folder/slow.ini" </dev/null >"$folder/slow.out" 2>&1 || fail "period $period: exit $?"
  ! grep 'too old' "$folder/slow.out" || fail "loop.period = $period"
done

# an acknowledgement counts after a clean time
{ cat "$folder/device.ini"; echo 'clean_time = 0.5'; } >"$folder/clean.ini"
printf 'wait 0.1\nset limits.speed 0.001\nwait 0.3\nset limits.speed 5\nwait 0.2\nack\nwait 0.4\nack\nenable\nstop\n' |
  "$run" --virtual --duration 9 --config "$folder/clean.ini" --record "$folder/clean" >"$folder/clean.out" 2>&1 || fail "clean time: exit $?"
says "$folder/clean.out" '^error: no fault for 0.[0-4][0-9]* s, 0.5 s are required$' '^ok: acknowledged; ' '^ok: enabled$'
replays "$folder/clean"

# an enabling keeps the motors' heat, and replays
{ printf '[device]\nplant = n\n'; cat "$folder/device.ini"; printf 'nominal_torque = 0.02\nheat_time = 0.2\n'; } >"$folder/hot.ini"
printf 'wait 0.1\nack\nenable\nwait 0.5\nstop\n' |
  "$run" --virtual --duration 9 --config "$folder/hot.ini" --record "$folder/hot" >"$folder/hot.out" 2>&1 || fail "heat: exit $?"
says "$folder/hot.out" '^ok: enabled$' ' x a motor is too hot$'
replays "$folder/hot"

# a law that looks ahead, swapped in later, replays with what the device said of itself
printf '[device]\nplant = n\n[scene]\nfile = wall.scene\n' >"$folder/ahead.ini"
printf 'wait 0.5\ntransition predictive\nwait 2\nstop\n' |
  "$run" --virtual --duration 9 --config "$folder/ahead.ini" --record "$folder/ahead" >"$folder/ahead.out" 2>&1 || fail "ahead: exit $?"
says "$folder/ahead/events.csv" '^0,set,arm.mass_x ' ',transition,predictive$'
replays "$folder/ahead"

# the ticks around the first fault, for numpy; rows of an earlier fault's are gone
says "$folder/clean.out" '^snapshot  .*clean/snapshot.npy: [0-9]* ticks around the first fault, the ring is faster'
"${PYTHON:-python3}" -c 'import numpy, sys
s, all = numpy.load(sys.argv[1] + "/snapshot.npy"), numpy.load(sys.argv[1] + "/tick.npy")
first = numpy.flatnonzero(all["fault"])[0]
assert s.dtype == all.dtype and (s["tick"] == all["tick"][:len(s)]).all() and s["fault"][first] == 24
assert len(s) == min(first + 1001, len(all)), (len(s), first, len(all))' "$folder/clean" || fail "the snapshot"
[ -e "$folder/v1/snapshot.npy" ] || fail "no snapshot"
printf 'wait 5\nset limits.speed 0.001\n' | "$run" --virtual --duration 9 --snapshot "$folder/first.npy" >"$folder/first.out" 2>&1
"${PYTHON:-python3}" -c 'import numpy, sys
s = numpy.load(sys.argv[1])
assert len(s) == 3001 and not s["fault"][:2000].any() and (s["fault"][2000:] == 24).all()' "$folder/first.npy" || fail "--snapshot"
"$run" --virtual --duration 1 --snapshot "$folder/nowhere/x.npy" </dev/null >"$folder/out" 2>&1 || fail "a snapshot that isn't needed"
"$run" --faults >"$folder/faults" || fail "--faults"
[ "$(grep -cE '^ *[0-9]+ ' "$folder/faults")" -ge 36 ] || fail "$(cat "$folder/faults")"
says "$folder/faults" '^ 24  1 tick + speed lag  *stop  *stop  *the ring is faster than its limit$'

# one answer a command
[ "$(grep -cE '^(ok|error): ' "$folder/v1.out")" = 23 ] || fail "$(grep -cE '^(ok|error): ' "$folder/v1.out") answers to 23 commands"

# ---- real: two seconds, commands on stdin, telemetry ----
cat >"$folder/udp.py" <<'END2'
import json, socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
s.settimeout(30)
open(sys.argv[1], "w").write(str(s.getsockname()[1]))
k = [json.loads(s.recv(4096)) for _ in range(20)]
assert all(b["timestamp"] > a["timestamp"] for a, b in zip(k, k[1:])), k
assert {"tick", "q", "x", "tau", "beta", "fault", "armed"} <= k[0].keys(), k[0]
assert len(k[0]["q"]) == 2 and k[0]["d_re"] is None or isinstance(k[0]["d_re"], float)
END2
python3 "$folder/udp.py" "$folder/port" &
listener=$!
while ! [ -s "$folder/port" ]; do sleep 0.05; done
printf 'wait 0.4\ntransition smooth\nstatus\nwait 0.4\nset contact.b_e 40\nstatus\n' |
  "$run" --config "$folder/device.ini" --duration 2 --record "$folder/real" --telemetry "127.0.0.1:$(cat "$folder/port")" \
    >"$folder/real.out" 2>"$folder/real.err" || fail "real run: exit $?: $(cat "$folder/real.err")"
wait $listener || fail "telemetry isn't what it should be"
replays "$folder/real"
says "$folder/real.out" '^ok: transition smooth$' '^ok: set contact.b_e 40$' '^ok: t .*, smooth, ' '^ticks ' '^overruns ' \
  '^wake-up .*p50.*p99 .*p99.9.*max' '^tick .*p50' '^faults '
if grep -q '^shortfalls  *none' "$folder/real.out"; then
  [ -s "$folder/real.err" ] && fail "no shortfall, but: $(cat "$folder/real.err")"
else
  says "$folder/real.err" '^not realtime: ' 'mend: '
fi

# what was acknowledged is cleared when the answer comes, so that enable may stand on the next line
for k in 1 2 3 4 5 6 7 8 9 10 11 12; do printf 'set limits.speed 0.001\nwait 0.1\nset limits.speed 5\nwait 0.05\nack\nenable\n'; done |
  "$run" --config "$folder/device.ini" --duration 9 >"$folder/ack.out" 2>/dev/null || fail "acknowledging: exit $?"
says "$folder/ack.out" '^ok: acknowledged; ' '^ok: enabled$'
grep -A 1 '^ok: acknowledged' "$folder/ack.out" | grep '^error: a fault is latched: the ring is faster' &&
  fail "acknowledged, but it is still latched: $(cat "$folder/ack.out")"

# ---- signals: a controlled stop; a killed run ----
for signal in TERM INT HUP QUIT USR1; do
  # a shell's background jobs ignore SIGINT
  python3 -c 'import signal, subprocess, sys, time
signal.signal(signal.SIGINT, signal.SIG_DFL)
p = subprocess.Popen(sys.argv[2:], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
p.stdin.write("status\n"); p.stdin.flush()
assert p.stdout.readline().startswith("ok: t ")
for impatience in range(2): p.send_signal(getattr(signal, "SIG" + sys.argv[1])); time.sleep(0.001)
out = p.communicate()[0]
assert p.returncode == 0 and "1 x the application has ended or was told to end" in out, (p.returncode, out)' $signal "$run" --record "$folder/$signal" || fail "SIG$signal"
  replays "$folder/$signal"
done
mkdir "$folder/hosts"
python3 tests/run_hosts.py "$BUILD/bin" "$folder/hosts" || fail "shells, terminals, scripts"
"$run" --record "$folder/killed" </dev/null >/dev/null 2>&1 &
killed=$!
size() { if [ -f "$1" ]; then wc -c <"$1"; else echo 0; fi; }
while [ "$(size "$folder/killed/tick.npy")" -lt 500000 ]; do sleep 0.05; done
kill -KILL $killed
wait $killed 2>/dev/null
$verify "$folder/killed" >"$folder/verify" 2>&1
[ $? = 1 ] || fail "a killed run's recording counts as whole"
says "$folder/verify" 'killed: [0-9]* ticks, equal to the bit, but the recording was never closed'
replays "$folder/v1"

# ---- a recording of 47 MB is verified in less memory than that ----
if [ -z "${SAN:-}" ]; then
  "$run" --virtual --duration 60 --record "$folder/long" </dev/null >"$folder/long.out" 2>&1 || fail "a minute: $(cat "$folder/long.out")"
  (ulimit -v 40000 && $verify "$folder/long") >"$folder/verify" 2>&1 || fail "a minute in 40 MB: $(cat "$folder/verify")"
  says "$folder/verify" 'long: 6[0-9]* ticks, equal to the bit'
fi

# ---- ethd-latency: a histogram that adds up, and its picture ----
"$BUILD/bin/ethd-latency" --alone --duration 0.3 --csv "$folder/latency.csv" >"$folder/latency.out" 2>&1 || fail "ethd-latency: $(cat "$folder/latency.out")"
says "$folder/latency.out" '^ticks ' '^wake-up .*p50.*p99 .*p99.9.*max' '^tick .*max'
awk -F, 'NR == 1 { exit $0 != "from_s,to_s,wake,tick" } ' "$folder/latency.csv" || fail "the header: $(head -n 1 "$folder/latency.csv")"
awk -F, -v ticks="$(awk '/^ticks/ { print $2 }' "$folder/latency.out")" 'NR > 1 { wake += $3; tick += $4; bad += !($2 > $1) }
  END { exit !(tick >= ticks - 1 && tick <= ticks + 1 && wake >= tick && wake <= tick + 1 && !bad) }' "$folder/latency.csv" ||
  fail "the histogram doesn't add up: $(cat "$folder/latency.out")"
if command -v gnuplot >/dev/null; then
  gnuplot -e "in='$folder/latency.csv'; out='$folder/latency.png'" apps/plot/latency.gp >"$folder/plot" 2>&1 && [ ! -s "$folder/plot" ] ||
    fail "latency.gp: $(cat "$folder/plot")"
fi

# cyclictest runs under the loop's own conditions: its arguments are checked, and its histogram is the last column
mkdir "$folder/path"
cat >"$folder/path/cyclictest" <<END2
#!/bin/sh
echo "\$*" >>"$folder/asked"
echo "# Histogram"
echo "000003 000007"
echo "000005 000001"
END2
chmod +x "$folder/path/cyclictest"
PATH="$folder/path:$PATH" "$BUILD/bin/ethd-latency" --duration 0.2 --priority 70 >"$folder/peer.out" 2>&1 || fail "beside cyclictest: $(cat "$folder/peer.out")"
PATH="$folder/path:$PATH" "$BUILD/bin/ethd-latency" --duration 0.2 --dma-latency 20 >>"$folder/peer.out" 2>&1 || fail "beside cyclictest: $(cat "$folder/peer.out")"
sed -n 1p "$folder/asked" | grep -q -e '-p 70 -i 1000 -l 200 .* --laptop' || fail "cyclictest holds the DMA latency, the loop doesn't: $(cat "$folder/asked")"
sed -n 2p "$folder/asked" | grep -q -e ' --latency=20' || fail "cyclictest has another DMA latency: $(cat "$folder/asked")"
says "$folder/peer.out" '^cyclictest p50  *3.*max  *5.000 us'

# ---- a thinned recording: a tenth of the ticks, the fault's own among them, and one line that it can't be replayed ----
printf 'wait 0.5\nset limits.speed 0.01\nwait 0.4\nstop\n' | "$run" --virtual --duration 2 --record "$folder/thin" --record-every 10 >"$folder/thin.out" 2>&1 ||
  fail "thinned: $(cat "$folder/thin.out")"
rows=$(awk '/^recorded/ { print $3 }' "$folder/thin.out")
ticks=$(awk '/^ticks/ { print $2 }' "$folder/thin.out")
[ "$rows" -ge $((ticks / 10)) ] && [ "$rows" -le $((ticks / 10 + 3)) ] || fail "$rows of $ticks ticks: $(cat "$folder/thin.out")"
$verify "$folder/thin" >"$folder/verify" 2>&1
[ $? = 1 ] && [ "$(wc -l <"$folder/verify")" = 1 ] || fail "a thinned recording replays: $(cat "$folder/verify")"
says "$folder/verify" "thin: [0-9]* of $rows ticks are equal to the bit, the rest can't be replayed: 1 tick of 10 is recorded"

# ---- refusals ----
try=yes
printf '[device]\ndriver = nothing\n' >"$folder/bad.ini"
printf '[device]\nseed = -1\n' >"$folder/seed.ini"
refuse 2 'bad.ini: device.driver: found "nothing"; sim' "$run" --config "$folder/bad.ini"
refuse 2 'seed.ini:2: .*seed' "$run" --config "$folder/seed.ini"
refuse 2 'duration: found "0"' "$run" --duration 0
refuse 2 'virtual needs --duration' "$run" --virtual
refuse 2 'telemetry: found "nowhere"' "$run" --telemetry nowhere --virtual --duration 1
for port in 0 99999 65536; do
  refuse 2 "telemetry: found \"127.0.0.1:$port\"; a port from 1 to 65535" "$run" --telemetry 127.0.0.1:$port --virtual --duration 1
done
for address in 239.1.2.3:9870 255.255.255.255:9870 '[ff02::1]:9870'; do
  refuse 2 "telemetry: .* a group address; allow it with --telemetry-group" "$run" --telemetry "$address" --virtual --duration 1
done

# ---- a folder of output is never replaced in silence ----
before=$(md5sum "$folder/v1/tick.npy")
refuse 2 'v1: holds .* already; --force' "$run" --virtual --duration 1 --record "$folder/v1"
[ "$(md5sum "$folder/v1/tick.npy")" = "$before" ] || fail "a recording was written over"
"$run" --virtual --duration 1 --record "$folder/v2" --force </dev/null >"$folder/out" 2>&1 || fail "--force: $(cat "$folder/out")"
replays "$folder/v2"
[ ! -e "$folder/v2/snapshot.npy" ] || fail "--force leaves an earlier snapshot"
mkdir "$folder/own"
cp "$folder/device.ini" "$folder/own/config.ini"
cp "$folder/wall.scene" "$folder/own"
cp "$folder/own/config.ini" "$folder/before"
(cd "$folder/own" && "$run" --virtual --duration 1 --config config.ini --record . --force </dev/null) >"$folder/out" 2>&1 &&
  fail "recorded over its own configuration"
says "$folder/out" 'the recorded input comes from this folder'
refuse 2 'own: holds files named like those of a recording, but no recording' "$run" --virtual --duration 1 --record "$folder/own" --force
cmp "$folder/own/config.ini" "$folder/before" || fail "the configuration was changed"
# two at once: one records, the other is told
(sleep 2) | "$run" --virtual --duration 1000000 --record "$folder/two" >"$folder/first" 2>&1 &
first=$!
while ! [ -s "$folder/two/events.csv" ]; do sleep 0.02; done
refuse 2 'two: another program is writing there' "$run" --virtual --duration 1 --record "$folder/two"
refuse 2 'two: another program is writing there' "$run" --virtual --duration 1 --record "$folder/two" --force
kill -TERM $first
wait $first 2>/dev/null

# a snapshot that can't be written is no success, and one that stands there stays
echo earlier >"$folder/earlier.npy"
printf 'wait 1\nset limits.speed 0.001\n' >"$folder/faulty"
(ulimit -f 100; exec "$run" --virtual --duration 4 --snapshot "$folder/earlier.npy" <"$folder/faulty") >"$folder/out" 2>"$folder/err"
[ $? = 1 ] || fail "a snapshot that isn't written is a success"
says "$folder/err" 'the snapshot: .*earlier.npy: File too large'
[ "$(cat "$folder/earlier.npy")" = earlier ] || fail "half a snapshot in an earlier one's place"
[ "$(ls "$folder" | grep -c 'npy.*new$')" = 0 ] || fail "left behind: $(ls "$folder")"

# one that only a pipe's reader would let through isn't begun
mkfifo "$folder/pipe"
refuse 2 'snapshot: .*pipe: isn.t a file' "$run" --virtual --duration 1 --snapshot "$folder/pipe"

# ---- a disk that is full: said at once, counted, marked, exit 1 ----
for limit in 1000 1; do
  (ulimit -f $limit; exec "$run" --virtual --duration 5 --record "$folder/full$limit" </dev/null) >"$folder/out" 2>"$folder/err"
  code=$?
  [ $code = 1 ] || [ $limit = 1 ] || fail "a full disk: exit $code"
  [ $code -lt 128 ] || fail "a full disk ends the program: $code"
  grep -q "full$limit.*: File too large" "$folder/err" || fail "a full disk: $(cat "$folder/err")"
done
says "$folder/err" 'File too large'
(ulimit -f 1000; exec "$run" --virtual --duration 5 --record "$folder/full" </dev/null) >"$folder/out" 2>"$folder/err"
says "$folder/err" 'full/tick.npy: File too large; ticks from [0-9]* on are lost$'
whole=$(sed -n 's/.*ticks from \([0-9]*\) on.*/\1/p;' "$folder/err" | head -n 1)
says "$folder/out" "^recorded  *.*full: $whole of [0-9]* ticks, [0-9]* are lost\$"
says "$folder/full/events.csv" "^$whole,fault,the recorder lost rows: File too large\$"
$verify "$folder/full" >"$folder/verify" 2>&1
[ $? = 1 ] || fail "half a recording counts as whole"
says "$folder/verify" "full: $whole ticks, equal to the bit, but the recording was never closed"
replays "$folder/v1"
refuse 2 'cpu: found "x"' "$run" --cpu x
refuse 2 'early_wake' "$run" --early-wake 900 --duration 1

# ---- a device that doesn't start: which device, which step ----
echo '0 start fail' >"$folder/start.inject"
printf '[device]\ndriver = sim\ninject = start.inject\n' >"$folder/start.ini"
"$run" --config "$folder/start.ini" --virtual --duration 1 </dev/null >"$folder/out" 2>"$folder/err"
[ $? = 1 ] || fail "a device that doesn't start: exit 0"
says "$folder/err" '^ethd-run: device sim: start: the device refused or failed$'

# ---- what is missing, and which step comes next: a device without a finger doesn't enable in silence ----
printf '[device]\ndriver = hello\n' >"$folder/blind.ini"
"$run" --config "$folder/blind.ini" --duration 0.3 </dev/null >"$folder/blind" 2>&1 || fail "hello: $(cat "$folder/blind")"
says "$folder/blind" '^device: no sensor measures the finger, so the ring stands still' '^next: step [16] of "From the box to the first touch" in drivers/README.md' \
  '^finger  *never measured'
"$run" --duration 0.3 </dev/null >"$folder/sees" 2>&1 || fail "sim: $(cat "$folder/sees")"
grep -q -e 'measures the finger' -e '^finger' -e '^next' "$folder/sees" && fail "the simulated device has a finger: $(cat "$folder/sees")"

[ $failed = 0 ] && echo "$(grep -c . "$folder/v1/events.csv") events replayed; $(cat "$folder/verify")"
exit $failed
