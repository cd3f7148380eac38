"""How late this machine wakes a program up that asks for a millisecond: until it is terminated, then one line,
"late N of M, worst W ms", N the wake-ups that came more than 4 ms late. What a test of a device in true time can't reach
is the machine's doing only where this says so, which knows none of our code.
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
