# For tests with other people's software at the other end of a line: a folder that goes at the end with all children,
# fail, says, and pymodbus. Sourced first.
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
folder=$(mktemp -d)
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$folder"
}
trap finish EXIT
trap 'exit 1' HUP INT PIPE TERM
failed=0
fail() { echo "FAILED $*"; failed=1; }
says() { # FILE PATTERN...
  file=$1
  shift
  for pattern; do grep -q -e "$pattern" "$file" || { fail "no $pattern in:"; cat "$file"; }; done
}
run=$BUILD/bin/ethd-run
. tests/peers/pymodbus.sh
