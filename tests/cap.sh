#!/bin/sh
# The fit of a finger in a cap against scipy.optimize.least_squares, and its bound against numpy's inverse.
. tests/begin.sh
[ -z "${SAN:-}" ] || { echo "SKIP: Python doesn't load a sanitizer's library"; exit 77; }
"$PYTHON" -c 'import scipy.optimize' 2>/dev/null || { echo "SKIP: no python3-scipy"; exit 77; }
exec "$PYTHON" tests/cap.py "$BUILD/libethd.so.0"
