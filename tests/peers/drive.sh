# For tests: a drive of another's making, by pymodbus, behind a serial line of 500 kBd. Wants desk.sh.
. tests/peers/pymodbus.sh
drive() { # KIND ARGUMENTS...: our end of its line in $line; tell speaks to it
  kind=$1
  shift
  rm -f "$folder/wire.in" "$folder/wire.out" "$folder/drive.out"
  mkfifo "$folder/wire.in"
  $alone "$BUILD/tests/wire" "${baud:-500000}" <"$folder/wire.in" >"$folder/wire.out" &
  wire=$!
  exec 7>"$folder/wire.in"
  await "$folder/wire.out" '/dev/'
  read -r line theirs <"$folder/wire.out"
  $alone "$venv/bin/python" "tests/peers/${kind}_peer.py" --serial "$theirs" "$@" >"$folder/drive.out" 2>"$folder/drive.err" 7>&- &
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
  { sed '/^\[device\]/,$d' apps/config/n.ini; printf '[limits]\nstop_time = 0.4\n[device]\ndriver = servo\nmap = %s\nport = %s\n' "$map_" "$line"; printf '%s\n' "$@"; } >"$folder/$name.ini"
}
# What goes wrong at a drive, in its own time: 5 ms an exchange, in lock-step with a virtual clock. A hand holds the joints, a
# wall pushes with 0.3 Nm, 0.64 A; asserted are the time until no torque is asked for any more, and what ethd-run says of it.
broken() { # NAME COMMANDS BOUND SENTENCE [MORE]: "reversed 1; 0.7=free" at 0.6 s or when they say; BOUND s, or never; $first comes before, $stiff is k_e
  drive svd48v --lock-step 0.005
  tell "${first:-hold}" >/dev/null
  servo_ini "$1" svd48v.map 'q1 = 1.5747963' 'q2 = 0' # the ring is 1 mm in the wall
  printf '\n[contact]\nk_e = %s\n' ${stiff:-1200} >>"$folder/$1.ini"
  sed -i 's/^law = offset/law = abrupt/; /^preset/d' "$folder/$1.ini"
  echo "$2" | tr ';' '\n' | while read -r command; do tell at $(echo "$command" | sed -n 's/=.*//p' | grep . || echo ${when:-0.6}) "${command#*=}" >/dev/null; done
  printf 'wait 0.4\nstatus\nwait 0.8\nstatus\n%s\nstop\n' "${5:-}" |
    "$run" --config "$folder/$1.ini" --virtual --duration 9 >"$folder/$1.out" 2>&1 || fail "$1: exit $?: $(cat "$folder/$1.out")"
  reaction=$(tell reaction)
  drive_ends
  [ -n "${when:-}" ] || says "$folder/$1.out" '^ok: t 0.4.* enabled, abrupt, .* torque -0.3000 .* no fault$'
  printf '%-12s no torque after %s s, allowed are %s\n' "$1" "$reaction" "$3"
  if [ "$3" = never ]; then
    says "$folder/$1.out" '^ok: t 1.2.* enabled, abrupt, .* no fault$'
  else
    says "$folder/$1.out" "^ok: t 1.2.* disabled, .* $4\$"
    awk -v is="$reaction" -v most="$3" 'BEGIN { exit !(is >= 0 && is <= most) }' || fail "$1: zero torque after $reaction s, not $3"
  fi
}
