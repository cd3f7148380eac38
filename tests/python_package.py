"""The Python package against recordings, golden taps and the programs: python_package.py BUILD FOLDER."""
import gc
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import numpy.lib.recfunctions
from python_help import build, folder, refuses, tree, write

import ethd
from ethd_programs.recording import fields_of
from ethd_programs.table import lines

rng = np.random.default_rng(7)

# ---- recordings: every row of every law, events and faults included, equal to the bit ----
taps = folder + "/taps"
tap = [build + "/bin/ethd-tap", "--taps", "2", "--seed", "5", "--record", taps]
subprocess.run(tap, check=True, stdout=subprocess.DEVNULL)
r = ethd.read(taps)
assert r.tick["tau"].shape == (len(r.tick), 2) and r.truth["ring"].shape == (len(r.truth), 2)
assert len(r.truth) == len(r.tick) and len(r.taps) >= 12 and set(r.taps["transition"]) >= {"abrupt", "smooth", "offset"}
assert r.config["transition"]["law"] == "offset" and r.events[0].kind == "setup" and "equal to the bit" in r.verify()
rows = 0
for row, step in r.replay():
    assert step.trace.tobytes() == row.tobytes(), rows
    assert step.tau.tobytes() == row["tau"].tobytes() and step.status <= 0
    rows += 1
assert rows == len(r.tick) > 2000
first = next(e.row for e in r.events if e.row > 0)
c = r.controller()
taus = np.array([c.step(row).tau for row in r.tick[:first]])
assert np.array_equal(taus, r.tick["tau"][:first]) and np.abs(taus).max() > 0.1
# a controller of another gain doesn't give the same: the comparison can fail
c = r.controller()
c.post({"tracking.k_t": 35})
assert not np.array_equal([c.step(row).tau for row in r.tick[:first]], r.tick["tau"][:first])

# a run with commands, swaps and a set while it runs
ini = folder + "/run.ini"
with open(build + "/share/ethd/n.ini") as file, open(ini, "w") as out:
    out.write(file.read())
with open(build + "/share/ethd/wall.scene") as file, open(folder + "/wall.scene", "w") as out:
    out.write(file.read())
script = "wait 0.4\nset transition.b_d 90\nset transition.v_th 0.03\nwait 0.3\ntransition smooth\nwait 0.2\nset contact.k_e 900\nwait 0.3\ntransition abrupt\nwait 0.2\nstop\n"
subprocess.run([build + "/bin/ethd-run", "--virtual", "--duration", "20", "--config", ini, "--record", folder + "/run"],
               input=script, text=True, check=True, stdout=subprocess.DEVNULL)
r = ethd.read(folder + "/run")
assert {"transition", "set"} <= {e.kind for e in r.events} and r.taps is None and r.truth is None
assert all(step.trace.tobytes() == row.tobytes() for row, step in r.replay())

# what was set of the recorded law is set of the one in its place, if that has a parameter of this name
values = set()


@ethd.transition_law("braked", b_d=(60, 0, 1000, "Ns/m"), other=(1, 0, 2, "1"))
def braked(p, state, contact, out):
    values.add((p["b_d"], p["other"]))
    out.beta = out.share = 1


assert len(list(r.replay(braked))) == len(r.tick) and (90, 1) in values and len(values) > 1

# what was learned in ticks that aren't there nobody knows: such a recording is read, and not replayed from there on
subprocess.run([build + "/bin/ethd-run", "--virtual", "--duration", "1", "--record-every", "10", "--config", ini, "--record",
                folder + "/thin"], input="stop\n", text=True, check=True, stdout=subprocess.DEVNULL)
thin = ethd.read(folder + "/thin")
assert len(thin.tick) > 2 and "thinned" in {e.kind for e in thin.events}
refuses("thin: from tick 0 on it can't be replayed: 1 tick of 10 is recorded", thin.controller)
refuses("thin: from tick 0 on it can't be replayed: 1 tick of 10 is recorded", lambda: next(thin.replay()))


def changed(name, old, new, of="run"):
    """A copy of a recording with some of events.csv replaced."""
    subprocess.run(["cp", "-r", folder + "/" + of, folder + "/" + name], check=True)
    with open(folder + "/" + of + "/events.csv") as file:
        lines = file.read()
    assert old in lines
    write(name + "/events.csv", lines.replace(old, new, 1))
    return ethd.read(folder + "/" + name)


swap = next(e.row for e in r.events if e.kind == "transition")
lost = changed("lost", f"{swap},transition,", f"{swap},lost,3 ticks before this one found no room\n{swap},transition,")
steps, lost_steps = lost.replay(), []
refuses(f"lost: from tick {swap} on it can't be replayed: 3 ticks", lambda: lost_steps.extend(iter(lambda: next(steps), None)))
# what the law has learned before begins with the recording
subprocess.run([*tap[:-1], folder + "/ahead", "--transition", "predictive"], check=True, stdout=subprocess.DEVNULL)
taught = changed("taught", "row,kind,detail\n", "row,kind,detail\n0,learned,0.125 0 0.25 0\n", "ahead")
assert taught.controller().step(taught.tick[0]).trace["learnt"].tolist() == [0.125, 0, 0.25, 0]
refuses("learnt[0]: recorded 0, replayed 0.125", taught.verify)
refuses("learned: found '1 2', 4 numbers are allowed", changed("taught2", "kind,detail\n", "kind,detail\n0,learned,1 2\n").controller, ValueError)
refuses("found the kind 'jump'", changed("jump", "kind,detail\n", "kind,detail\n0,jump,1\n").controller, ValueError)
refuses("heat: found 'a b', 2 numbers", changed("h", "kind,detail\n", "kind,detail\n0,heat,a b\n").controller, ValueError)
refuses('contact.k_e: found ""', changed("bare", "kind,detail\n", "kind,detail\n0,set,contact.k_e\n").controller)
refuses("row: found 0, 9 or more", lambda: changed("order", "kind,detail\n", "kind,detail\n9,clear,\n"), ValueError)
os.remove(changed("silent", "row", "row").folder + "/events.csv")
refuses("silent/events.csv: No such file, so what happened is unknown", ethd.read(folder + "/silent").controller, FileNotFoundError)
refuses("events.csv:2: row,kind,detail are allowed", lambda: changed("odd_row", "kind,detail\n", "kind,detail\n,set,1\n"), ValueError)

# rows of other columns aren't taken for these, and objects aren't unpickled
whole, odd = r.tick, folder + "/odd"
subprocess.run(["cp", "-r", folder + "/run", odd], check=True)
np.save(odd + "/tick.npy", whole[[name for name in whole.dtype.names if name != "guard"]])
assert len(ethd.read(odd).tick) == len(whole)
refuses("other columns than those of this version", lambda: next(ethd.read(odd).replay()), ValueError)
refuses("other columns than those of this version", lambda: ethd.read(odd).controller(), ValueError)
np.save(odd + "/tick.npy", np.array([print], object))
refuses("odd/tick.npy: no array", lambda: ethd.read(odd), ValueError)
write("odd/tick.npy", "")
refuses("odd/tick.npy: no array, or cut short", lambda: ethd.read(odd), ValueError)
np.save(odd + "/tick.npy", whole)
os.truncate(odd + "/tick.npy", 5000)
refuses("odd/tick.npy: no array, or cut short", lambda: ethd.read(odd), ValueError)
np.save(odd + "/tick.npy", whole)
with open(odd + "/config.ini", "ab") as file:
    file.write(b"; \xff\n")
refuses("config.ini:", lambda: ethd.read(odd), ValueError)
write("odd/config.ini", "k = 1\n")
refuses("odd/config.ini: File contains no section headers", lambda: ethd.read(odd), ValueError)

# a recording of an earlier version lacks columns that were added since, and replays all the same
older = np.lib.recfunctions.repack_fields(whole[[name for name in whole.dtype.names if name not in ("finger_noise", "learnt")]])
shutil.copytree(folder + "/run", folder + "/older")
np.save(folder + "/older/tick.npy", older)
for (row, step), now in zip(ethd.read(folder + "/older").replay(), whole):
    assert "learnt" not in row.dtype.names and step.trace.tobytes() == now.tobytes()
assert "equal to the bit" in ethd.read(folder + "/older").verify()

# ---- in space: taps on solids equal C's traces to the bit, from the recording and from Python's own loop ----
subprocess.run([build + "/tests/space_tap", tree + "/apps/config/space.ini", folder + "/space"], check=True)
s = ethd.read(folder + "/space")
assert isinstance(s, ethd.SpaceRecording) and s.tick.dtype == ethd.SPACE_TRACE and "4000 ticks, equal to the bit" in s.verify()
assert set(s.tick["state"]) == {0, 1, 2} and ethd.SPACE_UNITS["near_point"] == "m"
assert all(step.trace.tobytes() == row.tobytes() for row, step in s.replay())
c, x, v = ethd.Space(tree + "/apps/config/space.ini"), np.array([0.3, 0, 0.3]), np.zeros(3)
sense = np.zeros((), ethd.SPACE_SENSE)
for i, row in enumerate(s.tick):
    sense["time_ns"], sense["have"], sense["x"], sense["v"] = 1000000 * i, 1, x, v
    sense["finger"], sense["finger_v"] = row["finger"], row["finger_v"]  # which C's sin and cos have made
    if i == 2000:
        c.post({"transition.effort": 0.7})
    step = c.step(sense, c.surfaces(x, 0.5))
    assert step.trace.tobytes() == row.tobytes() and step.value.tobytes() == row["command"].tobytes(), i
    v = step.value
    x = x + 1e-3 * v
assert [e.kind for e in c.events()] == ["taken"]
c = ethd.Space()
sense["time_ns"] = 0
assert len(c.surfaces(x, 1)) == 0 and c.step(sense).status == 0
assert c.step(sense, [((0.5, 0, 0), (1, 0, 0), (0, 0, 0), 3, -1)] * 65).safe and c.events()[0].kind == "fault"
refuses("space.radius: found \"-1.0\", 0.0001 to 1 m is allowed", lambda: c.post({"space.radius": -1}))
refuses("there is no [space]", lambda: ethd.Space("[contact]\nk_e = 3\n"))
refuses("[space] is there; ethd.Space is its controller", lambda: ethd.Controller("[space]\n"))
refuses("have: missing in the row; all fields of ethd.SPACE_SENSE", lambda: c.step(sense[["time_ns"]]), ValueError)
refuses("x has the shape (2,)", lambda: c.surfaces((0, 0), 1), ValueError)

# ---- a configuration, changes while it runs, events ----
sense = np.zeros((), ethd.SENSE)
sense["have"], sense["finger"], sense["q"] = 2, (0.26, 0.25), r.tick["q"][0]
c = ethd.Controller("[contact]\nk_e = 500\n[tracking]\nk_t = 30\n")
before = c.step(sense).tau
c.post({"transition.law": "smooth", "tracking.k_t": 60, "transition.swap_time": 0})
refuses("has not taken", lambda: c.post({"tracking.k_t": 50}), ethd.Busy)
after = c.step(sense).tau
assert [e.kind for e in c.events()] == ["taken"] and np.allclose(c.step(sense).tau, 2 * before, rtol=1e-9), (before, after)
refuses("contact.k_e: found \"-3.0\", 0 to 1000000", lambda: c.post({"contact.k_e": -3}))
refuses("not a key of kelvin-voigt", lambda: c.post({"contact.k": 3}))
refuses("contact.law: found 'rubber', kelvin-voigt, spring, ", lambda: c.post({"contact.law": "rubber"}))
refuses("/nowhere.ini: No such file", lambda: ethd.Controller("/nowhere.ini"))
refuses("configuration:2: contact.k_e", lambda: ethd.Controller("[contact]\nk_e = fast\n"))
with open(folder + "/run/config.ini", "a") as file:
    file.write("\n[plugins]\nfile = somebodys.so\n")
refuses("ethd.read(folder, plugins=True) lets it run", lambda: ethd.read(folder + "/run").controller())
refuses("plug", lambda: ethd.read(folder + "/run").verify())
refuses("somebodys.so", lambda: ethd.read(folder + "/run", plugins=True).controller())

# ---- links, pipes and holes of somebody else's folder ----
shutil.copytree(folder + "/run", folder + "/theirs")
write("secret.ini", "[secret]\n")


def instead(name, make, says, read=lambda: ethd.read(folder + "/theirs")):
    place = os.path.join(folder, "theirs", name)
    os.rename(place, place + ".kept")
    make(place)
    refuses(says, read, ValueError)
    os.remove(place)
    os.rename(place + ".kept", place)


for name in "tick.npy", "events.csv", "config.ini":
    instead(name, lambda place: os.symlink("../secret.ini", place), f"theirs/{name}: is a link, which isn't followed")
    instead(name, os.mkfifo, f"theirs/{name}: is a pipe, a file is needed")
calm_read = lambda: ethd.read(folder + "/theirs").controller()
with open(folder + "/theirs/config.ini", "w") as file:
    file.write("[scene]\nfile = ../secret.ini\n")
refuses("theirs/../secret.ini: leads out of the folder", calm_read)
with open(folder + "/theirs/config.ini", "w") as file:
    file.write("[scene]\nfile = /dev/zero\n")
refuses("/dev/zero leads out of the folder", calm_read)
os.truncate(folder + "/theirs/tick.npy", 8 << 30)
assert len(ethd.read(folder + "/theirs").tick) == len(r.tick)
head = open(folder + "/theirs/tick.npy", "rb").read(8192)
count = re.search(rb"'shape': \(\d+,\), } *", head)
with open(folder + "/theirs/tick.npy", "r+b") as file:
    file.seek(count.start())
    file.write(b"'shape': (4000000,), }".ljust(len(count.group())))
refuses("theirs/tick.npy: no array, or cut short: it has a hole", lambda: ethd.read(folder + "/theirs"), ValueError)
with open(folder + "/theirs/tick.npy", "wb") as file:
    np.save(file, np.array([{}]), allow_pickle=True)
refuses("theirs/tick.npy: no array, or cut short: objects aren't numbers", lambda: ethd.read(folder + "/theirs"), ValueError)
os.truncate(folder + "/theirs/events.csv", 8 << 30)
refuses("theirs/events.csv: 8589934592 bytes, at most", lambda: next(lines(folder + "/theirs/events.csv")), ValueError)
os.truncate(folder + "/theirs/events.csv", 1 << 30)
refuses("theirs/events.csv: has a hole", lambda: next(lines(folder + "/theirs/events.csv")), ValueError)
shutil.rmtree(folder + "/theirs")

# whatever names a plugin, nothing is opened for a controller that is told not to: this one isn't even looked for
theirs = "[plugins]\nfile = somebodys.so\n"
write("theirs.ini", theirs)
calm = ethd.Controller(plugins=False)
for source in theirs, folder + "/theirs.ini":
    refuses("somebodys.so is a program from outside of this folder; plugins=True lets it run", lambda: ethd.Controller(source, plugins=False))
    refuses("somebodys.so is a program from outside of this folder; plugins=True lets it run", lambda: calm.post(source))
    refuses("No such file", lambda: ethd.Controller(source))

# ---- rows: those of SENSE's fields are taken, whatever else they hold; none is read as something that it isn't ----
fields = [(name, ethd.SENSE[name]) for name in ethd.SENSE.names]
packed = np.zeros((), [("mine", "u1"), *fields[::-1]])
for name in ethd.SENSE.names:
    packed[name] = r.tick[0][name]
a, b = ethd.Controller(), ethd.Controller()
assert a.step(packed).trace.tobytes() == b.step(r.tick[0]).trace.tobytes() == ethd.Controller().step(r.tick[:1][0]).trace.tobytes()
refuses("rays: missing in the row", lambda: c.step(np.zeros((), [f for f in fields if f[0] != "rays"])), ValueError)
refuses("time_ns: found >i8, int64 is allowed", lambda: c.step(np.zeros((), ethd.SENSE.newbyteorder(">"))), ValueError)
refuses("q: found ('<f4', (2,)), ('<f8', (2,)) is allowed",
        lambda: c.step(np.zeros((), [(n, ("<f4", (2,)) if n == "q" else t) for n, t in fields])), ValueError)
refuses("the shape (3,); a tick takes one row", lambda: c.step(r.tick[:3]), ValueError)
refuses("found ndarray; a row of", lambda: c.step(np.zeros(600)), TypeError)
refuses("found bytes; a row of", lambda: c.step(bytes(1000)), TypeError)
assert ethd.TRACE == r.tick.dtype and set(ethd.UNITS) == set(ethd.TRACE.names) and ethd.UNITS["dq"] == "rad/s"
for rows_of, units in ((ethd.TRACE, ethd.UNITS), (ethd.SPACE_TRACE, ethd.SPACE_UNITS)):
    assert {f.name: f.unit for f in fields_of(rows_of)} == units  # what ethd-convert derives is the library's
sense["q"] = np.nan
assert c.step(sense).safe and any(e.kind == "fault" and "possible" in e.text for e in c.events())

# ---- a law in Python gives what the same law in C gives ----
known = {law.id: law for law in ethd.laws()}
assert len(known) >= 7 and [p.name for p in known["kelvin-voigt"].params] == ["k_e", "b_e"] and known["pd"].kind == "tracking"
assert known["kelvin-voigt"].params[0].unit == "N/m"


@ethd.contact_law("python-spring", k_e=(2500, 0, 1e6, "N/m"))
def spring(p, state, gap, speed, entering):
    return p["k_e"] * gap if gap < 0 else 0.0


@ethd.transition_law("python-abrupt", state=1)
def abrupt(p, state, contact, out):
    out.state = 2 if contact.d_re < 0 else 0
    out.beta, out.share = 1, 1 if contact.d_re < 0 else 0
    state[0] += 1


@ethd.transition_law("broken")
def broken(p, state, contact, out):
    raise RuntimeError("as it should")


wall = "[scene]\nfile = wall.scene\n"
write("own.ini", wall)
inside = np.zeros((), ethd.SENSE)
inside["have"], inside["finger"] = 2, (0.246, 0.25)
deep = ethd.read(taps).tick
inside["q"] = deep["q"][np.nanargmin(deep["d_re"])]


def torque(law, k_e=2500):
    c = ethd.Controller(folder + "/own.ini")
    c.post({"contact.law": law, "contact.k_e": k_e, "transition.law": "abrupt", "transition.swap_time": 0})
    return [c.step(inside).tau for _ in range(3)][-1]


assert np.array_equal(torque("spring"), torque(spring)) and np.abs(torque(spring)).max() > 0.01
assert not np.array_equal(torque(spring), torque(spring, 1250))
c = ethd.Controller(folder + "/own.ini")
c.post({"transition.law": abrupt})
assert c.step(inside).trace["state"] == 2
refuses("brake: found (60, 0); a number, or (default, least, most, unit)",
        lambda: ethd.transition_law("short", brake=(60, 0))(abrupt), ValueError)
refuses("of transition.law", lambda: c.post({"contact.law": abrupt}))
c.post({"transition.law": broken})
step = c.step(inside)
assert step.safe and step.status == -16 and np.all(step.tau == 0), step

# What a law keeps is its own: it stays as it was, what is written into it later changes nothing, and it outlives the
# controller.
kept, motions = [], []


@ethd.transition_law("keeps", state=2)
def keeps(p, state, contact, out):
    state[0] += 1
    out.beta, out.share, out.state = 1, 1, 2
    kept.append((state, contact, out, (contact.d_re, contact.n.x, contact.object)))


@ethd.tracking_law("keeps-motion", state=1)
def keeps_motion(p, state, motion):
    state[0] += 1
    motions.append((state, motion, tuple(motion.eps_q)))
    return 0.0, 0.0


c = ethd.Controller(folder + "/own.ini")
c.post({"transition.law": keeps, "tracking.law": keeps_motion, "transition.swap_time": 0})
c.step(inside)
kept.clear(), motions.clear()
for i in range(5):
    inside["finger"] = (0.246 + 1e-4 * i, 0.25)
    c.step(inside)
counts = [state[0] for state, *_ in kept]
assert counts == list(range(int(counts[0]), int(counts[0]) + 5)) and len({state[0] for state, *_ in motions}) == 5, counts
assert all((contact.d_re, contact.n.x, contact.object) == said and contact.facts is None for _, contact, _, said in kept)
assert all(tuple(motion.eps_q) == said for _, motion, said in motions) and len({said for *_, said in motions}) == 5
for state, contact, out, _ in kept:
    state[:], contact.d_re, out.beta = 1e300, 7, 1e300
torque_before = c.step(inside).tau
assert kept[-1][0][0] == counts[-1] + 1 and np.isfinite(torque_before).all()
del c
gc.collect()
for state, *_ in kept + motions:
    state[:] = 1e300
inside["finger"] = (0.246, 0.25)

# the law of README.md and the same one in Python, in the same trial: the recording's value for "brake", not the default
opened = folder + "/opened"
source = """#include <stdio.h>
#include <ethd/plugin.h>
static __attribute__((constructor)) void opened(void) { fclose(fopen("%s", "w")); }
static const ethd_param params[] = {{"k_c", "N/m^3", 0, 1e12, 5e7, "force over the cube of the depth"}};
static ethd_status push(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)state, (void)speed, (void)entering;
  *force = gap < 0 ? p[0] * gap * gap * gap : 0;
  return ETHD_OK;
}
static const ethd_contact_law cubic = {
    .law = {sizeof cubic, ETHD_ABI, ETHD_CONTACT, 0, "cubic", "cubic spring", params, 1, NULL, NULL}, .step = push};
""" % opened
with open(tree + "/apps/examples/law.c") as file:
    source += file.read().replace("params", "mine_params").replace("{&mine.law}", "{&mine.law, &cubic.law}").replace("laws, 1}", "laws, 2}")
write("mine.c", source)
subprocess.run([os.environ.get("CC", "cc"), "-shared", "-fPIC", "-I" + tree + "/include", folder + "/mine.c", "-o", folder + "/mine.so"], check=True)
write("mine.ini", "[plugins]\nfile = mine.so\n[transition]\nlaw = mine\nbrake = 80\n")


@ethd.transition_law("python-mine", brake=(60, 0, 1000, "Ns/m"))
def mine(p, state, contact, out):
    within = contact.d_re < 0
    out.beta, out.share, out.damping = (0.1, 1, p["brake"]) if within else (1, 1, 0)
    out.state = ethd.State.VO if within else ethd.State.TRANSPARENT


subprocess.run([build + "/bin/ethd-tap", "--config", folder + "/mine.ini", "--transition", "mine", "--taps", "2", "--speed", "low",
                "--record", folder + "/mine"], check=True, stdout=subprocess.DEVNULL)
os.remove(opened)
calm = ethd.read(folder + "/mine")
refuses("ethd.read(folder, plugins=True) lets it run", lambda: next(calm.replay(mine)))
refuses("plugins=True lets it run", lambda: ethd.Controller(open(folder + "/mine.ini").read(), plugins=False))
assert not os.path.exists(opened)  # nothing of its has run
r = ethd.read(folder + "/mine", plugins=True)
assert all(step.trace.tobytes() == row.tobytes() for row, step in r.replay()) and os.path.exists(opened)
assert all(step.trace.tobytes() == row.tobytes() for row, step in r.replay(mine)) and (r.tick["state"] == ethd.State.VO).sum() > 50
assert not all(step.trace.tobytes() == row.tobytes() for row, step in r.replay(abrupt))
assert not all(step.trace.tobytes() == row.tobytes() for row, step in r.replay(spring))
# a plugin's laws are known by name to the controllers of a configuration that names it
c = ethd.Controller(folder + "/mine.ini")
c.post({"contact.law": "cubic", "contact.k_c": 4e7})
refuses("contact.law: found 'mine', kelvin-voigt, ", lambda: c.post({"contact.law": "mine"}))

# ---- scenes: over arrays, as ethd-scene says ----
text = "circle 0.1 0 0.05\nbox 0.3 0.2 0.05 0.02 0.4\npolygon 0 0.3 0.1 0.3 0.05 0.4\n"
points = rng.uniform(-0.2, 0.5, (40, 50, 2))
near = ethd.Scene(text).nearest(points)
assert near.distance.shape == near.object.shape == (40, 50) and near.normal.shape == (40, 50, 2)
assert np.allclose(np.linalg.norm(near.normal, axis=-1), 1, atol=1e-12)
circle = near.object == 0
assert np.allclose(near.distance[circle], np.hypot(*(points[circle] - (0.1, 0)).T) - 0.05, atol=1e-12) and circle.any()
write("a.scene", text)
np.savetxt(folder + "/points.csv", points.reshape(-1, 2), delimiter=",", header="x_m,y_m", comments="", fmt="%.17g")
subprocess.run([build + "/bin/ethd-scene", "query", "--scene", folder + "/a.scene", "--in", folder + "/points.csv", "--out",
                folder + "/near.csv"], check=True, stdout=subprocess.DEVNULL)
said = np.genfromtxt(folder + "/near.csv", delimiter=",", names=True)
again = ethd.Scene(folder + "/a.scene").nearest(points.reshape(-1, 2))
assert np.array_equal(said["distance_m"], again.distance) and np.array_equal(said["nx"], again.normal[:, 0])
assert np.array_equal(again.distance, near.distance.ravel()) and again.object.max() == 2
refuses("scene:1: nan", lambda: ethd.Scene("circle 0 0 nan"))
refuses("nowhere.scene: No such file", lambda: ethd.Scene("nowhere.scene"), FileNotFoundError)
odd_points = ethd.Scene(text).nearest([[np.nan, 0], [0.1, 0], [0, np.inf]])
assert np.isnan(odd_points.distance[[0, 2]]).all() and np.isnan(odd_points.normal[[0, 2]]).all()
assert odd_points.object.tolist() == [-1, 0, -1] and odd_points.distance[1] == -0.05
refuses("(..., 2) is allowed", lambda: ethd.Scene(text).nearest(np.zeros((3, 3))), ValueError)

# ---- Ctrl-C ends a verification, which would take a minute and more by a law that is slow only now ----
with open(tree + "/apps/examples/law.c") as file:
    law = "#include <stdlib.h>\n#include <unistd.h>\n" + file.read().replace("(void)state;", '(void)state; if (getenv("SLOW")) usleep(500000);')
write("slow.c", law)
subprocess.run([os.environ.get("CC", "cc"), "-shared", "-fPIC", "-I" + tree + "/include", folder + "/slow.c", "-o", folder + "/slow.so"], check=True)
write("wall.scene", "halfplane -1 0 -0.238\n")
write("slow.ini", "[scene]\nfile = wall.scene\n[plugins]\nfile = slow.so\n[transition]\nlaw = mine\n")
subprocess.run([build + "/bin/ethd-run", "--virtual", "--duration", "3", "--config", folder + "/slow.ini", "--record", folder + "/slow"],
               check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
assert (ethd.read(folder + "/slow").tick["object"] >= 0).sum() > 150
interrupted = """
import os, signal, sys, threading
import ethd
threading.Timer(2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    print("not stopped:", ethd.read(sys.argv[1], plugins=True).verify())
except KeyboardInterrupt:
    print("interrupted")
"""
stopped = subprocess.run([sys.executable, "-c", interrupted, folder + "/slow"], env={**os.environ, "SLOW": "1"}, check=True,
                         stdout=subprocess.PIPE, text=True, timeout=60)
assert stopped.stdout == "interrupted\n", stopped.stdout

# ---- a host with a decimal comma, as Qt makes one of matplotlib's: the same controller, the same recordings ----
write("comma.ini", "[tracking]\nk_t = 40.9\nb_t = 1.9\n[contact]\nk_e = 1234.5\n")
hosted = """
import locale, sys
locale.setlocale(locale.LC_ALL, sys.argv[1])
import ethd
r, c = ethd.read(sys.argv[2]), ethd.Controller(sys.argv[3])
c.post({"contact.b_e": 12.25})
print(locale.localeconv()["decimal_point"], [c.step(row).tau.tobytes() for row in r.tick[:150]][-1].hex())
print(all(step.trace.tobytes() == row.tobytes() for row, step in r.replay()), r.verify())
"""
places = subprocess.run(["sh", tree + "/.ci/locales"], env={**os.environ, "BUILD": build}, check=True,
                        stdout=subprocess.PIPE, text=True)
said = [subprocess.run([sys.executable, "-c", hosted, name, taps, folder + "/comma.ini"], check=True, text=True,
                       env={**os.environ, "LOCPATH": places.stdout.strip()}, stdout=subprocess.PIPE).stdout
        for name in ("C", "de_DE.UTF-8")]
assert said[0][0] == "." and said[1][0] == "," and said[0][1:] == said[1][1:] and "\nTrue " in said[0], said
print(f"ethd {ethd.__version__}, numpy {np.__version__}: {rows} rows replayed in Python, equal to the bit")
