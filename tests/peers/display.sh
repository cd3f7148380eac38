# For tests: an X server of their own (Xvfb) in $server, its DISPLAY exported. Wants $folder. It stands when a client
# has been answered: the number that the server writes comes before that. It ends with the test.
server=
trap 'rm -rf "$folder"; [ -z "$server" ] || kill $server 2>/dev/null' EXIT
for program in Xvfb xdotool; do
  command -v $program >/dev/null || { echo "FAILED: no $program, which .ci/setup check brings"; exit 1; }
done
answered() {
  for _ in $(seq 600); do
    kill -0 $server 2>/dev/null || return 1
    if grep -q '^[0-9]' "$folder/display"; then
      DISPLAY=:$(cat "$folder/display")
      DISPLAY=$DISPLAY timeout 20 xdotool getdisplaygeometry >/dev/null 2>&1 && return
    fi
    sleep 0.1
  done
  return 1
}
# Two servers that begin at the same time may want the same number: the one that loses ends, and is started again.
for _ in 1 2 3; do
  : >"$folder/display"
  Xvfb -displayfd 3 -screen 0 1280x720x24 3>"$folder/display" >"$folder/xvfb" 2>&1 &
  server=$!
  answered && break
  kill $server 2>/dev/null
  wait $server 2>/dev/null
  server=
done
[ -n "$server" ] || { echo "FAILED: Xvfb gives no display: $(cat "$folder/xvfb")"; exit 1; }
export DISPLAY
