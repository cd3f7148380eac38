#!/bin/sh
# The proximity ring's firmware in four simulated boards: frames, rate, faults. All times are the simulation's.
set -eu
[ -n "${PYTHON:-}" ] || PYTHON=python3
[ -x "$BUILD/tests/ring_board" ] || { echo "SKIP: libsimavr, which runs the firmware (simavr), is absent"; exit 77; }
[ -f "$BUILD/firmware/proximity_ring.hex" ] || { echo "SKIP: avr-gcc, which makes the firmware for simavr, is absent"; exit 77; }
exec "$PYTHON" tests/proximity_firmware.py "$BUILD/tests/ring_board" "$BUILD/firmware/proximity_ring.elf"
