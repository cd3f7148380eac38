"""Measures how late this machine lets one program answer another: every millisecond one wakes, asks, and waits for the other,
which thinks as long as a drive's server in Python does (0.4 ms). When it is terminated, it prints one line, "late N of M in S
s, worst W ms", where N answers came more than 4 ms late. A test of a device in real time may blame the machine only if this
program, which has none of our code, says so.
"""
import os
import signal
import socket
import sys
import time

EVERY = 1e-3  # s
THINKS = 0.4e-3  # s
LATE = 4e-3  # s; a device's feedback is too old after 5 ms

ours, theirs = socket.socketpair()
if os.fork() == 0:
    ours.close()
    while theirs.recv(1):
        begin = time.thread_time()
        while time.thread_time() - begin < THINKS:
            pass
        theirs.send(b"a")
    os._exit(0)
theirs.close()

late = turns = 0
worst = 0.0
first = time.monotonic()


def end(*_):
    print(f"late {late} of {turns} in {time.monotonic() - first:.0f} s, worst {1e3 * worst:.1f} ms", flush=True)
    sys.exit(0)


signal.signal(signal.SIGTERM, end)
while True:
    begin = time.monotonic()
    time.sleep(EVERY)
    ours.send(b"q")
    ours.recv(1)
    over = time.monotonic() - begin - EVERY - THINKS
    turns += 1
    late += over > LATE
    worst = max(worst, over)
