"""A motion capture's bridge in ten lines: sends a finger that wanders about (0.25, 0.25) to PORT, 90 times a second for
SECONDS. A real one takes x, y and the instant of the exposure from its maker's SDK instead."""
import math, socket, struct, sys, time

def crc16(data: bytes) -> int:  # MCRF4XX
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x8408 if crc & 1 else crc >> 1
    return crc

assert crc16(b"123456789") == 0x6F91
port, seconds = int(sys.argv[1]), float(sys.argv[2])
line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
begin = time.monotonic()
for seq in range(int(90 * seconds)):
    time.sleep(max(0.0, begin + seq / 90 - time.monotonic()))
    exposed = time.monotonic_ns()
    x, y = 0.25 + 1e-3 * math.cos(0.05 * seq), 0.25 + 1e-3 * math.sin(0.05 * seq)
    body = struct.pack("<4sIqdddH", b"EFC1", seq, exposed, x, y, 2e-4, 1)
    line.sendto(body + struct.pack("<H", crc16(body)), ("127.0.0.1", port))
