#!/bin/sh
# People who lack one kind of cones can tell the meaningful colours of a report's pictures apart: each colour is turned into
# what these people see (Machado, Oliveira and Fernandes 2009, severity 1), and compared in CIE L*a*b*.
exec "${PYTHON:-python3}" - <<'PY'
import itertools, pathlib, re, sys
import numpy as np

SEES = {
    "all cones": np.eye(3),
    "no L cones": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "no M cones": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "no S cones": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
WHITE = XYZ @ np.ones(3)

def linear(colour):
    c = np.array([colour >> 16, colour >> 8 & 255, colour & 255]) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)

def lab(rgb):
    t = XYZ @ np.clip(rgb, 0, 1) / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])

def array(script, name):
    text = re.search(rf"array {name}\[\d+\] = \[([^]]*)\]", pathlib.Path("apps/plot", script).read_text()).group(1)
    return [int(word, 16) for word in re.findall(r"0x[0-9a-f]{6}", text)]

failed = False
def judge(script, colours, least):
    global failed
    for who, matrix in SEES.items():
        seen = [lab(np.array(matrix) @ linear(c)) for c in colours]
        distance, a, b = min((np.linalg.norm(x - y), i, k) for (i, x), (k, y) in itertools.combinations(enumerate(seen), 2))
        print(f"{script}, {who}: nearest of {len(colours)}: {colours[a]:06x} and {colours[b]:06x}, {distance:.0f} apart (at least {least})")
        failed |= distance < least

# pieces of a bar that may lie beside each other: any two, since a reason may be missing; dots of participants: the first
# four, beyond which the lines help; strategies; states
for script, name, first, least in (("report-reasons.gp", "tints", 8, 14), ("report-boxes.gp", "who", 4, 16), ("report-boxes.gp", "laws", 4, 20),
                                   ("report-states.gp", "states", 3, 16)):
    colours = array(script, name)[:first]
    assert len(colours) == first
    judge(script, colours, least)
# answers: their numbers stand in the pieces, too
tints = array("report-survey.gp", "tints")
assert len(tints) == 9
for last in range(2, 10):
    judge("report-survey.gp", [tints[int(1.5 + k * 8 / (last - 1)) - 1] for k in range(last)], 14 if last <= 5 else 7)
assert np.linalg.norm(lab(np.array(SEES["no M cones"]) @ linear(0xff0000)) - lab(np.array(SEES["no M cones"]) @ linear(0xb5a000))) < \
    np.linalg.norm(lab(linear(0xff0000)) - lab(linear(0xb5a000))) # red and olive come nearer
sys.exit(bool(failed))
PY
