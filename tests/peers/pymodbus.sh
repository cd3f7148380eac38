# For tests: python3 with numpy in $python3, and pymodbus in the environment $venv; else the test is skipped.
python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy, which looks at what pymodbus' plant did"; exit 77; }
venv=$(sh .ci/venv pymodbus pymodbus==3.8.6 pyserial==3.5) || { echo "SKIP: the Python package pymodbus can't be had"; exit 77; }
await() { # FILE PATTERN
  for _ in $(seq 400); do
    grep -q -e "$2" "$1" 2>/dev/null && return
    sleep 0.05
  done
  fail "no $2 in $1: $(cat "$1")"
}
