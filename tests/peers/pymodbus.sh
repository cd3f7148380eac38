# For tests: python3 with numpy in $python3, and pymodbus in the environment $venv; else the test is skipped.
python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy, which looks at what pymodbus' plant did"; exit 77; }
venv=$BUILD/peers/pymodbus
mkdir -p "$BUILD/peers"
# one at a time, of tests that run side by side
flock "$BUILD/peers/lock" sh -c '"$2/bin/python" -c "import pymodbus, serial" 2>/dev/null ||
  { "$1" -m venv --system-site-packages "$2" &&
    "$2/bin/pip" -q --disable-pip-version-check install pymodbus==3.8.6 pyserial==3.5; }' pymodbus "$python3" "$venv" >"$folder/pip" 2>&1 ||
  { tail -n 3 "$folder/pip"; echo "SKIP: the Python package pymodbus can't be had"; exit 77; }
