"""A UUMotor SVD48V as its manual (V2.01) has it, by pymodbus, independent of ours and of libmodbus: its registers, its
checksum with the high byte first, its refusals, and two joints that its currents move.

svd48v_peer.py (--serial DEVICE | --tcp PORT) [--crc low-first] [--order high-first] [--unit N] [--lock-step S]
--lock-step: its time goes on by S with each set-point, and stands otherwise.
Says "ready NAME CONTROL": CONTROL is a UDP port of 127.0.0.1 that takes one command a datagram and answers with one line:
  state          instant, amperes of both motors, running of both, angles of both, instant of the last set-point that
                 wasn't zero, instant since when no torque acts (0: it acts)                          [s, A, -, rad, s]
  alarm          the drive stops with an alarm, until control command 2       volts V      its supply
  warn N         bit 17 of motor N's error word, though it goes on, until control command 2
  cycle          its power goes and comes back: counters from 0, as delivered  turn Q1 Q2  joints are put there, rad
  frozen N       encoder of joint N stands still                              reversed N  it counts the other way round
  dead           motors don't follow their set-points                         well        all of this ends
  free           nobody holds the joints        jump N  encoder N jumps by a quarter turn, -N: back
  old            its set-points stay at 0.5 A              end PID  ends another process, a line's, say
  hold           a hand holds the joints         at T WORDS...  a command at that instant of its time, or, T = asked, once torque is
  reaction       s from the last command that was due by "at" until no torque was asked for, -1: it is still
  mute N         N answers don't come         late N MS    N come late        garble N    N have a bit wrong
  stale N        N are those of the question before                           requests    how many came
  noise N BYTES  in the place of N answers BYTES come that are none
  noticed        s from noise to the next question, the least and the most since the last noise command
"""
import argparse
import asyncio
import math
import os
import signal
import socket
import time

from pymodbus import FramerType
from pymodbus.datastore import ModbusServerContext
from pymodbus.datastore.context import ModbusBaseSlaveContext
from pymodbus.framer.rtu import FramerRTU
from pymodbus.server import ModbusSerialServer, ModbusTcpServer

COUNTS = 4000 * 12 / (2 * math.pi)  # a radian of the joint
TORQUE = 0.0389 * 12                # Nm at the joint, an ampere
INERTIA, VISCOUS, FRICTION = 0.01, 0.02, 0.05
STOPS = (-1.0, 1.0)                 # rad, hard
STEP = 1e-4                         # s

# The tables of the manual, p. 15 and 23 to 26.
WRITABLE = {0x3008, 0x5100, 0x5101, 0x5300, 0x5301, 0x5304, 0x5305, 0x5308, 0x5309}
READABLE = WRITABLE | {0x3001, 0x5400, 0x5401, 0x5404, 0x5405, 0x5408, 0x540C, 0x540D, 0x5410, 0x5411, 0x5414, 0x5415,
                       *range(0x5418, 0x541C), *range(0x5420, 0x5424)}


def signed(word):
    return word - 65536 if word & 0x8000 else word


class Drive(ModbusBaseSlaveContext):
    def __init__(self, lock_step, low_first):
        self.lock_step, self.stepped = lock_step, 0.0
        self.low_first, self.errors = low_first, [0, 0]
        self.asked_until = 0.0
        self.when_asked = None
        self.due, self.broken_at, self.held_by_hand, self.line = [], -1.0, False, None
        self.q, self.w = [0.0, 0.0], [0.0, 0.0]
        self.at = self.now()
        self.volts, self.alarm, self.stuck = 480, False, False
        self.frozen, self.reversed, self.dead = [False] * 2, [False] * 2, False
        self.last_torque_at, self.zero_since = 0.0, self.at
        self.power_on()

    def power_on(self):
        self.words = dict.fromkeys(WRITABLE, 0)
        self.origin = list(self.q)
        self.running, self.alarm, self.errors = [0, 0], False, [0, 0]
        self.held = [None, None]

    def now(self):
        return self.stepped if self.lock_step else time.monotonic()

    # ---- the joints ----

    def current(self, i):
        """Tenths of an ampere that flow."""
        works = self.running[i] and self.words[0x3008] == 1 and self.words[0x5100 + i] == 2 and not self.dead
        return signed(self.words[0x5308 + i]) if works else 0

    def advance(self):
        now = self.now()
        steps = min(int((now - self.at) / STEP), 20000)
        self.at = self.at + steps * STEP if steps < 20000 else now
        for _ in range(steps):
            for i in range(0 if self.held_by_hand else 2):
                torque = TORQUE * 0.1 * self.current(i) - VISCOUS * self.w[i]
                if self.w[i] == 0 and abs(torque) <= FRICTION:
                    continue
                torque -= math.copysign(FRICTION, self.w[i] or torque)
                w = self.w[i] + torque / INERTIA * STEP
                self.w[i] = 0.0 if self.w[i] * w < 0 else w
                self.q[i] += self.w[i] * STEP
                if not STOPS[0] <= self.q[i] <= STOPS[1]:
                    self.q[i] = min(max(self.q[i], STOPS[0]), STOPS[1])
                    self.w[i] = 0.0

    def asks(self):
        return any(self.words[0x5308 + i] and self.words[0x5300 + i] == 1 for i in range(2))

    def count(self, i):
        n = round((self.q[i] - self.origin[i]) * COUNTS)
        if not self.frozen[i]:
            self.held[i] = None
        elif self.held[i] is None:
            self.held[i] = n
        n = n if self.held[i] is None else self.held[i]
        return (-n if self.reversed[i] else n) & 0xFFFFFFFF

    def mark(self, before):
        """When torque ends or begins."""
        acts = any(self.current(i) for i in range(2))
        if acts:
            self.last_torque_at, self.zero_since = self.now(), 0.0
        elif before:
            self.zero_since = self.now()

    # ---- registers ----

    def reset(self):
        pass

    def validate(self, fc_as_hex, address, count=1):
        table = READABLE if fc_as_hex == 3 else WRITABLE
        return fc_as_hex in (3, 6, 16) and all(address + k in table for k in range(count))

    def half(self, value, a):
        """Low order first, p. 11."""
        return value >> (16 * (a % 2 == self.low_first)) & 0xFFFF

    def word(self, a):
        if a in WRITABLE:
            return self.words[a]
        if a in (0x5400, 0x5401):
            return self.running[a - 0x5400]
        if a == 0x5408:
            return self.volts
        if a in (0x5414, 0x5415):
            return self.current(a - 0x5414) & 0xFFFF
        if 0x5418 <= a <= 0x541B:
            return self.half(self.count((a - 0x5418) // 2), a)
        if 0x5420 <= a <= 0x5423:
            return self.half(self.errors[(a - 0x5420) // 2], a)
        return 1 if a == 0x3001 else 250

    def getValues(self, fc_as_hex, address, count=1):
        self.advance()
        return [self.word(address + k) for k in range(count)]

    def setValues(self, fc_as_hex, address, values):
        if address <= 0x5308 < address + len(values):
            self.stepped += self.lock_step
        while self.due and self.due[0][0] <= self.now() + 1e-9:
            self.broken_at = self.now()
            self.command(self.due.pop(0)[1])
        self.advance()
        before, asked = any(self.current(i) for i in range(2)), self.asks()
        for k, value in enumerate(values):
            a = address + k
            if not (self.stuck and a in (0x5308, 0x5309)):
                self.words[a] = value
            if a in (0x5300, 0x5301):
                if value == 2:
                    self.alarm, self.errors[a - 0x5300] = False, 0
                self.running[a - 0x5300] = int(value == 1 and not self.alarm)
        self.mark(before)
        if self.when_asked and self.asks():
            command, self.when_asked, self.broken_at = self.when_asked, None, self.now()
            self.command(command)
        if asked and not self.asks():
            self.asked_until = self.now()

    # ---- what a test makes it do ----

    def command(self, text):
        self.advance()
        before, asked = any(self.current(i) for i in range(2)), self.asks()
        word, *rest = text.split()
        if word in LINE:
            return self.line.command(text)
        if word == "at":
            if rest[0] == "asked":
                self.when_asked = " ".join(rest[1:])
            else:
                self.due.append((float(rest[0]), " ".join(rest[1:])))
            self.due.sort(key=lambda due: due[0])
        elif word == "reaction":
            return f"{self.asked_until - self.broken_at if not self.asks() else -1:.6f}"
        elif word in ("hold", "free"):
            self.held_by_hand = word == "hold"
        elif word == "jump":
            self.origin[abs(int(rest[0])) - 1] += math.copysign(math.pi / 2, int(rest[0]))
        elif word == "old":
            self.stuck = True
            self.words[0x5308] = self.words[0x5309] = 5
        elif word == "end":
            os.kill(int(rest[0]), signal.SIGKILL)
        elif word == "alarm":
            self.alarm, self.running, self.errors = True, [0, 0], [1, 1]
        elif word == "warn":
            self.errors[int(rest[0]) - 1] = 1 << 17
        elif word == "volts":
            self.volts = round(10 * float(rest[0]))
        elif word == "cycle":
            self.power_on()
        elif word == "turn":
            self.q, self.w = [float(r) for r in rest], [0.0, 0.0]
        elif word == "frozen":
            self.frozen[int(rest[0]) - 1] = True
        elif word == "reversed":
            self.reversed[int(rest[0]) - 1] = True
        elif word == "dead":
            self.dead = True
        elif word == "well":
            self.frozen, self.reversed, self.dead, self.volts = [False] * 2, [False] * 2, False, 480
        elif word != "state":
            return "unknown"
        self.mark(before)
        if asked and not self.asks():
            self.asked_until = self.now()
        return " ".join(f"{x:.6f}" for x in (self.now(), *(0.1 * self.current(i) for i in range(2)), *self.running,
                                             *self.q, self.last_torque_at, self.zero_since))


LINE = ("mute", "late", "garble", "stale", "noise", "noticed", "requests")


class Line:
    """What happens to answers on their way."""

    def __init__(self):
        self.left, self.kind, self.wait, self.before, self.requests = 0, "", 0.0, b"", 0
        self.noise, self.noise_at, self.noticed = 0, None, []

    def pass_by(self, sending, data):
        if not sending:
            self.requests += 1
            if self.noise_at:
                self.noticed.append(time.monotonic() - self.noise_at)
                self.noise_at = None
            return data
        before, self.before = self.before, data
        if self.left <= 0:
            return data
        self.left -= 1
        if self.kind == "mute":
            return b""
        if self.kind == "noise":
            self.noise_at = time.monotonic()
            return b"\x55" * self.noise
        if self.kind == "late":
            time.sleep(self.wait)
        if self.kind == "garble":
            data = data[:3] + bytes([data[3] ^ 16]) + data[4:]
        return before if self.kind == "stale" and len(before) == len(data) else data

    def command(self, text):
        word, *rest = text.split()
        if word == "requests":
            return str(self.requests)
        if word == "noticed":
            return f"{min(self.noticed, default=-1):.6f} {max(self.noticed, default=-1):.6f}"
        self.kind, self.left = word, int(rest[0])
        if word == "noise":
            self.noise, self.noticed = int(rest[1]), []
            return "ok"
        self.wait = 1e-3 * float(rest[1]) if len(rest) > 1 else 0.0
        return "ok"


class Control(asyncio.DatagramProtocol):
    def __init__(self, drive, line):
        self.drive, self.line = drive, line

    def connection_made(self, transport):
        self.transport = transport

    def datagram_received(self, data, addr):
        text = data.decode()
        to = self.line if text.split()[0] in LINE else self.drive
        self.transport.sendto(to.command(text).encode(), addr)


async def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--serial")
    parser.add_argument("--tcp", type=int)
    parser.add_argument("--crc", default="high-first")
    parser.add_argument("--order", default="low-first")
    parser.add_argument("--unit", type=int, default=1)
    parser.add_argument("--lock-step", type=float, default=0.0)
    arg = parser.parse_args()
    if arg.crc == "high-first":  # every frame of the manual: EE 03 54 10 00 01 60 83
        standard = FramerRTU.compute_CRC
        FramerRTU.compute_CRC = classmethod(lambda cls, data: (lambda c: c >> 8 | (c & 0xFF) << 8)(standard(data)))
    drive, line = Drive(arg.lock_step, arg.order == "low-first"), Line()
    drive.line = line
    context = ModbusServerContext(slaves={arg.unit: drive}, single=False)
    options = {"ignore_missing_slaves": True, "trace_packet": line.pass_by}
    if arg.serial:
        server = ModbusSerialServer(context, framer=FramerType.RTU, port=arg.serial, baudrate=115200, **options)
        name = arg.serial
    else:
        port = arg.tcp
        if not port:
            with socket.socket() as s:
                s.bind(("127.0.0.1", 0))
                port = s.getsockname()[1]
        server = ModbusTcpServer(context, address=("127.0.0.1", port), **options)
        name = f"127.0.0.1:{port}"
    loop = asyncio.get_running_loop()
    control, _ = await loop.create_datagram_endpoint(lambda: Control(drive, line), local_addr=("127.0.0.1", 0))
    task = asyncio.create_task(server.serve_forever())
    while not server.transport:
        await asyncio.sleep(0.01)
    print("ready", name, control.get_extra_info("sockname")[1], flush=True)
    await task


asyncio.run(main())
