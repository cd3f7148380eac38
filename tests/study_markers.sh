#!/bin/sh
# A study's markers by UDP, beside a receiver of Python's own sockets: each trial of taps.csv, its begin, touch and end; a
# port that nobody listens at. No time is asserted but the tick's.
. tests/begin.sh
study=$BUILD/bin/ethd-study

cat >"$folder/receive.py" <<'END'
import socket, subprocess, sys, threading
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
s.bind(("127.0.0.1", 0))
s.settimeout(0.5)
name, words, *command = sys.argv[1:]
to = f"127.0.0.1:{s.getsockname()[1]}"
run = subprocess.Popen([a.replace("STUDY", name).replace("TO", to) for a in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
while words and "tap " not in run.stdout.readline(): pass
run.stdin.write(words.replace("|", "\n")), run.stdin.close()
threading.Thread(target=run.stdout.read).start()
while True:
    try: print(s.recv(4096).decode(), end="")
    except TimeoutError:
        if run.poll() is not None: sys.exit(run.returncode)
END
cat >"$folder/judge.py" <<'END'
import collections, csv, sys
markers = [line.split(" ") for line in open(sys.argv[1]).read().splitlines()]
assert all(len(m) == 9 for m in markers), markers
taps = {(t["participant"], t["block"], t["attempt"]): t for t in csv.DictReader(open(sys.argv[2] + "/taps.csv"))}
count = collections.Counter(m[0] for m in markers)
begun, touches = {}, 0
for event, who, block, trial, part, strategy, speed, time, reason in markers:
    tap = taps.get((who, block, trial))
    if event == "block-begin":
        assert trial == "0"
        continue
    assert (part, strategy, speed) == (tap["part"], tap["transition"], tap["speed"]), (event, tap)
    if event == "trial-begin": begun[who, block, trial] = float(time)
    if event == "trial-end": assert reason == tap["reason"], (reason, tap)
    if event == "contact" and tap["valid"] == "1":
        touches += 1
        assert abs(float(time) - begun[who, block, trial] - float(tap["t_of_s"])) < 2e-9, tap
blocks = {t[:2] for t in taps}
assert set(begun) == set(taps) and count["trial-begin"] == count["trial-end"] == len(taps), count
assert count["block-begin"] >= len(blocks) and count["block-begin"] == count["block-end"], count
assert touches == sum(t["valid"] == "1" for t in taps.values()) > 0, touches
first = [m[0] for m in markers if m[1] == "P01" and m[2] == "1"]
assert first[:2] == ["block-begin", "trial-begin"] and first[-1] == "block-end", first
assert (count["reject"], count["accept"], count["uncheck"]) == tuple(map(int, sys.argv[3].split(","))), count
END
python3=${PYTHON:-python3}
receive() { # NAME WORDS STUDY CHECKED OPTIONS..
  name=$1 words=$2 file=$3 checked=$4
  shift 4
  "$python3" "$folder/receive.py" "$folder/$file" "$words" "$study" STUDY --markers TO --out "$folder/$name" "$@" >"$folder/$name.txt" 2>"$folder/err" || fail "$name: $(cat "$folder/err")"
  "$python3" "$folder/judge.py" "$folder/$name.txt" "$folder/$name" "$checked" >"$folder/out" 2>&1 || fail "$name: $(tail -n 3 "$folder/out") $(head -n 8 "$folder/$name.txt")"
}

# ---- simulated hands, a tap rejected and accepted again; people's on a virtual clock ----
printf '[study]\nparticipants = 2\nspeeds = low\ntraining = 1\ntaps = 60\nattempts = 70\nrecord = none\n[validity]\nband_low = 0.19\n' >"$folder/desk.study"
receive desk 'pause|reject the hand slipped|undo|accept well|undo|reject it did|go|' desk.study 2,1,2 --ask
cp apps/config/wall.scene "$folder"
sed 's/^start = .*/start = 0.08/' apps/config/n.plant >"$folder/far.plant"
{ sed '/^\[device\]/,$d' apps/config/n.ini && printf '[device]\ndriver = sim\nspeed = 0.2\nplant = far.plant\n'; } >"$folder/device.ini"
printf '[study]\nparticipants = 1\nspeeds = 0.2\ntraining = 1\ntaps = 1\nattempts = 3\n[device]\nconfig = device.ini\n[hand]\nsource = people\n' >"$folder/people.study"
receive people '' people.study 0,0,0 --virtual --quiet

# ---- nobody listens: the study goes on, and says so once ----
printf '[study]\nparticipants = 1\ntraining = 0\ntaps = 2\n' >"$folder/closed.study"
"$study" "$folder/closed.study" --markers 127.0.0.1:9 --quiet --out "$folder/closed" >"$folder/out" 2>"$folder/err" || fail "a closed port: $(cat "$folder/err")"
[ "$(wc -l <"$folder/err")" = 1 ] && grep -q ': --markers: 127.0.0.1:9: Connection refused; markers are lost, and the study goes on' "$folder/err" ||
  fail "a closed port: $(cat "$folder/err")"
"$study" "$folder/closed.study" --quiet --out "$folder/without" >"$folder/out" 2>&1 || fail "without markers: $(cat "$folder/out")"
cmp "$folder/without/taps.csv" "$folder/closed/taps.csv" || fail "markers change the taps"

# ---- the address is no part of the study: it is another one on resume, or none ----
cmp "$folder/without/versions.txt" "$folder/closed/versions.txt" || fail "markers change the study's hash"
for to in '' '--markers 127.0.0.1:10'; do
  "$study" --resume "$folder/closed" $to >"$folder/out" 2>&1 || fail "resume with \"$to\": $(cat "$folder/out")"
done

# ---- places that can't be ----
kept=$folder/bad
for to in nowhere 127.0.0.1: 127.0.0.1:0 127.0.0.1:70000 'no..where:5000'; do
  refuse 2 ": --markers: .*${to%%:*}" "$study" "$folder/closed.study" --markers "$to" --out "$folder/bad"
done
[ $failed = 0 ] && echo "$(cat "$folder/desk.txt" "$folder/people.txt" | wc -l) markers"
exit $failed
