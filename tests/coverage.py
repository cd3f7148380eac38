"""Reads what gcov counted in a tree that was built with --coverage, and names each branch that no test took.

A branch that can't be taken is excused beside its line or in the line above it:
    /* unreachable: why */
An excuse that has nothing to excuse is a failure too, so that these only shrink. Static functions of headers are
counted once for all that include them. With gcc 14 and -fcondition-coverage conditions (MC/DC) are read instead.
"""
import argparse
import json
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

EXCUSE = re.compile(r"/\* unreachable: .*\*/")


def read(gcov, tree, rooms):
    """file -> line -> {branch: times}, file -> line -> {condition: covered}; a line of no branch has {}."""
    branches, conditions = defaultdict(lambda: defaultdict(dict)), defaultdict(lambda: defaultdict(dict))
    notes = sorted(str(p) for room in rooms for p in (Path(tree) / "obj" / room).rglob("*.gcno"))
    flags = ["--branch-probabilities", "--json-format", "--stdout"]
    if conditions_known(gcov):
        flags.append("--conditions")
    out = subprocess.run([gcov, *flags, *notes], capture_output=True, text=True)
    for text in out.stdout.splitlines():
        if not text.startswith("{"):
            continue
        for file in json.loads(text)["files"]:
            if not any(file["file"].startswith(room + "/") for room in rooms):
                continue
            for line in file["lines"]:
                here = branches[file["file"]][line["line_number"]]
                for i, branch in enumerate(line["branches"]):
                    here[i] = here.get(i, 0) + branch["count"]
                if not line["branches"]:
                    here["run"] = here.get("run", 0) + line["count"]
                for i, c in enumerate(line.get("conditions", [])):
                    seen = conditions[file["file"]][line["line_number"]]
                    for outcome in ("true", "false"):
                        for term in range(c["count"] // 2):
                            missed = term in c["not_covered_" + outcome]
                            seen[(i, term, outcome)] = seen.get((i, term, outcome), False) or not missed
    return branches, conditions


def conditions_known(gcov):
    return "--conditions" in subprocess.run([gcov, "--help"], capture_output=True, text=True).stdout


def excused(lines, number):
    above = lines[number - 2] if number > 1 else ""
    return number if EXCUSE.search(lines[number - 1]) else number - 1 if EXCUSE.search(above) else 0


def judge(counts, shrinks):
    """(room -> [all, taken, excused]; what is wrong, with excuses that have nothing left to excuse where it shrinks)"""
    rooms, wrong = defaultdict(lambda: [0, 0, 0]), []
    for name in sorted(counts):
        lines, used = Path(name).read_text().splitlines(), set()
        for number, here in sorted(counts[name].items()):
            missed = [key for key, times in here.items() if not times]
            excuse = excused(lines, number) if missed else 0
            real = [key for key in here if key != "run"]
            room = rooms[str(Path(name).parent)]
            room[0] += len(real)
            room[1] += sum(bool(here[key]) for key in real)
            if excuse:
                used.add(excuse)
                room[2] += len([key for key in missed if key != "run"])
            elif missed:
                what = "never run" if missed == ["run"] else f"{len(missed)} of {len(real)} never"
                wrong.append(f"{name}:{number}: {what}: {lines[number - 1].strip()}")
        for number, text in enumerate(lines, 1):
            if shrinks and EXCUSE.search(text) and number not in used:
                wrong.append(f"{name}:{number}: an excuse for what is covered: {text.strip()}")
    return rooms, wrong


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--gcov", default="gcov")
    p.add_argument("--conditions", action="store_true", help="MC/DC instead of branches")
    p.add_argument("--least", type=float, default=1, help="the share that is enough, excuses counted as taken")
    p.add_argument("tree")
    p.add_argument("rooms", nargs="+")
    a = p.parse_args()
    if a.conditions and not conditions_known(a.gcov):
        print(f"SKIP: {a.gcov} doesn't know conditions (gcc 14 does)")
        return 77
    branches, conditions = read(a.gcov, a.tree, a.rooms)
    rooms, wrong = judge(conditions if a.conditions else branches, not a.conditions)
    total = [sum(column) for column in zip(*rooms.values())]
    if not total or not total[0]:
        print("nothing was counted")
        return 1
    what = "condition outcomes" if a.conditions else "branches"
    for room, (all_, taken, spared) in [*sorted(rooms.items()), (" ".join(a.rooms), total)]:
        if all_:
            print(f"{room}: {taken} of {all_} {what}, {100 * taken / all_:.1f} %, {spared} excused")
    share = (total[1] + total[2]) / total[0]
    print(*wrong, sep="\n")
    if share < a.least or (a.least == 1 and wrong):
        print(f"FAILED: {100 * share:.1f} % where {100 * a.least:.0f} % are due")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
