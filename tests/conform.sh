#!/bin/sh
# ethd-conform on the drivers that need no hardware.
. tests/begin.sh
conform=$BUILD/bin/ethd-conform
printf '[device]\ndriver = hello\n' >"$folder/hello.ini"
# a finger that the ring doesn't feel leaves it alone
sed 's/^pad_stiffness = [0-9]*/pad_stiffness = 0/' apps/config/n.plant >"$folder/free.plant"
printf '[device]\ndriver = sim\nspeed = 0.001\nplant = free.plant\n' >"$folder/sim.ini"
printf '[device]\ndriver = sim\nspeed = 0.001\n' >"$folder/held.ini"
"$conform" --config "$folder/hello.ini" --virtual --move >"$folder/hello" 2>&1 || fail "hello: $(cat "$folder/hello")"
[ "$(grep -c ' kept ' "$folder/hello")" = 10 ] || fail "hello: $(cat "$folder/hello")"
"$conform" --config "$folder/sim.ini" --virtual --move --push 0.3 >"$folder/sim" 2>&1 || fail "sim: $(cat "$folder/sim")"
[ "$(grep -c ' kept ' "$folder/sim")" = 9 ] || fail "sim: $(cat "$folder/sim")"
grep -q '^watchdog  at risk' "$folder/sim" || fail "the simulated device has got a watchdog: $(cat "$folder/sim")"
"$conform" --config "$folder/hello.ini" >"$folder/still" 2>&1 || fail "in real time: $(cat "$folder/still")"
[ "$(grep -c ' not asked ' "$folder/still")" = 6 ] || fail "it may not move: $(cat "$folder/still")"
# a ring that meets its finger stands still with torque and without
"$conform" --config "$folder/held.ini" --virtual --move --push 0.3 >"$folder/held" 2>&1 || fail "held: $(cat "$folder/held")"
grep -q '^watchdog  not asked .*an obstacle' "$folder/held" || fail "held: $(cat "$folder/held")"
printf '[device]\ndriver = hello\ncolour = red\n' >"$folder/bad.ini"
"$conform" --config "$folder/bad.ini" >"$folder/bad" 2>&1 && fail "a setting that hello hasn't passes"
grep -q 'bad.ini:3: device.colour: hello has no settings' "$folder/bad" || fail "$(cat "$folder/bad")"

# A signal while the device moves: it is made safe, and one line says so. A shell's background jobs ignore SIGINT.
$CC -shared -fPIC -DHELLO=ethd_driver_plugin -Iinclude drivers/hello/hello.c -o "$folder/hello.so" || fail "hello.so"
printf '[device]\ndriver = file:hello.so\n' >"$folder/file.ini"
for signal in INT TERM HUP; do
  env --default-signal=INT "$conform" --config "$folder/file.ini" --move >"$folder/out" 2>"$folder/err" &
  conforming=$!
  sleep 1
  kill -s $signal $conforming
  wait $conforming
  code=$?
  [ $code = 1 ] || fail "SIG$signal: exit $code: $(cat "$folder/err")"
  grep -q '^restart   not asked  stopped$' "$folder/out" || fail "SIG$signal: $(cat "$folder/out")"
  [ "$(cat "$folder/err")" = "ethd-conform: stopped by a signal: the device is safe and closed, the rest isn't asked" ] ||
    fail "SIG$signal: $(cat "$folder/err")"
done
cat "$folder/hello"
exit $failed
