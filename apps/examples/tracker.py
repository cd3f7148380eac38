"""A tracker's bridge: sends a finger that circles about (0.25, 0.25, 0) to PORT, 90 times a second for SECONDS.

    python3 tracker.py PORT SECONDS

A real one takes position, instant and velocity from its maker's SDK instead; drivers/finger/README.md has the keys."""
import json, math, socket, sys, time

port, seconds = int(sys.argv[1]), float(sys.argv[2])
line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
begin = time.monotonic()
for seq in range(int(90 * seconds)):
    time.sleep(max(0.0, begin + seq / 90 - time.monotonic()))
    t = time.monotonic()
    angle, rate = 4.5 * (t - begin), 4.5
    finger = [0.25 + 1e-3 * math.cos(angle), 0.25 + 1e-3 * math.sin(angle), 0.0]
    v = [-1e-3 * rate * math.sin(angle), 1e-3 * rate * math.cos(angle), 0.0]
    datagram = {"seq": seq, "t": t, "p": finger, "noise": 2e-4, "v": v, "v_noise": 0.01}
    line.sendto(json.dumps(datagram).encode(), ("127.0.0.1", port))
