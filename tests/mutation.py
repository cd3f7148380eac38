"""Mutation of lib and of the ring's decoder: how many small bugs do the tests notice?

Run by tests/mutation.sh. universalmutator makes the mutants; lines are mutated without their comments. A stratified sample
is drawn with a fixed seed: every prefix of it has each file's share, so that a run may stop and go on at any place. A mutant
counts when it compiles and when its object differs from the original's. Each is compiled alone and linked into one shared
library, which all unit tests load, until one fails or BUDGET is spent: its file's own first, then those that have found
most in their time. The golden outputs, which detect a difference of one bit, are checked last. Results are lines of JSON in
one file; results for lines that have changed since are ignored.
"""
import argparse
import collections
import hashlib
import json
import math
import os
import random
import re
import shutil
import sys
import time
from pathlib import Path

from mutation_tree import Tree

BUDGET = 9.0  # s of tests, by their own time when nothing is broken
SLOWEST = 1.5  # s; a slower test runs only for its own file
SEED = 13


# ---- the mutants ----

def without_comments(text):
    """Returns the same lines with blanks in place of comments."""
    pattern = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|/\*.*?\*/', re.S)
    blank = lambda m: m[0] if m[0][0] != "/" else re.sub(r"[^\n]", " ", m[0])
    return [re.sub(r"[ \t]+$", "", line) + "\n" for line in pattern.sub(blank, text).split("\n")[:-1]]


def mutants_of(source):
    from universalmutator import mutator
    lines = without_comments(Path(source).read_text())
    out, sys.stdout = sys.stdout, open(os.devnull, "w")
    found = mutator.mutants_regexp(lines, ["universal.rules", "c_like.rules", "c.rules"], ignorePatterns=[],
                                   ignoreStringOnly=True)
    sys.stdout = out
    digest = hashlib.sha256("".join(lines).encode()).hexdigest()[:12]
    return [{"file": source, "line": number, "to": text, "source": digest} for number, text, *_ in found], lines


def sample(files):
    """Returns all mutants, ordered so that each file has its share of every prefix."""
    order, lines = [], {}
    for name in files:
        mutants, lines[name] = mutants_of(name)
        rng = random.Random(f"{SEED} {name}")
        rng.shuffle(mutants)
        start = rng.random()
        order += [((i + start) / len(mutants), name, m) for i, m in enumerate(mutants)]
    order.sort(key=lambda row: row[:2])
    return [m for _, _, m in order], lines


def key_of(m):
    return (m["file"], m["source"], m["line"], hashlib.sha256(m["to"].encode()).hexdigest()[:12])


# ---- which tests ----

def words(path):
    return set(re.split(r"[_/.]", re.sub(r"^(lib|tests|drivers)/|test_|[.][ch]$", "", path))) - {"unit", "lib", "c", ""}


class Plan:
    """The tests that pass as they are, and their times."""

    def __init__(self, tree):
        self.tests = tree.link_tests()
        self.found = collections.Counter()
        place = tree.work / "times.json"
        self.times = json.loads(place.read_text()) if place.exists() else {}
        for test, path in self.tests.items():
            if test in self.times:
                continue
            seconds = None
            text = path.read_text()
            if not re.search(r"threads?[.]h|servo/|loop[.]h|pty[.]h|fault_ring[.]h|nanosleep", text):  # they wait
                for fork in (False, True):
                    passed, spent = tree.run(test, 60, fork)
                    if passed:
                        seconds = [spent, fork]
                        break
            self.times[test] = seconds
            print(f"  {test}: {'%.2f s' % seconds[0] if seconds else 'left out'}", flush=True)
        place.write_text(json.dumps(self.times))

    def of(self, m):
        usable = {t: s for t, s in self.times.items() if s and t in self.tests}
        own = lambda t: len(words(m["file"]) & words(t))
        chosen, spent = [], 0.0
        for t in sorted(usable, key=lambda t: (-own(t), usable[t][0])):
            if usable[t][0] > SLOWEST and not own(t):
                continue
            if chosen and spent + usable[t][0] > BUDGET:
                continue
            spent += usable[t][0]
            chosen.append(t)
        return sorted(chosen, key=lambda t: (-own(t), -self.found[t] / (usable[t][0] + 0.05)))


# ---- one mutant ----

def judge(tree, plan, m, lines):
    text = list(lines[m["file"]])
    text[m["line"] - 1] = m["to"]
    shutil.rmtree(tree.overlay, ignore_errors=True)
    place = tree.overlay / m["file"]
    place.parent.mkdir(parents=True)
    place.write_text("".join(text))
    is_header = m["file"].endswith(".h")
    changed = {}
    for source in tree.users(m["file"]) if is_header else [m["file"]]:
        out = tree.work / "o" / Path(source).with_suffix(".o")
        out.parent.mkdir(parents=True, exist_ok=True)
        at = source if is_header else place
        if not tree.compile(source, at, out):
            return "invalid", None
        if out.read_bytes() != tree.object(source).read_bytes():
            changed[source] = out
    if not changed:
        return "same", None
    if not tree.link_library(changed):
        return "invalid", None
    for test in plan.of(m):
        seconds, fork = plan.times[test]
        if not tree.run(test, 2 * seconds + 1, fork)[0]:
            plan.found[test] += 1
            return "killed", test
    return ("survived", None) if tree.golden() else ("killed", "golden")


# ---- the figures ----

def wilson(killed, all_, z=1.6449):
    """The lower bound of a share, one-sided, at 95 %."""
    p = killed / all_
    return (p + z * z / (2 * all_) - z * math.sqrt(p * (1 - p) / all_ + z * z / (4 * all_ * all_))) / (1 + z * z / all_)


def read_results(path):
    """Returns the verdicts of earlier runs by the mutant's key."""
    results = {}
    if path.exists():
        for line in path.read_text().splitlines():
            try:
                m = json.loads(line)
            except ValueError:
                continue  # the last line of a run that was killed
            results[key_of(m)] = m
    return results


def equivalents():
    """(file, line, mutated line)"""
    found = set()
    for line in Path("tests/mutation.equivalent").read_text().splitlines():
        if line and not line.startswith("#"):
            found.add(tuple(part.strip() for part in line.split("\t")[:3]))
    return found


def knows_equivalents(lines):
    known = equivalents()
    return lambda m: (m["file"], lines[m["file"]][m["line"] - 1].strip(), m["to"].strip()) in known


def report(drawn, lines):
    is_known = knows_equivalents(lines)
    valid = [m for m in drawn if m["verdict"] in ("killed", "survived")]
    equal = [m for m in valid if m["verdict"] == "survived" and is_known(m)]
    killed = sum(m["verdict"] == "killed" for m in valid)
    rest = len(valid) - len(equal)
    survivors = [m for m in valid if m["verdict"] == "survived" and not is_known(m)]
    with open(Path(os.environ["BUILD"]) / "mutation" / "survivors.txt", "w") as out:
        for m in sorted(survivors, key=key_of):
            out.write(f"{m['file']}:{m['line']}\n  - {lines[m['file']][m['line'] - 1].strip()}\n  + {m['to'].strip()}\n")
    print(f"mutants: {len(valid)} of {len(drawn)} drawn compile and differ; {killed} killed, {len(equal)} listed as equivalent, "
          f"{len(survivors)} survive")
    if rest:
        print(f"killed: {killed / rest:.4f} of {rest}, at least {wilson(killed, rest):.4f} (95 %, Wilson)")


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--tree", required=True)
    p.add_argument("--results", required=True)
    p.add_argument("--count", type=int, default=2000, help="mutants that compile and differ")
    p.add_argument("--minutes", type=float, default=math.inf)
    p.add_argument("--again", action="store_true", help="the survivors once more, after tests were added")
    p.add_argument("--files", help="only files whose path has this")
    a = p.parse_args()
    end = time.monotonic() + 60 * a.minutes
    tree = Tree(a.tree)
    (tree.work / "tmp").mkdir(parents=True, exist_ok=True)
    tree.link_library({})
    plan = Plan(tree)
    tree.link_programs()
    if not tree.golden():
        print("the golden outputs differ before anything is changed")
        return 1
    order, lines = sample([f for f in tree.sources + tree.headers if not a.files or a.files in f])
    path = Path(a.results)
    done = read_results(path)
    plan.found.update(old["by"] for old in done.values() if old.get("by"))
    drawn, valid, told = [], 0, time.monotonic()
    is_known = knows_equivalents(lines)
    with path.open("a") as out:
        for m in order:
            if valid >= a.count:
                break
            old = done.get(key_of(m))
            if old is None or (a.again and old["verdict"] == "survived" and not is_known(m)):
                if time.monotonic() > end:
                    if a.again and old:
                        drawn.append(dict(m, verdict=old["verdict"]))
                        continue
                    break
                verdict, by = judge(tree, plan, m, lines)
                old = dict(m, verdict=verdict, by=by)
                out.write(json.dumps(old) + "\n")
                out.flush()
            drawn.append(dict(m, verdict=old["verdict"]))
            valid += old["verdict"] in ("killed", "survived")
            if time.monotonic() > told + 30:
                told = time.monotonic()
                print(f"  {valid} of {a.count}, {sum(d['verdict'] == 'survived' for d in drawn)} survive", flush=True)
    report(drawn, lines)
    return 0


sys.exit(main())
