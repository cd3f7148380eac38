"""Measures how late this machine wakes up a program that sleeps for a millisecond. When it is terminated, it prints one line,
"late N of M, worst W ms", where N wake-ups came more than 4 ms late. A test of a device in real time may blame the machine
only if this program, which has none of our code, says so.
"""
import signal
import sys
import time

LATE = 4e-3  # s; a device's feedback is too old after 5 ms

late = turns = 0
worst = 0.0


def end(*_):
    print(f"late {late} of {turns}, worst {1e3 * worst:.1f} ms", flush=True)
    sys.exit(0)


signal.signal(signal.SIGTERM, end)
while True:
    begin = time.monotonic()
    time.sleep(1e-3)
    over = time.monotonic() - begin - 1e-3
    turns += 1
    late += over > LATE
    worst = max(worst, over)
