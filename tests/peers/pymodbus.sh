# For tests: pymodbus in the environment $venv; else the test is skipped.
venv=$(sh .ci/venv pymodbus pymodbus==3.8.6 pyserial==3.5) || { echo "SKIP: the Python package pymodbus can't be had"; exit 77; }
