#!/bin/sh
# "From the box to the first touch, with an arm" (drivers/README.md), as it stands there: every command runs, in one folder, and every
# line that the page promises comes; in the last, the plate as it is commanded stands at the wall when the finger comes to it.
. tests/begin.sh
export ETHD_DATA_DIR="$PWD/$BUILD/share/ethd" PATH="$PWD/$BUILD/bin:$PATH"
case $BUILD in /*) export ETHD_DATA_DIR="$BUILD/share/ethd" PATH="$BUILD/bin:$PATH" ;; esac
"$PYTHON" - "$folder" "$PYTHON" <<'END' || fail "a step"
import re, subprocess, sys
import numpy as np

folder, python = sys.argv[1:]
page = open("drivers/README.md").read().split("\n## From the box to the first touch, with an arm\n")[1].split("\n## ")[0]
steps = re.split(r"^### ", page, flags=re.M)[1:]
ran = 0
for step in steps:
    commands = "".join(re.findall(r"^```sh\n(.*?)^```$", step, re.M | re.S)).replace("python3 -c", f"{python} -c")
    promises = "".join(re.findall(r"^```text\n(.*?)^```$", step, re.M | re.S)).splitlines()
    said = subprocess.run(["sh", "-e", "-c", commands], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    lines = [re.sub(" +", " ", line).strip() for line in said.stdout.splitlines()]
    wanted = [".*".join(re.escape(re.sub(" +", " ", part).strip()) for part in promise.split("...")) for promise in promises]
    missing = [w for w in wanted if not any(re.match(w, line) for line in lines)]
    if said.returncode or missing:
        sys.exit(f"{step.splitlines()[0]}: exit {said.returncode}, no {missing} in:\n{said.stdout}")
    ran += bool(commands)
ticks, n = np.load(f"{folder}/lab/first/tick.npy"), np.array([0.96, 0, -0.28])  # ur5e.solids
touch = ticks[np.argmax((ticks["x"] - ticks["xf"]) @ n <= 0.008)]
offset, speed = touch["x"] @ n + 0.514, touch["v"] @ n
print(f"{len(steps)} steps, {ran} with commands; felt {1e3 * offset:.4f} mm beyond the wall, plate {1e3 * speed:.4f} mm/s")
sys.exit(not (len(steps) == 8 and ran == 7 and abs(offset) < 1e-4 and abs(speed) < 1e-3))
END
exit $failed
