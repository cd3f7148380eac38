# For tests: the proximity ring's real firmware in four simulated boards (simavr), in real time. Needs desk.sh. If something
# is missing for it, $absent says what, and board mustn't be called.
absent=
[ -f "$BUILD/firmware/proximity_ring.elf" ] || absent="avr-gcc, which makes the firmware for simavr"
[ -x "$BUILD/tests/ring_board" ] || absent="libsimavr, which runs the firmware (simavr)"
needs_board() { [ -z "$absent" ] || { echo "SKIP: $absent, is absent"; exit 77; }; }
board() { # its line is $folder/ring, its sensors' counts come by UDP to $udp; it lives until descriptor 6 is closed
  udp=$((20000 + $$ % 20000))
  mkfifo "$folder/board.in"
  $alone "$BUILD/tests/ring_board" --link "$folder/ring" --udp $udp "$BUILD/firmware/proximity_ring.elf" \
    <"$folder/board.in" >"$folder/board" 2>&1 7>&- 8>&- &
  children="$children $!"
  exec 6>"$folder/board.in"
  await "$folder/board" '/dev/'
}
