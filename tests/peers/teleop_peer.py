"""Another side for apps/examples/teleop.c and robot.c, which sends nonsense of each kind among its words and prints how much.
  robot PORT SECONDS JUMP: a robot whose surface, from the middle of the time on, jumps by JUMP m and back twice a second.
  ring PORT SECONDS: a ring that goes from 250 to 240 mm. Both send words alone after SECONDS, until nobody hears them.
"""
import socket
import struct
import sys
import time

VERSION = 0x65746801  # as in teleop.h
side, port, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
line.settimeout(0.02)


def word(number, x, y=0.25, angle=0.0, shape=0.0, version=VERSION):
    return struct.pack("@IIdddd", version, number & 0xFFFFFFFF, x, y, angle, shape)


def nonsense(number):
    nan, inf = float("nan"), float("inf")
    good = word(number, 0.2)
    yield from (b"", b"x", good[:-1], good + b"x", good * 100, bytes(len(good)), b"\xff" * len(good))
    yield from (word(number, 0.2, version=VERSION + 1), word(number, nan), word(number, 0.2, nan), word(number, 0.2, 0.25, nan))
    yield from (word(number, 0.2, 0.25, 0, nan), word(number, inf), word(number, -1e300), word(number, 0.2, 0.25, 1e9))
    yield from (word(number, 0.2, 0.25, 0, 2), word(number + 100000, 0.2), word(number - 100000, 0.2))


def say(datagram):
    try:
        line.send(datagram)
        return 1
    except ConnectionRefusedError:
        return 0


def answered():
    try:
        return len(line.recv(100)) > 0
    except (ConnectionRefusedError, TimeoutError):
        return False


if side == "robot":
    jump = float(sys.argv[4])
    line.connect(("127.0.0.1", port))
    end = time.monotonic() + 10
    while not say(word(1, 0.238)) or not answered():  # until the ring hears and answers
        if time.monotonic() > end:
            sys.exit("no orders came")
        time.sleep(0.01)

    def place(t):
        return 0.238 + (jump if t > seconds / 2 and t * 4 % 2 < 1 else 0)

else:
    line.bind(("127.0.0.1", port))
    line.settimeout(10)
    line.connect(line.recvfrom(100)[1])

    def place(t):
        return 0.25 - min(t / seconds, 1) * 0.01


begin = time.monotonic()
sent, number, heard = 0, 1, True
while heard:
    t = time.monotonic() - begin
    number += 1
    heard = say(word(number, place(t)))
    if number % 20 == 0 and t < seconds:
        sent += sum(say(datagram) for datagram in nonsense(number + 1))
        say(word(number - 1, 0.2))  # overtaken
    time.sleep(0.005)
print(sent)
