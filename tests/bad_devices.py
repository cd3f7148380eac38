"""Devices that are described badly or come from bad files: bad_devices.py BIN MAPS PLUGINS FOLDER

Each case changes one thing about something good. The result must be one line on stderr that names file and line where
there is one, exit code 2 for bad input and 1 for a device that fails, and no motion: the device's other side, a plain
socket or terminal of this script, hears nothing. The cases are counted by kind, and the counts are asserted, so that none
is left out unseen.
"""
import collections
import concurrent.futures
import csv
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
import tty

BIN, MAPS, PLUGINS, FOLDER = sys.argv[1:5]
WORKERS = 4
count = collections.Counter()
lock = threading.Lock()
failures = []


def tally(kind, n=1):
    with lock:
        count[kind] += n


def fail(*words):
    with lock:
        failures.append(" ".join(map(str, words)))


# ---- the other side ----

class Ear:
    """A port at which nothing may arrive: a TCP listener, or a terminal."""

    def __init__(self):
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.socket.setblocking(False)
        self.master, slave = os.openpty()
        tty.setraw(slave)
        os.set_blocking(self.master, False)
        self.slave = slave
        self.tcp = "127.0.0.1:%d" % self.socket.getsockname()[1]
        self.serial = os.ttyname(slave)

    def heard(self):
        try:
            self.socket.accept()[0].close()
            return "a connection"
        except BlockingIOError:
            pass
        try:
            return os.read(self.master, 64)
        except BlockingIOError:
            return b""


# ---- a program's verdict ----

def program(name, *arguments, seconds=60):
    done = subprocess.run(["timeout", "-s", "KILL", str(seconds), f"{BIN}/{name}", *arguments], stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return done.returncode, done.stderr.decode(errors="replace")


def one_line(what, said, names):
    """One printable line, shorter than a screen's rows, that names what is wrong."""
    if said.count("\n") != 1 or not said.endswith("\n") or len(said) >= 560 or not said[:-1].isprintable():
        fail(what, "not one line:", repr(said[:300]))
    elif not re.search(names, said):
        fail(what, "no", names, "in", said.strip())


def refused(what, ini, names, ear, look=True):
    """Bad input: ethd-run says so and exits with 2, and nothing arrived at the port; ethd-check, if it is asked, says the
    same without touching anything. False: ethd-check accepts it."""
    if look:
        checked, check_said = program("ethd-check", ini)
        if checked == 0:
            return False
    code, said = program("ethd-run", "--config", ini, "--virtual", "--duration", "0.01")
    if code != 2:
        fail(what, "ethd-run: exit", code, said[:300])
    if look and (checked, check_said.split(": ", 1)[-1]) != (code, said.split(": ", 1)[-1]):
        fail(what, "ethd-check: exit", checked, check_said[:300], "ethd-run:", said)
    one_line(what, said, names)
    if ear.heard():
        fail(what, "something was sent")
    return True


# ---- maps ----

Key = collections.namedtuple("Key", "section name value line")
NUMBERS = {"not a number": ("banana", "nan", "1.5x"), "out of range": ("1e30", "-1e30"),
           "overflow": ("1e999", "0xFFFFFFFFFFFF", "9" * 60)}
ROLES = re.compile(r"register (torque|position|speed|measured|index)[12]$|register (counter|bus_voltage|reading_\w+)$")


def keys_of(lines):
    section, keys = "", []
    for n, line in enumerate(lines):
        text = re.sub(r"(^|\s);.*|^#.*", "", line).strip()
        if text.startswith("["):
            section = text[1:-1]
        elif "=" in text:
            name, value = (part.strip() for part in text.split("=", 1))
            keys.append(Key(section, name, value, n))
    return keys


def sections_of(lines):
    begins = [n for n, line in enumerate(lines) if line.startswith("[")] + [len(lines)]
    return [(lines[a].split("]")[0][1:], a, b) for a, b in zip(begins, begins[1:])]


def base_map(name):
    """The shipped map, with numbers where it says that they must be looked up, and a bus quick enough to be accepted."""
    text = open(f"{MAPS}/{name}").read()
    numbers = iter(range(1000, 3000, 10))
    text = re.sub(r"LOOK_UP", lambda _: str(next(numbers)), text)
    if name == "akd.map":
        text = re.sub(r"^(silence|turnaround|divisor) =.*\n", "", text, flags=re.M)
    return text.splitlines()


def map_cases(lines):
    """(kind, line that the message must name or None, changed lines)"""
    keys = keys_of(lines)

    def put(n, *new):
        return lines[:n] + list(new) + lines[n + 1:]

    for k in keys:
        n, is_text = k.line, k.name in ("port", "echo")
        yield "key missing", None, put(n)
        yield "key doubled", n + 2, put(n, lines[n], f"{k.name} = {k.value}")
        yield "key empty", n + 1, put(n, f"{k.name} =")
        yield "key unknown", n + 1, put(n, f"{k.name}_ = {k.value}", lines[n])
        for kind, values in NUMBERS.items():
            for value in () if is_text else values:
                yield kind, n + 1, put(n, f"{k.name} = {value}")
                if k.name.startswith("step"):
                    yield kind + " in a step", n + 1, put(n, f"{k.name} = {' '.join(k.value.split()[:-1] + [value])}")
        if k.name == "port":
            yield "text too long", n + 1, put(n, "port = /dev/" + "x" * 170)
        if k.name == "echo":
            yield "no such register", n + 1, put(n, "echo = banana")
        if k.name == "unit" and k.section != "bus":
            yield "unit unknown", n + 1, put(n, "unit = furlong")
            if ROLES.match(k.section):
                yield "unit of something else", n + 1, put(n, "unit = " + ("Nm" if k.value == "V" else "V"))
        if k.name == "address":
            other = next((o for o in keys if o.name == "address" and o.section != k.section and clash(keys, o.section, k.section)), None)
            if not other:
                continue
            yield "address clash", (n + 1, other.line + 1), put(n, f"address = {other.value}")
    for name, begin, end in sections_of(lines):
        yield "section doubled", (len(lines) + 1, len(lines) + 2), lines + lines[begin:end]
        yield "section unknown", begin + 1, put(begin, "[banana]", lines[begin])
        yield "section open", begin + 1, put(begin, lines[begin].split("]")[0])
        yield "section missing", None, lines[:begin] + lines[end:]
    for n, junk in ((0, "banana"), (len(lines), "= 3"), (len(lines), "[bus"), (len(lines), "\0"), (0, "unit = 1")):
        yield "junk", n + 1, lines[:n] + [junk] + lines[n:]


def clash(keys, a, b):
    """Two registers can't stand at one address: their words differ, or both are written."""
    def said(section, name):
        return next((k.value for k in keys if k.section == section and k.name == name), None)

    same_words = said(a, "type") == said(b, "type") and said(a, "order") == said(b, "order")
    same_space = (said(a, "space") or "holding") == (said(b, "space") or "holding")
    return same_space and (not same_words or said(a, "direction") == said(b, "direction") == "write")


def sweep_maps(ear):
    for name in sorted(os.listdir(MAPS)):
        if not name.endswith(".map"):
            continue
        lines = base_map(name)
        port = ear.tcp if "transport = tcp" in "\n".join(lines) else ear.serial
        other = "" if "[register position2]" in "\n".join(lines) else ", counter"  # a map of one axis alone is refused
        device = f"[device]\ndriver = servo{other}\nservo.map = m.map\nservo.port = {port}\n"

        def try_one(job):
            i, (kind, at, changed) = job
            own = f"{FOLDER}/{name}.{i}"
            os.mkdir(own)
            open(f"{own}/m.map", "w").write("\n".join(changed) + "\n")
            open(f"{own}/c.ini", "w").write(device)
            where = at if isinstance(at, tuple) else (at,)
            names = r"m\.map:\d*:? " if at is None else r"m\.map:(" + "|".join(map(str, where)) + r"): "
            is_refused = refused(f"{name}, {kind}, case {i}:", f"{own}/c.ini", names, ear,
                                 "missing" in kind or i % 8 == 0)
            if not is_refused and "missing" not in kind:
                fail(name, kind, "case", i, "line", at, "is accepted:", changed[(where[0] or 1) - 1])
            tally(("maps", kind + ("" if is_refused else ", which is a map still")))
            shutil.rmtree(own)

        own = f"{FOLDER}/{name}.base"
        os.mkdir(own)
        open(f"{own}/m.map", "w").write("\n".join(lines) + "\n")
        open(f"{own}/c.ini", "w").write(device)
        code, said = program("ethd-check", f"{own}/c.ini")
        if code:
            fail(name, "as it is shipped: exit", code, said)
        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(try_one, enumerate(map_cases(lines))))


# ---- [device] sections ----

def device_cases(ear):
    """(kind, line or None, text of the configuration)"""
    good = {"servo": f"map = plant.map\nport = {ear.tcp}", "ring": "port = /nowhere/ring", "zones": "port = /nowhere/zones",
            "nail": "port = /nowhere/nail", "camera": "listen = 127.0.0.1:9871", "sim": "", "counter": "", "hello": "", "excite": ""}
    program("ethd-check", "--drivers", "--csv", f"{FOLDER}/drivers.csv")
    rows = [r for r in csv.DictReader(open(f"{FOLDER}/drivers.csv")) if r["id"] in good]
    for row in rows:
        base = "[device]\ndriver = " + row["id"] + "\n" + (good[row["id"]] + "\n" if good[row["id"]] else "")
        n, name = base.count("\n") + 1, row["param"]
        if not name:
            yield "key unknown", n, base + "banana = 1\n"
            continue
        bad = {"key empty": [""], "not a number": ["banana", "nan", "1.5x", "0x10"], "overflow": ["1e999", "9" * 60]}
        if "|" not in row["unit"]:
            low, high = float(row["min"]), float(row["max"])
            bad["out of range"] = [repr(low - 1 - abs(low))] + ([repr(2 * high + 1)] if high < 1e300 else [])
        if row["unit"] == "whole":
            bad["not whole"] = [repr(float(row["min"]) + 0.5)]
            bad["not a number"][-1] = "0x"
        for kind, values in bad.items():
            for value in values:
                if kind == "overflow" and row["max"] == "inf" and value != "1e999":
                    continue  # a large number, and allowed
                yield kind, n, base + f"{name} = {value}\n"
        whole = row["default"]
        yield "key doubled", n + 1, base + f"{name} = {whole}\n{name} = {whole}\n"
    plant = f"map = plant.map\nport = {ear.tcp}\n"
    for names in ("banana", "servo, servo", "servo,", ",servo", "servo,,ring", "file:", "file:.", "file:nowhere.so", "Servo",
                  ", ".join(["servo"] * 20), "servo banana", "replay", "\x7f"):
        yield "drivers", None, f"[device]\ndriver = {names}\n" + plant
    for line in ("map = nowhere.map", "map =", "map = .", "map = c.ini", "port =", "hang_time = 0", "hang_time = banana",
                 "inject = nowhere.inject", "inject =", "servo.banana = 1", "ring.port = x", "driver = sim", "port"):
        rest = "".join(l + "\n" for l in plant.splitlines() if not line.split(" ")[0] == l.split(" ")[0])
        yield "lines", None, f"[device]\ndriver = servo\n{rest}{line}\n"
    for line in ("map = plant.map", "port = x", "inject_ = 1", "banana.map = plant.map"):
        yield "keys without an owner", 5, f"[device]\ndriver = servo, hello\nservo.map = plant.map\nservo.port = {ear.tcp}\n{line}\n"
    yield "section doubled", None, f"[device]\ndriver = servo\n{plant}[device]\ndriver = servo\n"


def sweep_devices(ear):
    shutil.copy(f"{MAPS}/plant.map", FOLDER)

    def try_one(job):
        i, (kind, at, text) = job
        own = f"{FOLDER}/device.{i}"
        os.mkdir(own)
        shutil.copy(f"{MAPS}/plant.map", own)
        open(f"{own}/c.ini", "w").write(text)
        names = f"c.ini:{at}: " if at else r"c\.ini|\.map|nowhere|device"
        if not refused(f"[device], {kind}, case {i}:\n{text}", f"{own}/c.ini", names, ear):
            fail("[device],", kind, "is accepted:\n" + text)
        tally(("[device]", kind))
        shutil.rmtree(own)

    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(try_one, enumerate(device_cases(ear))))


# ---- shared objects ----

def object_cases():
    """(kind, bytes)"""
    good = open(f"{PLUGINS}/driver_older.so", "rb").read()
    for k in range(64):
        yield "cut", good[:len(good) * k // 64]
    for bit in range(8 * 64):  # of the header
        yield "a bit of its header is wrong", good[:bit // 8] + bytes([good[bit // 8] ^ 1 << bit % 8]) + good[bit // 8 + 1:]
    for text in (b"no program\n", b"#!/bin/sh\n", b"\x7fELF", b"\x7fELF" + b"\0" * 1000, b"\xff" * 4096):
        yield "no object", text


def sweep_objects(ear):
    def try_one(job):
        i, (kind, data) = job
        own = f"{FOLDER}/object.{i}"
        os.mkdir(own)
        shutil.copy(f"{MAPS}/plant.map", own)
        open(f"{own}/x.so", "wb").write(data)
        open(f"{own}/c.ini", "w").write("[device]\ndriver = servo, file:x.so\nhang_time = 5\nservo.map = plant.map\n"
                                        f"servo.port = {ear.tcp}\n")
        what = f"object, {kind}, case {i}:"
        code, said = program("ethd-check", f"{own}/c.ini")
        if code == 0 and "bit" in kind:
            tally(("objects", kind))  # it still loads: the loader decides which do
        else:
            if code not in (1, 2):
                fail(what, "exit", code, said[:300])
            one_line(what, said, "x.so")
            run_code, run_said = program("ethd-run", "--config", f"{own}/c.ini", "--virtual", "--duration", "0.01")
            if run_code != code:
                fail(what, "ethd-run: exit", run_code, run_said)
            one_line(what, run_said, "x.so")
            if ear.heard():
                fail(what, "something was sent")
            tally(("objects", kind))
        shutil.rmtree(own)

    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        list(pool.map(try_one, enumerate(object_cases())))


# How many of each there must be. A new key of a map, a new setting or a new driver changes its line: look at what is new.
EXPECTED = """
[device]     13  drivers
[device]     73  key doubled
[device]     73  key empty
[device]      9  key unknown
[device]      4  keys without an owner
[device]     13  lines
[device]    292  not a number
[device]      7  not whole
[device]    120  out of range
[device]    144  overflow
[device]      1  section doubled
maps         57  address clash
maps         20  junk
maps        423  key doubled
maps        423  key empty
maps        312  key missing
maps        111  key missing, which is a map still
maps        423  key unknown
maps          9  no such register
maps       1230  not a number
maps        105  not a number in a step
maps        820  out of range
maps         70  out of range in a step
maps       1230  overflow
maps        105  overflow in a step
maps         76  section doubled
maps         50  section missing
maps         26  section missing, which is a map still
maps         76  section open
maps         76  section unknown
maps          4  text too long
maps         26  unit of something else
maps         26  unit unknown
objects     512  a bit of its header is wrong
objects      64  cut
objects       5  no object
"""


def main():
    sweep_maps(Ear())
    sweep_devices(Ear())
    sweep_objects(Ear())
    table = "".join(f"{of:9} {n:5}  {kind}\n" for (of, kind), n in sorted(count.items()))
    for line in sorted(set(table.splitlines()) ^ set(EXPECTED.split("\n")[1:-1])):
        fail("counted" if line in table else "expected", line)
    for line in failures[:100]:
        print("FAILED", line)
    print(table, end="")
    print(sum(count.values()), "cases,", len(failures), "failures")
    sys.exit(1 if failures else 0)


main()
