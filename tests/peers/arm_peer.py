"""The controller of a robot arm that takes velocities over TCP at 500 Hz (apps/examples/tcp_arm.c), and a headset that
sees a finger before it: arm_peer.py TCP_PORT UDP_PORT FAULT SECONDS. Prints what the tool did, as JSON.

The arm follows a velocity with 8 m/s^2, and stops by itself when no order came for 0.1 s or the order says so. FAULT, after
1 s: none, late (states held back for 15 ms and sent at once), lost (each tenth), doubled (each tenth), damaged (a NaN), protective
(stop) or disconnect."""
import json
import math
import os
import socket
import struct
import sys
import time

RATE, ACCELERATION, GAP, WALL = 500, 8.0, 0.06, 0.3
tcp, udp, fault, seconds = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3], float(sys.argv[4])
server = socket.create_server(("127.0.0.1", tcp))
tracker = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
try:
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(60))
except PermissionError:
    pass
print("ready", flush=True)
server.settimeout(20)
line, exposures = server.accept()[0], 0
line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
line.setblocking(False)
x, v, order, heard = [0.0, 0.0, 0.2], [0.0] * 3, [0.0] * 3, 0.0
run, got, held, worst, most, hit, stopped = 0, b"", b"", 0.0, -1.0, -1.0, -1.0
begin = time.monotonic()
for tick in range(1, int(RATE * seconds)):
    pause = begin + tick / RATE - time.monotonic()
    worst = max(worst, -pause)
    time.sleep(max(0.0, pause))
    t = tick / RATE
    try:
        got += line.recv(4096) if line else b""
    except BlockingIOError:
        pass
    except ConnectionError:
        line = None
    while len(got) >= 32:
        _, run, *order = struct.unpack("<IIddd", got[:32])
        got, heard = got[32:], t
    wanted = order if run and t - heard < 0.1 and not (fault == "protective" and t > 1) else [0.0] * 3
    step = [w - u for w, u in zip(wanted, v)]
    length = math.hypot(*step)
    share = min(1.0, ACCELERATION / RATE / length) if length > 0 else 0.0
    v = [u + share * s for u, s in zip(v, step)]
    x = [p + u / RATE for p, u in zip(x, v)]
    # the finger waits, reaches through the wall at 0.3 m/s, and is stopped by the plate
    finger = min(0.3 * max(0.0, t - 1), x[0] + GAP)
    if finger >= x[0] + GAP - 1e-9 and hit < 0:
        hit = math.hypot(*v)
    most = max(most, x[0])
    stopped = t if math.hypot(*v) > 1e-3 else stopped
    late = fault == "late" and t > 1 and tick % 50 < 7
    seq_lost = fault == "lost" and t > 1 and tick % 10 == 0
    mode = 2 if fault == "protective" and t > 1 else 1
    place = math.nan if fault == "damaged" and t > 1 and tick % 10 == 0 else x[0]
    state = struct.pack("<IId3d3d", tick, mode, 100 + t, place, x[1], x[2], *v)
    if fault == "disconnect" and t > 1 and line:
        line.close()
        line = None
    try:
        if line and late:
            held += state
        elif line and not seq_lost:
            line.sendall(held + state + (state if fault == "doubled" and t > 1 and tick % 10 == 0 else b""))
            held = b""
    except (BlockingIOError, ConnectionError):
        pass
    if t * 90 >= exposures:
        exposures += 1
        datagram = {"seq": exposures, "t": time.monotonic(), "p": [finger, 0.0, 0.2], "noise": 1e-3}
        tracker.sendto(json.dumps(datagram).encode(), ("127.0.0.1", udp))
print(json.dumps({"most": most, "hit": hit, "stopped": stopped, "late": worst, "off": math.hypot(x[1], x[2] - 0.2)}))
