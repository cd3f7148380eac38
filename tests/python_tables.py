"""The Python package's tables and studies: python_tables.py BUILD FOLDER."""
import os
import subprocess

import numpy as np
from python_help import build, folder, refuses, write

import ethd
import ethd_programs.table


def run(program, *arguments):
    subprocess.run([build + "/bin/" + program, *arguments], check=True, stdout=subprocess.DEVNULL)


# ---- tables: an empty cell is no number, and none is made up for it; text stays text ----
run("ethd-tap", "--taps", "2", "--seed", "5", "--transition", "abrupt,smooth,offset", "--record", folder + "/three")
whole = ethd.read(folder + "/three").taps
lead, brakes = whole["delta_s_ms"], whole["transition"] == "offset"
assert lead.dtype == np.float64 and np.isnan(lead[~brakes]).all() and (lead[brakes] >= 0).any()
assert whole["seed"].dtype == np.int64 and whole["valid"].dtype == np.int64 and set(whole["valid"]) <= {0, 1}
run("ethd-tap", "--taps", "2", "--seed", "5", "--transition", "abrupt", "--record", folder + "/abrupt")
assert np.isnan(ethd.read(folder + "/abrupt").taps["delta_s_ms"]).all()
cells = 'n,few,big,text,eps_m,none_m,none\n1,4,,"a, # ""b""",0,,\n2,,9007199254740993,,1,,\n'
write("odd_taps.csv", cells)
odd_taps = ethd_programs.table.table(folder + "/odd_taps.csv")
assert odd_taps["n"].tolist() == [1, 2] and odd_taps["n"].dtype == np.int64 and odd_taps["text"].tolist() == ['a, # "b"', ""]
assert odd_taps["few"][0] == 4 and np.isnan(odd_taps["few"][1]) and odd_taps["eps_m"].dtype == np.float64
assert odd_taps["big"].tolist() == ["", "9007199254740993"]  # no float64 is that number
assert np.isnan(odd_taps["none_m"]).all() and odd_taps["none"].tolist() == ["", ""]
with open(folder + "/odd_taps.csv", "a") as out:
    out.write("3,4\n")
refuses("odd_taps.csv:4: found 2 cells, 7 are allowed", lambda: ethd_programs.table.table(folder + "/odd_taps.csv"), ValueError)

# ---- a study: its tables, and each tap's recording, equal to the bit ----
write("a.study", "[study]\nparticipants = 2\nstrategies = smooth,predictive\nspeeds = low\ntraining = 1\ntaps = 1\nattempts = 3\n")
run("ethd-study", folder + "/a.study", "--out", folder + "/study", "--quiet")
study = ethd.read(folder + "/study")
assert isinstance(study, ethd.Study) and study.config["study"]["participants"] == "2"
assert study.participants["participant"].tolist() == ["P01", "P02"] and set(study.taps["transition"]) == {"smooth", "predictive"}
assert np.isnan(study.events["block"]).all()  # of a session's beginning and end
assert study.events["event"].tolist()[0] == "open" and len(study.orders) == 6 and len(study.survey) == 0
trials = list(study.trials())
assert len(trials) == len(study.taps) and (study.taps["part"] == "test").sum() == study.participants["taps"].sum()
for at, trial in trials:
    assert trial.taps.shape == (1,) and trial.taps["seed"][0] == at["seed"] and trial.taps["tap"][0] == at["tap"]
    assert all(step.trace.tobytes() == row.tobytes() for row, step in trial.replay())
assert len(study.trial(study.taps[0]).tick) > 100
subprocess.run(["rm", "-r", trials[0][1].folder], check=True)
assert len(list(study.trials())) == len(trials) - 1
refuses("that tap's ticks aren't there", lambda: study.trial(study.taps[0]), FileNotFoundError)
# a simulation's workers keep their ticks in folders of their own
sim = folder + "/sim"
run("ethd-study", folder + "/a.study", "--simulate", "2", "--ticks", "--shard", "1/2", "--out", sim, "--quiet")
run("ethd-study", folder + "/a.study", "--simulate", "2", "--ticks", "--shard", "2/2", "--out", sim, "--quiet")
refuses("a simulation in shards: ethd-study --merge ", lambda: ethd.read(sim), FileNotFoundError)
run("ethd-study", "--merge", sim)
simulation = ethd.read(sim)
assert simulation.participants is None and len(list(simulation.trials())) == len(simulation.taps) > 4
for at, trial in simulation.trials():
    assert trial.taps["seed"][0] == at["seed"] and trial.taps["tap"][0] == at["tap"]
    assert all(step.trace.tobytes() == row.tobytes() for row, step in trial.replay())
os.makedirs(folder + "/begun", exist_ok=True)
write("begun/study.ini", "")
refuses("no study there that was begun: it has no taps.csv", lambda: ethd.read(folder + "/begun"), FileNotFoundError)
refuses("no recording there, which has a tick.npy, and no study", lambda: ethd.read(folder), FileNotFoundError)
print(f"{len(trials)} taps of a study replayed in Python, equal to the bit")
