#!/bin/sh
# The reference of the arms' kinematics, tests/reference/arms.csv, beside Orocos KDL and MuJoCo.
#   BUILD=build sh tests/arm_kinematics.sh renew    writes it anew
. tests/begin.sh
/usr/bin/python3 -c 'import PyKDL' 2>/dev/null || { echo "SKIP: PyKDL (Debian: python3-pykdl)"; exit 77; }
venv=$(PYTHON=/usr/bin/python3 sh .ci/venv mujoco_python mujoco==3.3.7) || { echo "SKIP: MuJoCo from PyPI"; exit 77; }
exec "$venv/bin/python" tests/arm_kinematics.py "$@"
