"""tests/study_whole.sh: leads two stations through a study, kills them, and judges what is left.
   study_whole.py STUDY FOLDER | --judge FOLDER TAPS ATTEMPTS"""
import csv, glob, os, random, re, shutil, sqlite3, subprocess, sys, tempfile, threading, time

KILLS = {"simulated": 6, "mouse": 4}
ANSWERS = ["2", "4"]  # that the mouse's people give
SLIPPED = "the hand slipped"


TABLES = ("tap", "event", "answer", "survey")


def ask(folder, sql):
    """What a session's store says while the session is at work, which holds its lock."""
    try:
        return sqlite3.connect(f"file:{folder}/study.sqlite?immutable=1", uri=True).execute(sql).fetchall()
    except sqlite3.DatabaseError:  # there is none yet, or it is just being changed
        return []


def count(folder, table, where="1"):
    return sum(ask(folder, f"select count(*) from {table} where {where}")[:1], (0,))[-1]


def store(folder):
    """The rows of an ended session's store: of a copy, so that the program itself has to undo what was cut short."""
    with tempfile.TemporaryDirectory() as copy:
        for name in glob.glob(folder + "/study.sqlite*"):
            shutil.copy(name, copy)
        db = sqlite3.connect(copy + "/study.sqlite")
        there = db.execute("select count(*) from sqlite_master").fetchone()[0]
        return {t: set(db.execute(f"select * from {t}")) if there else set() for t in TABLES}


class Station:
    """A session that is begun or resumed, and killed several times at random."""

    def __init__(self, study, folder, name, options):
        self.command = [study, "--quiet"] + options
        self.study, self.folder, self.name = folder + "/whole.study", folder + "/" + name, name
        self.kept = {t: set() for t in TABLES}  # the rows that were there at the last kill
        self.random = random.Random(name)
        self.kills = 0

    def start(self):
        begun = os.path.exists(self.folder + "/study.sqlite")
        where = ["--resume", self.folder] if begun else [self.study, "--out", self.folder]
        self.run = subprocess.Popen(self.command + where, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def kill_after(self, seconds):
        timer = threading.Timer(seconds, self.run.kill)
        timer.start()
        return timer

    def ended(self):
        """Called after a session's end, by a kill or by itself: what was written down must still be there."""
        out, err = self.run.communicate()
        now = store(self.folder)
        for table in TABLES:  # an answer may be given again until all are confirmed
            lost = self.kept[table] - now[table]
            assert not lost or (table == "answer" and {r[:3] for r in lost} <= {r[:3] for r in now[table]}), (self.name, lost)
        self.kept = now
        if self.run.returncode == -9:
            self.kills += 1
            return False
        assert self.run.returncode == 0, (self.name, self.run.returncode, out, err)
        return True


def simulated(study, folder):
    """Killed while it is at work; when it ends sooner, another one begins."""
    station = Station(study, folder, "simulated", ["--participant", "1-12"])
    while True:
        station.start()
        timer = station.kill_after(station.random.uniform(0, 0.5) if station.kills < KILLS["simulated"] else 3600)
        over = station.ended()
        timer.cancel()
        if over and station.kills >= KILLS["simulated"]:
            break
        if over:
            subprocess.run(["rm", "-r", station.folder], check=True)
            station.kept = {t: set() for t in TABLES}
    alone = Station(study, folder, "alone", ["--participant", "1-12"])
    alone.start()
    assert alone.ended()
    for name in ("taps.csv", "survey.csv", "participants.csv"):
        assert open(f"{folder}/alone/{name}").read() == open(f"{station.folder}/{name}").read(), name
    return station.kills


class Hand:
    """The pointer and the keys of whoever sits before the screen."""
    pause = 0.1  # s after a key

    def __init__(self, line):
        number = re.findall(r"-?\d+\.?\d*(?:e[+-]?\d+)?", line)
        _, _, self.x0, self.scale, self.y0, _, self.start, self.middle, self.wall = map(float, number)
        self.tool = subprocess.Popen(["xdotool", "-"], stdin=subprocess.PIPE, text=True)

    def say(self, words):
        self.tool.stdin.write(words + "\n")
        self.tool.stdin.flush()

    def keys(self, names):
        for name in names.split():
            self.say("key " + name)
            time.sleep(self.pause)

    def move(self, x, y=None):
        y = self.middle if y is None else y
        self.say(f"mousemove {round(self.x0 + self.scale * x)} {round(self.y0 - self.scale * y)}")

    def tap(self):
        """To the start, a wait there, and at 0.2 m/s into the wall."""
        self.move(self.start)
        time.sleep(1.0)
        begin = time.monotonic()
        while (t := time.monotonic() - begin) < 0.35:
            self.move(self.start - min(0.2 * t, self.start - self.wall + 0.006))
            time.sleep(0.004)
        time.sleep(0.3)


def due_of(folder):
    """The keys that the last tap, answer or confirmation makes due, and how many of each there are."""
    counts = count(folder, "tap"), count(folder, "answer"), count(folder, "survey")
    asked = [r[0] for r in ask(folder, "select question from answer left join survey using (participant, block) "
                                       "where survey.id is null")]
    ended = ask(folder, "select (participant, block) in (select participant, block from survey) from tap order by id desc")
    if not counts[0] or (ended and ended[0][0]):
        return "", counts
    return f"space {ANSWERS[0]} Return" if not asked else f"{ANSWERS[1]} Return" if 2 not in asked else "Return", counts


def answer(hand, station):
    """What is due by the store, where questions are asked; after each key that is taken the store grows."""
    while station.run.poll() is None:
        due, before = due_of(station.folder)
        if not due:
            return
        hand.keys(due)
        until = time.monotonic() + (5 if before[1] else 1)
        while due_of(station.folder)[1] == before and station.run.poll() is None:
            if time.monotonic() > until:
                return
            time.sleep(0.05)


def reject(hand, station):
    """The experimenter rejects one tap that counts, with a reason, before anything else comes."""
    last = ask(station.folder, "select participant, block, attempt, valid from tap order by id desc limit 1")
    if not last or count(station.folder, "event", "event = 'reject'"):
        return
    who, block, _, valid = last[0]
    plan = {(r["participant"], r["block"]): r["part"] for r in rows(station.folder + "/orders.csv")}
    if valid and plan[f"P{who}", str(block)] == "test":
        hand.keys("r")
        hand.say('type --delay 1 "' + SLIPPED + '"')
        time.sleep(0.3)
        hand.keys("Return")


def cycle(hand, station):
    """Every page takes some of the keys, and ignores the others: consent, instruction, block, a tap,
    answers, their confirmation, the hand-over, the end."""
    cells = sum(r["participant"] == "P13" and r["part"] == "test" for r in rows(station.folder + "/orders.csv"))
    hand.keys("y space")
    if count(station.folder, "survey", "participant = 13") == cells and not count(station.folder, "tap", "participant = 14"):
        hand.keys("Return P 1 4 Return y space")
    hand.keys("space")
    hand.tap()
    reject(hand, station)
    answer(hand, station)
    hand.keys("space")


def mouse(study, folder):
    station = Station(study, folder, "mouse", ["--participant", "13-14", "--screen"])
    while True:
        station.start()
        timer = station.kill_after(station.random.uniform(0.3, 5) if station.kills < KILLS["mouse"] else 3600)
        line = station.run.stdout.readline()
        if line:
            hand = Hand(line)
            deadline = time.monotonic() + 600
            while station.run.poll() is None and time.monotonic() < deadline:
                cycle(hand, station)
            hand.tool.kill()
            hand.tool.wait()
        over = station.ended()
        timer.cancel()
        if over:
            return station.kills


def rows(path):
    return list(csv.DictReader(open(path, newline="")))


def judge(folder, taps, attempts):
    """The merged folder against its plan, its own tap folders, and the stations."""
    both = folder + "/both"
    table, plan = rows(both + "/taps.csv"), rows(both + "/orders.csv")
    planned = {(r["participant"], r["block"]): r for r in plan}
    blocks = {}
    for r in table:
        p = planned[r["participant"], r["block"]]
        assert all(r[k] == p[k] for k in ("part", "transition", "speed")), ("another block's", r)
        assert r["hand"] == ("mouse" if r["participant"] > "P12" else "simulated"), ("another hand's", r)
        assert bool(r["utc"]) == (r["hand"] == "mouse"), r
        blocks.setdefault((r["participant"], r["block"]), []).append(r)
    assert set(blocks) == set(planned), ("blocks are missing", set(planned) ^ set(blocks))
    for key, mine in blocks.items():
        assert [int(r["attempt"]) for r in mine] == list(range(1, len(mine) + 1)), ("lost or doubled", key)
        valid = [r["valid"] == "1" and r["checked"] != "rejected" for r in mine]
        if mine[0]["part"] == "test":
            assert (sum(valid) == taps and valid[-1]) or len(mine) == attempts, ("ended too soon", key)
    # each row has its folder, and no folder is without
    names = {f"{r['participant']}-{int(r['block']):02d}-{int(r['attempt']):03d}": r for r in table}
    assert len(names) == len(table) and set(os.listdir(both + "/taps")) == set(names), "folders"
    assert len(table) == sum(len(rows(f"{folder}/{s}/taps.csv")) for s in ("simulated", "mouse"))
    # the survey: once a cell, as it was answered
    cells = [k for k, p in planned.items() if p["part"] == "test"]
    survey = rows(both + "/survey.csv")
    assert sorted((r["participant"], r["block"]) for r in survey) == sorted(cells), "survey"
    for r in survey:
        assert [r["q1"], r["q2"]] == (ANSWERS if r["participant"] > "P12" else ["", ""]), r
    people = rows(both + "/participants.csv")
    assert [(r["participant"], r["status"], r["analysed"]) for r in people] == \
        [(f"P{k:02d}", "complete", "1") for k in range(1, 15)], people
    rejected = [(r["participant"], r["block"], r["attempt"]) for r in table if r["checked"] == "rejected"]
    events = [r for r in rows(both + "/events.csv") if r["event"] == "reject"]
    assert rejected == [(r["participant"], r["block"], r["attempt"]) for r in events] and len(rejected) == 1, (rejected, events)
    assert events[0]["detail"] == SLIPPED and events[0]["participant"] in ("P13", "P14"), events
    assert [int(r["rejected"]) for r in people] == [int(r["participant"] == rejected[0][0]) for r in people], people
    assert sum(int(r["taps"]) for r in people) == sum(r["part"] == "test" for r in table), people
    agreed = [r["participant"] for r in rows(both + "/events.csv") if r["event"] == "consent"]
    assert agreed == ["P13", "P14"], agreed
    print(f"{len(table)} taps of {len(people)} people in {len(blocks)} blocks, {len(survey)} questionnaires")


if __name__ == "__main__":  # tests/study_screen.sh takes its hand
    if sys.argv[1] == "--judge":
        judge(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
    else:
        kills = simulated(*sys.argv[1:]), mouse(*sys.argv[1:])
        assert sum(kills) >= sum(KILLS.values()), kills
        print(f"killed {kills[0]} and {kills[1]} times")
