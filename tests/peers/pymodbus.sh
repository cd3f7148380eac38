# For tests: python3 with numpy in $python3, and pymodbus in the environment $venv; else the test is skipped.
python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy, which looks at what pymodbus' plant did"; exit 77; }
venv=$(sh .ci/venv pymodbus pymodbus==3.8.6 pyserial==3.5) || { echo "SKIP: the Python package pymodbus can't be had"; exit 77; }
