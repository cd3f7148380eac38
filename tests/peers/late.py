"""late.py WHAT: is this machine too busy for WHAT in true time? For ten seconds one program wakes every millisecond, asks
another, which thinks as long as a drive's server in Python does (0.4 ms), and waits for its answer. If one in 1.5 s or more
comes over 4 ms late, prints the line with which a test is skipped and exits with 77; else prints how late they were and exits
with 1. A test may blame the machine only by this program, which has none of our code; it is asked while the test's other
programs go on, and with their priority.
"""
import os
import socket
import sys
import time

SECONDS = 10
EVERY = 1e-3  # s
THINKS = 0.4e-3  # s
LATE = 4e-3  # s; a device's feedback is too old after 5 ms
OFTEN = 1.5  # s; no session in true time comes far if something is late so often

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
end = time.monotonic() + SECONDS
while (begin := time.monotonic()) < end:
    time.sleep(EVERY)
    ours.send(b"q")
    ours.recv(1)
    over = time.monotonic() - begin - EVERY - THINKS
    turns += 1
    late += over > LATE
    worst = max(worst, over)
figures = f"{late} of {turns} answers late, worst {1e3 * worst:.1f} ms"
if late * OFTEN >= SECONDS:
    print(f"SKIP: this machine is too busy for {sys.argv[1]} in true time ({figures})")
    sys.exit(77)
print(figures)
sys.exit(1)
