"""The whole device's run, and what came of it.

whole_device.py run ETHD_RUN FOLDER SECONDS    commands: each strategy rules so long, enabled
whole_device.py study ETHD_STUDY FOLDER          a study on the same device, acknowledging what a busy machine trips
whole_device.py judge RECORDING ETHD_TAP       taps by strategy, beside those of the simulated device
The last two exit with 77 if they didn't come to their end.
"""
import csv
import subprocess
import sys
import tempfile
import time

import numpy as np

LAWS = ("offset", "smooth", "abrupt")
PATIENCE = 30  # s a strategy
ACKNOWLEDGED = 30  # times in a study
RETURN = 500  # ticks until a ring that had no torque is back at the finger, and out of the wall
BEHIND = 0.006  # m that a ring under torque may be behind the wall's surface


def run(program, folder, seconds):
    command = [program, "--config", folder + "/device.ini", "--record", folder + "/rec"]
    device = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=open(folder + "/err", "w"), text=True)
    log = open(folder + "/out", "w")

    def ask(line):
        device.stdin.write(line + "\n")
        device.stdin.flush()
        answer = device.stdout.readline()
        log.write(answer)
        assert answer, "ethd-run has ended"
        return answer

    trips = 0
    for law in LAWS:
        assert ask("transition " + law).startswith("ok")
        enabled, begin = 0.0, time.monotonic()
        while enabled < seconds and time.monotonic() - begin < PATIENCE:
            last = time.monotonic()
            time.sleep(0.2)
            if ", enabled," in ask("status"):
                enabled += time.monotonic() - last
                continue
            trips += 1
            for _ in range(40):
                time.sleep(0.3)
                if ask("ack").startswith("ok") and ask("enable").startswith("ok"):
                    break
    ask("stop")
    log.write(device.communicate()[0])
    print(f"enabled again {trips} times")
    sys.exit(device.returncode)


def study(program, folder):
    with open(folder + "/people.study", "w") as file:
        file.write("[study]\nparticipants = 1\nstrategies = offset,smooth\nspeeds = 0.4\ntraining = 0\ntaps = 1\n"
                   "attempts = 6\n[device]\nconfig = device.ini\n[hand]\nsource = people\n")
    command = [program, folder + "/people.study", "--out", folder + "/study", "--ask"]
    acknowledged = 0
    feed = open(folder + "/feed.in", "w")
    print("out", file=feed, flush=True)  # a ring is opened empty
    session = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=open(folder + "/study.err", "w"), text=True)
    for line in session.stdout:
        print("study:", line.rstrip())
        print("in", file=feed, flush=True)
        if "ack goes on" in line:
            acknowledged += 1
            session.stdin.write("ack\n" if acknowledged < ACKNOWLEDGED else "stop\n")
            session.stdin.flush()
    if acknowledged >= ACKNOWLEDGED:
        print("stopped after", acknowledged, "times")
        sys.exit(77)
    sys.exit(session.wait())


def taps_of(r, events):
    """(speed as the ring meets the wall, first rebound, offset, Delta_s) by strategy."""
    changes = [(int(e["row"]), e["detail"]) for e in events if e["kind"] == "transition"]
    state, x, wall = r["state"], -r["x"][:, 0], -0.25
    taps = {law: [] for law in LAWS}
    for k in np.flatnonzero((state[1:] == 2) & (state[:-1] != 2)) + 1:
        law = [name for row, name in changes if row <= k][-1]
        near = slice(max(k - 100, 0), min(k + 150, len(r)))
        meets = near.start + np.flatnonzero(x[near] >= wall)
        if not len(meets) or np.any(r["fault"][near]):
            continue
        peak = k + int(np.argmax(x[k:near.stop]))
        braking = k
        while state[braking - 1] == 1:
            braking -= 1
        delta = 1e-6 * (r["time_ns"][k] - r["time_ns"][braking]) if law == "offset" else np.nan
        eps = r["eps"][k] if law == "offset" else np.nan
        taps[law].append((-r["v"][meets[0], 0], x[peak] - x[peak:near.stop].min(), eps, delta))
    return taps


def simulated(tap):
    taps = {law: [] for law in LAWS}
    with tempfile.NamedTemporaryFile(suffix=".csv") as out:
        arguments = [tap, "--transition", ",".join(LAWS), "--speed", "0.4", "--taps", "30", "--csv", out.name]
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)
        for row in csv.DictReader(open(out.name)):
            values = [float(row[c] or "nan") for c in ("v_rvo_mps", "d_max_m", "eps_m", "delta_s_ms")]
            if values[0] == values[0]:
                taps[row["transition"]].append(values)
    return taps


def mean(rows):
    a = np.array(rows).reshape(-1, 4)
    return [c[~np.isnan(c)].mean() if np.any(~np.isnan(c)) else float("nan") for c in a.T]


def under_torque(r, events):
    """Ticks of an enabled device without a fault, whose row alone holds the law's torque of a disabled one, too; for
    RETURN ticks."""
    enabled = np.ones(len(r), bool)
    for e in events:
        if e["kind"] in ("start", "fault"):
            enabled[int(e["row"]):] = e["kind"] == "start"
    let_go = ~enabled | (r["fault"] != 0) | ~np.any(r["tau"], axis=1)
    return np.convolve(let_go, np.ones(RETURN))[:len(r)] < 0.5


def judge(folder, tap):
    r = np.load(folder + "/tick.npy")
    events = list(csv.DictReader(open(folder + "/events.csv")))
    taps, alone, held = taps_of(r, events), simulated(tap), under_torque(r, events)
    frames = int(np.sum(r["have"] & 16 != 0))
    print("strategy   n  speed at the wall m/s  first rebound mm  offset mm  Delta_s ms   (through the buses | simulated device alone)")
    for law in LAWS:
        a, b = mean(taps[law]), mean(alone[law])
        print(f"{law:8} {len(taps[law]):3}  {a[0]:9.3f} | {b[0]:.3f}     {1e3 * a[1]:9.3f} | {1e3 * b[1]:.3f}   "
              f"{1e3 * a[2]:8.3f} | {1e3 * b[2]:.3f}  {a[3]:6.2f} | {b[3]:.2f}")
    print(f"{len(r)} ticks, {frames} frames of rays, torque at most {np.abs(r['tau']).max():.3f} Nm")
    assert frames > 0.1 * len(r), "few frames of rays"
    behind = 0.25 - r["x"][held, 0]
    print(f"{np.sum(held)} ticks under torque for {RETURN} ticks, at most {1e3 * behind.max(initial=-np.inf):.1f} mm behind the wall")
    assert np.all(behind < BEHIND), "the ring went through the wall"
    if not (all(taps.values()) and held.any()):
        print("not every strategy has tapped under torque")
        sys.exit(77)


if sys.argv[1] == "run":
    run(sys.argv[2], sys.argv[3], float(sys.argv[4]))
if sys.argv[1] == "study":
    study(sys.argv[2], sys.argv[3])
judge(sys.argv[2], sys.argv[3])
