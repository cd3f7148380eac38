"""A guided session: calibrate_guided.py ETHD_CALIBRATE

Plays the ring on a pty and the person at the terminal; what the sensors count follows the place that is asked for.
"""
import fcntl
import math
import os
import pty
import re
import struct
import subprocess
import sys
import termios
import threading
import time
import tty

RING, ROD, A, D0, DARK = 0.012, 0.0075, 0.5, 0.0025, 2000


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc


def frame(seq, counts):
    raw = struct.pack("<BBHI16H", 1, 0, seq & 0xFFFF, seq * 10000 // 3 & 0xFFFFFFFF, *counts)
    raw += struct.pack("<H", crc16(raw))
    return b"".join(bytes([len(part) + 1]) + part for part in raw.split(b"\0")) + b"\0"


def counts_at(place):
    """None: empty; 0: the middle; k + 1: touching at sensor k."""
    if place is None:
        return [DARK] * 16
    r = RING - ROD if place else 0
    cx, cy = (r * f(2 * math.pi * (place - 1) / 16) for f in (math.cos, math.sin))
    out = []
    for k in range(16):
        ux, uy = math.cos(2 * math.pi * k / 16), math.sin(2 * math.pi * k / 16)
        along, across = ux * cx + uy * cy, ux * cy - uy * cx
        d = RING - along - math.sqrt(ROD * ROD - across * across)
        out.append(min(65535, round(DARK * (1 + k / 40) + A * (1 + k / 50) / (d + D0) ** 2)))
    return out


class Ring(threading.Thread):
    def __init__(self, master):
        super().__init__(daemon=True)
        self.master, self.counts, self.seq, self.stop = master, counts_at(None), 0, False

    def run(self):
        while not self.stop:
            try:
                os.write(self.master, frame(self.seq, [c + (self.seq * (k + 3)) % 5 - 2 if 10 < c < 65530 else c for k, c in enumerate(self.counts)]))
            except BlockingIOError:
                pass  # nobody reads
            self.seq += 1
            time.sleep(0.001)


def session(path, ring, answers, *options):
    process = subprocess.Popen([sys.argv[1], "--port", path, "--frames", "20", *options], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    said, asked = "", 0
    while True:
        c = process.stdout.read(1)
        if not c:
            break
        said += c
        if said.endswith("q ends: "):
            question = said.split("q ends: ")[-2]
            sensor = re.findall(r"right at sensor (\d+)", question)
            ring.counts = counts_at(int(sensor[-1]) + 1 if sensor else 0 if "middle" in question else None)
            if "empty ring" in question:
                ring.counts = [round(DARK * (1 + k / 40)) for k in range(16)]
            if asked < len(answers) and answers[asked] == "hand in the ring":
                ring.counts, answers[asked] = counts_at(0), ""
            process.stdin.write((answers[asked] if asked < len(answers) else "") + "\n")
            process.stdin.flush()
            asked += 1
    return process.wait(), said, process.stderr.read(), asked


def main():
    master, slave = pty.openpty()
    tty.setraw(slave)
    path = os.ttyname(slave)
    fcntl.fcntl(master, fcntl.F_SETFL, os.O_NONBLOCK)
    ring = Ring(master)
    ring.start()

    code, said, error, asked = session(path, ring, ["", "", "", "s", "", "b"], "--record", "guided.csv", "--out", "guided.ini")
    assert code == 0, (code, error)
    # the empty ring and 17 places; two more for going back
    assert asked == 1 + 17 + 2, (asked, said)
    law = re.search(r"\* law +([0-9.]+)", said)
    assert law and float(law[1]) < 0.01, said
    text = open("guided.ini").read()
    assert "level = law" in text and abs(float(re.search(r"\[sensor 0\][^[]*\nd0 = (\S+)", text)[1]) - D0) < 5e-5, text
    rows = open("guided.csv").read().splitlines()
    assert len(rows) == 1 + 1 + 16, len(rows)  # a place was skipped

    code, said, error, _ = session(path, ring, ["hand in the ring"])
    assert code == 1 and "are allowed in an empty ring" in error, (code, error)

    code, said, error, _ = session(path, ring, ["", "", "", "q"], "--record", "part.csv")
    assert code == 2 and "ended after 2 places; they are kept: --in goes on with them" in error, (code, error)
    assert len(open("part.csv").read().splitlines()) == 1 + 1 + 2

    ring.stop = True
    ring.join()
    os.set_blocking(master, True)
    code, said, error, _ = session(path, ring, [""])
    assert code == 1 and "no frames: is the ring powered" in error, (code, error)
    print("guided session: 17 places, one skipped, one measured again; a hand in the ring, an early end, silence")


if __name__ == "__main__":
    main()
