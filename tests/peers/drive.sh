# For tests: a drive of another's making behind a serial line of 500 kBd. Wants pymodbus.sh, $folder, $BUILD, $venv, fail(); appends to
# $children what must be killed.
drive() { # KIND ARGUMENTS...: our end of its line in $line; tell speaks to it
  kind=$1
  shift
  rm -f "$folder/wire.in" "$folder/wire.out" "$folder/drive.out"
  mkfifo "$folder/wire.in"
  "$BUILD/tests/wire" "${baud:-500000}" <"$folder/wire.in" >"$folder/wire.out" &
  wire=$!
  exec 7>"$folder/wire.in"
  await "$folder/wire.out" '/dev/'
  read -r line theirs <"$folder/wire.out"
  "$venv/bin/python" "tests/peers/${kind}_peer.py" --serial "$theirs" "$@" >"$folder/drive.out" 2>"$folder/drive.err" 7>&- &
  drive=$!
  children="$children $wire $drive"
  await "$folder/drive.out" '^ready '
  control=$(sed -n 's/^ready [^ ]* //p' "$folder/drive.out")
}
drive_ends() {
  kill "$drive" 2>/dev/null
  wait "$drive" 2>/dev/null
  exec 7>&-
  wait "$wire"
}
tell() { # COMMAND...: its answer
  "$python3" - "$control" "$*" <<'END'
import socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.settimeout(10)
s.sendto(sys.argv[2].encode(), ("127.0.0.1", int(sys.argv[1])))
print(s.recv(512).decode())
END
}
slow_map() { # MAP OUT: a machine that is busy answers late; how late isn't what is tried
  sed -e 's/^response = .*/response = 0.5/' -e 's/^drain = .*/drain = 0.02/' "$1" >"$2"
}
servo_ini() { # NAME MAP LINES...: a configuration of the servo alone, behind $line
  name=$1 map_=$2
  shift 2
  { sed '/^\[device\]/,$d' apps/config/n.ini; printf '[device]\ndriver = servo\nmap = %s\nport = %s\n' "$map_" "$line"; printf '%s\n' "$@"; } >"$folder/$name.ini"
}
