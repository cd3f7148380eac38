#!/bin/sh
# The surfaces of solids in space beside SciPy's: rotations, convex hulls, least squares in bounds, minima, and differences
# in time for the velocities of bodies that move.
. tests/begin.sh
if [ -n "${SAN:-}" ]; then echo "SKIP: Python can't load a sanitizer's library"; exit 77; fi
python=$(sh .ci/setup programs)
"$python" -c 'import scipy.optimize, scipy.spatial' 2>/dev/null || { echo "SKIP: SciPy (Debian: python3-scipy)"; exit 77; }
exec "$python" tests/solids.py "$BUILD/libethd.so.0"
