#!/bin/sh
# Devices that are described badly (each key of each shipped map, each setting of each driver) or come from bad files: one
# line, exit 1 or 2, and no motion. tests/bad_devices.py generates the cases; answers are damaged in servo/test_bad_frames.c,
# servo/test_servo_link.c and servo/test_servo_driver.c.
. tests/begin.sh
case ${SAN:-} in *thread*) echo "SKIP: six thousand starts under a thread sanitizer take too long"; exit 77 ;; esac
"${PYTHON:-python3}" tests/bad_devices.py "$BUILD/bin" apps/config "$BUILD/tests/plugins" "$folder"
