#!/bin/sh
# ethd-study --screen under Xvfb: a recorded finger moves the mouse, and keys do the rest. How well it taps isn't asserted.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: the window's libraries aren't made for sanitizers"; exit 77; }
study=$BUILD/bin/ethd-study

# ---- without a display, without a font: one line, nothing begun is lost ----
refuse 1 'no display' env -u DISPLAY -u WAYLAND_DISPLAY SDL_VIDEODRIVER=x11 "$study" --out "$folder/none" --screen
refuse 1 'no display' env -u DISPLAY -u WAYLAND_DISPLAY -u SDL_VIDEODRIVER -u XDG_RUNTIME_DIR timeout 20 "$study" --resume "$folder/none" --screen
refuse 1 'fonts-dejavu-core' env ETHD_FONT=/nowhere SDL_VIDEODRIVER=dummy "$study" --resume "$folder/none" --screen
refuse 2 'from 320x200' "$study" --out "$folder/x" --screen=9x9

[ $failed = 0 ] || exit 1
python3=$(sh .ci/setup python) || { echo "FAILED: no python3 with numpy, which .ci/setup check brings"; exit 1; }
. tests/peers/display.sh

cat >"$folder/short.study" <<'EOF2'
[study]
participants = 1
strategies = smooth,offset
speeds = low
training = 0
taps = 1
attempts = 2
survey = on
rest = 1
[survey]
q1 = Wie war's?
q1_answers = gut | mittel | schlecht | übel
q2 = Where did the wall stand?
q3 = How sure are you?
[pages]
consent1 = Sie nehmen freiwillig teil.
instruction1 = Tippen Sie einmal an die grüne Wand.
EOF2
cat >"$folder/drive.py" <<'EOF2'
import csv, glob, os, subprocess, sys, time
sys.path.insert(0, "tests")
from study_whole import Hand, ask, count
study, folder = sys.argv[1:]
session = folder + "/session"
run = subprocess.Popen([study, folder + "/short.study", "--out", session, "--screen"],
                       stdout=subprocess.PIPE, stderr=open(folder + "/err", "w"), text=True)
line = run.stdout.readline()
hand = Hand(line)
hand.pause = 0.15

# a recorded finger, shifted so that it comes to the wall and waits at the start line until it gets there
files = sorted(glob.glob(os.environ["ETHD_MOTION_DIR"] + "/**/*.csv", recursive=True))
finger = []
for name in files:
    rows = list(csv.DictReader(open(name)))
    if rows and {"t_s", "x_m", "y_m"} <= rows[0].keys():
        t, x, y = ([float(r[k]) for r in rows] for k in ("t_s", "x_m", "y_m"))
        if x[0] - min(x) > 0.1:
            finger = [(a - t[0], b, c) for a, b, c in zip(t, x, y)]
            break
if not finger:
    run.kill()
    sys.exit("no recorded movements in " + os.environ["ETHD_MOTION_DIR"])
last, at = min(x for _, x, _ in finger), finger[[x for _, x, _ in finger].index(min(x for _, x, _ in finger))][2]

# Where the machine grants realtime priority, a tap's thread has it.
granted = subprocess.run(["chrt", "-f", "1", "true"], stderr=subprocess.DEVNULL).returncode == 0
policies = set()

def look_at_threads():
    for stat in glob.glob(f"/proc/{run.pid}/task/*/stat"):
        try: policies.add(int(open(stat).read().rsplit(")", 1)[1].split()[38]))
        except OSError: pass

def tap():
    hand.move(hand.start)
    time.sleep(1.2)
    look_at_threads()
    begin = time.monotonic()
    for t, x, y in finger[::4]:
        x, y = x - last + hand.wall - 0.004, y - at + hand.middle
        if x > hand.start:
            begin = time.monotonic() - t
            continue
        while time.monotonic() - begin < t: time.sleep(0.001)
        hand.move(min(x, hand.start), y)
    time.sleep(1.0)

def surveyed(before):
    """The questions come as soon as a tap was valid or the second was done: answered, gone back to, confirmed."""
    mine = ask(session, f"select valid from tap where block = {before + 1} order by id")
    if not (mine and (mine[-1][0] == 1 or len(mine) == 2)): return False
    time.sleep(0.5)
    hand.keys("space 4 4 Return 2 Return BackSpace 3 Return 5 1 5 Return")
    assert count(session, "survey") == before, "three answers without a confirmation"
    hand.keys("Return")
    return True

# Consent, instruction. No key but its own goes on from the first.
hand.keys("space Return y space")

# A tap that doesn't begin doesn't count: a pause at the start line, a stop of the hand that lasts longer than a tap.
hand.keys("space")
hand.move(hand.start); time.sleep(1.2); hand.keys("p"); hand.keys("space")
time.sleep(6.5)
assert count(session, "tap") == 0
assert ask(session, "select 1 from event where event = 'pause'")
hand.keys("p")

for _ in range(2):
    hand.keys("space")                     # the block's page, or the pause
    before = count(session, "survey")
    for _ in range(1):
        # Before the tap: one that is valid is followed by the questions at once.
        hand.move(hand.start); time.sleep(0.5)
        hand.keys("n"); hand.say('type --delay 1 "no letter of this is lost"'); time.sleep(0.4); hand.keys("Return")
        tap()
        if count(session, "tap") and not ask(session, f"select 1 from answer where block = {before + 1}"): hand.keys("p"); hand.keys("space")
    deadline = time.monotonic() + 60
    while not surveyed(before) and time.monotonic() < deadline and run.poll() is None: tap()
deadline = time.monotonic() + 20
while run.poll() is None and time.monotonic() < deadline: hand.keys("space")
out = line + run.stdout.read()
assert run.wait(20) == 0, (run.returncode, open(folder + "/err").read(), out)
assert "frames" in out and "ethd-report" in out, out
assert not granted or os.SCHED_FIFO in policies, policies
assert count(session, "survey") == 2 and 2 <= count(session, "tap") <= 4, ask(session, "select * from tap")
print(out.splitlines()[1])
EOF2
"$python3" -B "$folder/drive.py" "$study" "$folder" >"$folder/out" 2>&1
code=$?
cat "$folder/out"
[ $code = 0 ] || fail "the session: $(cat "$folder/err")"
grep -q '^P1\|^P01' "$folder/session/taps.csv" || fail "no tap in its table"
grep -q ',note,no letter of this is lost$' "$folder/session/events.csv" || fail "no note: $(cat "$folder/session/events.csv")"
[ "$(grep -c ',4,3,5$' "$folder/session/survey.csv")" = 2 ] || fail "no answer: $(cat "$folder/session/survey.csv")"
grep -q ',P01,,,consent,$' "$folder/session/events.csv" || fail "no consent: $(cat "$folder/session/events.csv")"
grep -q 'window 1280 x 720 px; display 1280 x 720 px' "$folder/session/events.csv" || fail "no screen: $(cat "$folder/session/events.csv")"
grep -q 'übel' "$folder/session/survey.json" || fail "the survey's sidecar: $(cat "$folder/session/survey.json")"
awk -F, 'NR > 1 && ($26 != "mouse" || $28 !~ /^20/)' "$folder/session/taps.csv" | grep . && fail "taps without their hand and time"
"$study" --verify "$folder/session" >"$folder/out" 2>&1 || fail "sums: $(cat "$folder/out")"
# Without the screen nobody's hand goes on but the mouse's.
refuse 2 'led by a mouse hand; ethd-study --resume .*/session --screen goes on' "$study" --resume "$folder/session"
for tap in "$folder"/session/taps/*/; do
  "$BUILD/bin/ethd-replay" --verify "$tap" >"$folder/verify" 2>&1 || fail "$tap: $(cat "$folder/verify")"
done

# A text of several pages: it is agreed to on its last one, and nothing before is skipped.
{ printf '[study]\nparticipants = 1\ntaps = 1\n[hand]\nsource = mouse\n[pages]\nconsent1 = '; for i in $(seq 700); do printf 'Sie nehmen freiwillig teil ; das ist Satz %d. ' "$i"; done; echo; } >"$folder/read.study"
timeout 60 "$study" "$folder/read.study" --out "$folder/read" --screen=640x480 >"$folder/out" 2>"$folder/err" &
run=$!
press() { for name; do xdotool key "$name"; sleep 0.15; done; }
agreed() { "$python3" -c 'import sqlite3, sys; sys.exit(not sqlite3.connect(f"file:{sys.argv[1]}?immutable=1", uri=True).execute("select 1 from event where event = ?", ["consent"]).fetchone())' "$folder/read/study.sqlite" 2>/dev/null; }
for _ in $(seq 100); do grep -q '^screen' "$folder/out" && break; sleep 0.1; done
press y space y BackSpace y
agreed && fail "agreed on a page before the last"
for _ in $(seq 40); do press space; done
press y
agreed || fail "not agreed on the last page"
press Escape
wait $run

# How long frames take is said for any size; it is judged by nobody here.
sh tests/stress/frames.sh 640x400 1 >"$folder/out" 2>&1
grep -Eq '^frames 640x400 p50 +[0-9.]+ +p99 +[0-9.]+ +max +[0-9.]+ ms, [0-9]+ shown, [0-9]+ late ticks$' "$folder/out" ||
  fail "tests/stress/frames.sh: $(cat "$folder/out")"
exit $failed
