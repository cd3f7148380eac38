# For tests with a device on the desk: a folder and children that are removed at the end, a test's messages, and python3 with
# numpy. Sourced first; drive.sh, plant.sh and board.sh put a device there.
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
python3=$(sh .ci/setup python) || { echo "SKIP: no python3 with numpy, which looks at what the device did"; exit 77; }
. tests/begin.sh
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$folder"
}
trap finish EXIT
trap 'exit 1' HUP INT PIPE TERM
await() { # FILE PATTERN
  for _ in $(seq 1200); do
    grep -q -e "$2" "$1" 2>/dev/null && return
    sleep 0.05
  done
  echo "FAILED no $2 in $1: $(cat "$1")"
  exit 1
}
run=$BUILD/bin/ethd-run
# Before a command: the other side of a line would have a machine of its own, and gets a priority of its own where that is
# granted. A test that runs in true time calls first_rank, and what it starts from then on has it.
alone=
first_rank() { if chrt -r 40 true 2>/dev/null; then alone="chrt -r 40"; fi; }
