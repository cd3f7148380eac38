# For tests: the simulated plant, and pymodbus as the server of a drive in front of it. Wants desk.sh.
. tests/peers/pymodbus.sh
plant() { # NAME ARGUMENTS...: its port in $plant, what it says in NAME.plant; it lives until descriptor 8 is closed
  name=$1
  shift
  rm -f "$folder/plant.in" "$folder/$name.plant"
  mkfifo "$folder/plant.in"
  $alone "$BUILD/tests/plant_bridge" "$@" <"$folder/plant.in" >"$folder/$name.plant" 2>&1 &
  plant_id=$!
  exec 8>"$folder/plant.in"
  await "$folder/$name.plant" '^port '
  plant=$(sed -n 's/^port //p' "$folder/$name.plant")
}
plant_ends() {
  exec 8>&-
  wait $plant_id
}
peer() { # ARGUMENTS...: its id in $peer, where it listens in $at
  rm -f "$folder/peer.out"
  $alone "$venv/bin/python" tests/peers/modbus_peer.py "$@" --plant "$plant" >"$folder/peer.out" 2>"$folder/peer.err" 8>&- &
  peer=$!
  children="$children $peer"
  await "$folder/peer.out" '^ready '
  at=$(sed -n 's/^ready //p' "$folder/peer.out")
}
