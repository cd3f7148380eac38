"""The proximity ring's firmware under test: proximity_firmware.py RING_BOARD FIRMWARE.elf

Frames are decoded here from the description in frame.h, not by the host's decoder.
"""
import os
import random
import struct
import subprocess
import sys
import threading
import time

MISSING, BOARD, FIRST, BOARD_RESET, LATE, RECOVERED, WATCHDOG = 1, 2, 4, 8, 16, 32, 64
START_US, SLOT_US = 80, 430
COUNTS = [1000 + 100 * k for k in range(16)]


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc


assert crc16(b"123456789") == 0x6F91


def uncobs(data):
    out = b""
    while data:
        code, block, data = data[0], data[1 : data[0]], data[data[0] :]
        if len(block) != code - 1:
            return None
        out += block + (b"\0" if data else b"")
    return out


class Frame:
    def __init__(self, raw):
        self.type, self.flags, self.seq, self.t_us = struct.unpack("<BBHI", raw[:8])
        self.counts = list(struct.unpack("<16H", raw[8:40]))

    def __repr__(self):
        return f"seq {self.seq} t {self.t_us} us flags {self.flags:#04x} counts {self.counts}"


class Ring:
    """The simulated ring; its time passes only in run()."""

    def __init__(self, *options):
        self.process = subprocess.Popen([sys.argv[1], "--step", *options, sys.argv[2]], text=True, bufsize=1,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.port = os.open(self.process.stdout.readline().split()[1], os.O_RDONLY | os.O_NOCTTY)
        self.bytes = bytearray()
        self.sent_before = 0
        threading.Thread(target=self.drain, daemon=True).start()

    def drain(self):
        try:
            while more := os.read(self.port, 4096):
                self.bytes += more
        except OSError:  # the ring has ended
            pass

    def tell(self, line):
        self.process.stdin.write(line + "\n")
        answer = []
        while not answer or not answer[-1].startswith(("ok ", "error")):
            answer.append(self.process.stdout.readline())
            assert answer[-1], "ring_board has ended"
        assert answer[-1].startswith("ok "), answer
        return answer[:-1]

    def measure(self):
        self.stats = {}
        for line in self.tell("stats"):
            name, *values = line.split()
            self.stats[name] = [float(v) for v in values]
        return self.stats

    def run(self, seconds):
        """The frames of that time, and how many chunks between delimiters were none."""
        self.tell(f"run {seconds}")
        self.measure()
        want = self.stats["sent_bytes"][0] - self.sent_before
        patience = time.monotonic() + 60
        while len(self.bytes) < want and time.monotonic() < patience:
            time.sleep(0.001)
        assert len(self.bytes) == want, (len(self.bytes), want)
        frames, bad = [], 0
        while b"\0" in self.bytes:
            end = self.bytes.index(0)
            self.sent_before += end + 1
            if end == 0:  # ahead of the first frame
                del self.bytes[0]
                continue
            raw = uncobs(bytes(self.bytes[:end]))
            good = raw and len(raw) == 42 and crc16(raw[:40]) == struct.unpack("<H", raw[40:])[0]
            frames, bad = (frames + [Frame(raw)], bad) if good else (frames, bad + 1)
            del self.bytes[: end + 1]
        return frames, bad

    def set(self, counts):
        self.tell(" ".join(map(str, counts)))

    def settle(self):
        self.set(COUNTS)
        frames, bad = self.run(0.05)
        assert frames and not bad
        assert_good(frames[-3:])
        return frames

    def end(self):
        self.tell("quit")
        assert self.process.wait(60) == 0


def assert_good(frames, counts=COUNTS):
    assert frames
    for frame in frames:
        assert frame.type == 1 and frame.flags == 0 and frame.counts == counts, frame


def assert_follow(frames):
    """Neither holes nor repetitions, and the clock goes on as the sequence does."""
    for a, b in zip(frames, frames[1:]):
        assert b.seq == (a.seq + 1) % 65536, (a, b)
        assert (b.t_us - a.t_us) % 2**32 in (3333, 3334), (a, b)


def without(sensors):
    return [0 if k in sensors else count for k, count in enumerate(COUNTS)]


def test_start():
    ring = Ring()
    ring.set(COUNTS)
    frames, bad = ring.run(0.05)
    assert bad == 0 and frames[0].seq == 0 and frames[0].flags & FIRST and not frames[0].flags & WATCHDOG, frames[0]
    assert frames[0].t_us < 10000 and not any(f.flags & FIRST for f in frames[1:])
    assert_follow(frames)
    assert_good(frames[4:])
    ring.end()


def test_rate(*options, baud, seconds):
    ring = Ring(*options)
    ring.settle()
    frames, bad = ring.run(seconds)
    assert bad == 0 and abs(len(frames) - 300 * seconds) <= 1, (bad, len(frames))
    assert_good(frames)
    assert_follow(frames)
    n = len(frames) - 1
    assert abs((frames[-1].t_us - frames[0].t_us) - n * 1e6 / 300) <= 1
    stats = ring.stats
    low, high, mean, count = stats["period_cycles"]
    assert abs(mean - 16e6 / 300) < 2 * 96 / count, mean  # only the two ends' interrupts are between
    assert 53333 - 96 <= low <= high <= 53334 + 96 and abs(count - 300 * seconds) <= 1, (low, high, count)  # 6 us
    assert stats["baud"] == [baud]
    for slot in range(4):
        least, most, _, _ = stats[f"begin{slot}_us"]
        at = START_US + slot * SLOT_US
        assert at - 10 < least <= most < at + 40, (slot, least, most)
    assert stats["hurried"] == [0], stats
    assert stats["faced"] == [0], stats  # no two sensors across the ring shine at a time
    print(f"{len(frames)} frames at {baud} Bd, 0 bad; period {low:.0f} to {high:.0f} cycles; "
          f"{stats['speed'][0]:.1f} times real time")
    print(f"begin {[stats[f'begin{s}_us'][:2] for s in range(4)]} us; put {stats['put_us']} us, get {stats['get_us']} us; "
          f"last byte {stats['last_byte_us'][:2]} us into the next period")
    print(f"SCL low {stats['scl_low_ns'][0]:.0f} ns, high {stats['scl_high_ns'][0]:.0f} ns, bit {stats['scl_bit_ns'][0]:.0f} ns; "
          f"awake {[stats[f'awake{b}'][0] for b in range(4)]}")
    ring.end()


def test_counts(ring):
    """Each sensor's count is in its place, to the bit; a dark sensor isn't a missing one, and a saturated one is told."""
    draw = random.Random(1)
    for _ in range(10):
        counts = [draw.choice([1, 2, 255, 256, 65534, 65535, draw.randrange(1, 65536)]) for _ in range(16)]
        ring.set(counts)
        frames, bad = ring.run(0.02)
        assert bad == 0
        assert_good(frames[2:], counts)
    ring.set([0] * 16)
    assert_good(ring.run(0.02)[0][2:], [1] * 16)
    ring.settle()


def test_fault(ring, begin, end, counts, flags, back=3):
    """While the fault lasts, every frame says so; afterwards frames are good again within `back` frames."""
    ring.tell(begin)
    frames, bad = ring.run(0.05)
    assert bad == 0 and len(frames) >= 14, frames
    for frame in frames[2:]:
        assert frame.flags & ~RECOVERED == flags and frame.counts == counts, (begin, frame)
    ring.tell(end)
    after, bad = ring.run(0.05)
    assert bad == 0
    assert_good(after[back:])
    assert_follow(frames + after)


def test_supply(ring):
    """A sensor whose supply has failed for a moment has forgotten its emitter's current: it is missing, never wrong."""
    for k in range(16):
        ring.run(0.0123)
        frames, _ = ring.run(10 / 3 * 1e-3 - (ring.stats["time_s"][0] % (1 / 300)) + 0.003)  # an idle moment
        ring.tell(f"mute {k}")
        ring.tell(f"unmute {k}")
        frames, bad = ring.run(0.03)
        assert bad == 0
        assert all(f.counts == COUNTS or f.counts == without([k]) for f in frames), (k, frames)
        assert_good(frames[3:])


def test_stuck(ring):
    """A sensor that was stopped in the middle of a byte is clocked free; one that holds on longer gets more clocks."""
    for clocks in (1, 9, 30, 300, 3000):
        ring.tell(f"stick 9 {clocks}")
        frames, bad = ring.run(0.1)
        assert bad == 0
        assert_follow(frames)
        assert all(f.counts == COUNTS or f.counts == without([9]) for f in frames)
        assert_good(frames[-3:])
    for k in range(8, 12):
        ring.tell(f"stick {k} 9")
    frames, bad = ring.run(0.05)
    assert bad == 0 and any(f.flags & RECOVERED for f in frames), frames
    assert_good(frames[4:])


def test_link(ring):
    """A block that was spoilt between the boards isn't used, not even half of its counts."""
    for count in (1, 5, 40):
        ring.tell(f"link-corrupt {count}")
        frames, bad = ring.run(0.03)
        assert bad == 0
        assert_follow(frames)
        for frame in frames:
            lost = [b for b in range(1, 4) if not any(frame.counts[4 * b : 4 * b + 4])]
            assert frame.counts == without([4 * b + l for b in lost for l in range(4)]), frame
            assert frame.flags == (MISSING | BOARD if lost else 0), frame
        assert any(f.flags for f in frames)
        assert_good(frames[6:])


def test_board_reset(ring):
    draw = random.Random(2)
    for n in range(12):
        board = n % 3 + 1
        ring.run(draw.uniform(0, 0.0033))
        ring.tell(f"reset {board}")
        frames, bad = ring.run(0.04)
        assert bad == 0
        assert_follow(frames)
        assert sum(bool(f.flags & BOARD_RESET) for f in frames) == 1, frames
        assert sum(f.counts != COUNTS for f in frames) <= 3, frames
        assert_good(frames[-3:])


def test_board_hang(ring):
    """A board that hangs may hold the bus between the boards; the watchdog ends it."""
    draw = random.Random(3)
    for n in range(12):
        board = n % 3 + 1
        ring.run(draw.uniform(0, 0.0033))
        ring.tell(f"hang {board}")
        frames, bad = ring.run(0.06)
        assert bad == 0
        assert_follow(frames)
        assert any(f.flags & BOARD for f in frames) and sum(bool(f.flags & BOARD_RESET) for f in frames) == 1, frames
        for frame in frames:
            assert frame.counts[:4] == COUNTS[:4], frame
        assert_good(frames[10:])


def test_leader_reset(ring):
    """Wherever board 0 is reset, also while another board sends it a byte, all begins anew."""
    draw = random.Random(4)
    ring.measure()
    before = ring.stats["link_recoveries"][0]
    for n in range(40):
        ring.run(draw.uniform(0.003, 0.0067))
        ring.tell("reset 0")
        frames, bad = ring.run(0.03)
        assert bad <= 1
        first = [k for k, f in enumerate(frames) if f.flags & FIRST]
        assert len(first) == 1 and first[0] <= 1, frames
        frames = frames[first[0] :]
        assert frames[0].seq == 0 and frames[0].t_us < 10000 and not frames[0].flags & WATCHDOG, frames[0]
        assert_follow(frames)
        assert_good(frames[4:])
    ring.measure()
    assert ring.stats["link_recoveries"][0] > before, "no reset has met a byte between the boards"


def test_leader_hang(ring):
    ring.tell("hang 0")
    frames, bad = ring.run(0.08)
    assert bad <= 1
    first = [k for k, f in enumerate(frames) if f.flags & FIRST]
    assert len(first) == 1 and first[0] <= 1 and frames[first[0]].flags & WATCHDOG, frames
    assert len(frames) > 15
    assert_follow(frames[first[0] :])
    assert_good(frames[-3:])


def main():
    test_start()
    test_rate(baud=500000, seconds=7)
    test_rate("--slow", baud=400000, seconds=1)
    ring = Ring()
    ring.settle()
    test_counts(ring)
    test_fault(ring, "mute 5", "unmute 5", without([5]), MISSING)
    test_fault(ring, "short 9", "unshort 9", without([9]), MISSING)
    test_fault(ring, "short 0", "unshort 0", without([0]), MISSING)
    for board in range(4):
        test_fault(ring, f"scl {board}", f"unscl {board}", without(range(4 * board, 4 * board + 4)), MISSING)
        if board:
            test_fault(ring, f"deaf {board}", f"undeaf {board}", without(range(4 * board, 4 * board + 4)), MISSING | BOARD)
    test_fault(ring, "slow 6", "unslow 6", without([6]), MISSING)
    test_fault(ring, "link-short", "link-free", without(range(4, 16)), MISSING | BOARD)
    test_supply(ring)
    test_stuck(ring)
    test_link(ring)
    test_board_reset(ring)
    test_board_hang(ring)
    test_leader_reset(ring)
    test_leader_hang(ring)
    ring.end()


main()
