#!/bin/sh
# "From the box to the first touch" (drivers/README.md), as it stands there, before what we didn't write or what is real: an
# SVD48V as its manual has it, by pymodbus, on a serial line at 500 kBd; the proximity ring's firmware in four simulated
# boards (simavr). Every command runs, and every line that the page promises must come. A machine too busy for a device in
# true time is a skip that says so.
set -u
case ${SAN:-} in *thread*) echo "SKIP: a thread sanitizer's threads don't fit into the loop's stack"; exit 77 ;; esac
[ -x "$BUILD/tests/ring_board" ] || { echo "SKIP: libsimavr, which runs the firmware (simavr), is absent"; exit 77; }
[ -f "$BUILD/firmware/proximity_ring.elf" ] || { echo "SKIP: avr-gcc, which makes the firmware for simavr, is absent"; exit 77; }
folder=$(mktemp -d)
children=
finish() {
  for child in $children; do kill "$child" 2>/dev/null; done
  rm -rf "$folder"
}
trap finish EXIT
fail() { echo "FAILED $*"; exit 1; }
. tests/peers/pymodbus.sh
. tests/peers/drive.sh
# the other side of the lines would have a machine of its own
alone=
chrt -r 40 true 2>/dev/null && alone="chrt -r 40"
drive svd48v
udp=$((20000 + $$ % 20000))
mkfifo "$folder/board.in"
$alone "$BUILD/tests/ring_board" --link "$folder/ring" --udp $udp "$BUILD/firmware/proximity_ring.elf" <"$folder/board.in" >"$folder/board" 2>&1 7>&- &
children="$children $!"
exec 6>"$folder/board.in"
await "$folder/board" '/dev/'
ALONE=$alone "$python3" tests/first_touch.py "$folder" "$line" "$control" $udp 6>&- 7>&-
