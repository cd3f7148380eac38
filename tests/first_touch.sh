#!/bin/sh
# "From the box to the first touch" (drivers/README.md), as it stands there, before what we didn't write or what is real: an
# SVD48V as its manual has it, by pymodbus, on a serial line at 500 kBd; the proximity ring's firmware in four simulated
# boards (simavr). Every command runs, and every line that the page promises must come. A machine too busy for a device in
# true time is a skip that says so.
set -u
. tests/peers/desk.sh
. tests/peers/board.sh
needs_board
. tests/peers/drive.sh
first_rank
drive svd48v
board
ALONE=$alone "$python3" tests/first_touch.py "$folder" "$line" "$control" $udp 6>&- 7>&-
