#!/bin/sh
# Drivers in files of their own, [device] driver = file:NAME.so: one that is compiled against the installed headers behaves as
# the built-in one; several stand behind one device; bad ones get one line and nothing moves; a received folder loads none.
. tests/begin.sh
work=$folder
bin=$BUILD/bin
prefix=$work/usr
$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$prefix" install-files >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig"
# as the first lines of its source say
$CC -shared -fPIC -Wall -Wextra -Werror -DHELLO=ethd_driver_plugin drivers/hello/hello.c -o "$work/hello.so" \
  $($PKG_CONFIG --cflags ethd-drivers) || fail "hello.so"
ini() { printf '[device]\ndriver = %s\n' "$2" >"$work/$1.ini"; } # NAME DRIVERS

# ---- a good one ----
ini file file:hello.so
ini built_in hello
"$bin/ethd-conform" --config "$work/file.ini" --virtual --move >"$work/out" 2>&1 || fail "conform: $(cat "$work/out")"
[ "$(grep -c ' kept ' "$work/out")" = 10 ] || fail "conform: $(cat "$work/out")"
for how in file built_in; do
  (cd "$work" && printf 'wait 0.2\ntransition smooth\n' |
    "$bin/ethd-run" --virtual --duration 0.5 --config "$how.ini" --record "rec_$how" >"$how.out" 2>&1) || fail "$how: $(cat "$work/$how.out")"
done
cmp "$work/rec_file/tick.npy" "$work/rec_built_in/tick.npy" || fail "the file does otherwise than the built-in driver"
# the recording names the file wherever its folder goes, and is verified without it
grep -qx "driver = file:$work/hello.so" "$work/rec_file/config.ini" || fail "$(cat "$work/rec_file/config.ini")"
"$bin/ethd-replay" --verify "$work/rec_file" >"$work/out" 2>&1 || fail "verify: $(cat "$work/out")"
"$bin/ethd-run" --virtual --duration 0.1 --config "$work/rec_file/config.ini" >"$work/out" 2>&1 </dev/null || fail "from the recording: $(cat "$work/out")"
# several behind one device; a key names its driver; a shorter table is an older one
cp "$BUILD/tests/plugins/driver_canary.so" "$BUILD/tests/plugins/driver_older.so" "$work"
ini two 'sim ,  file:driver_canary.so'
"$bin/ethd-run" --virtual --duration 0.5 --config "$work/two.ini" >"$work/out" 2>&1 </dev/null || fail "two: $(cat "$work/out")"
ini older 'hello, file:driver_older.so'
"$bin/ethd-run" --virtual --duration 0.1 --config "$work/older.ini" >"$work/out" 2>&1 </dev/null || fail "older: $(cat "$work/out")"
if [ -z "${SAN:-}" ]; then # its own time
  "$bin/ethd-run" --duration 0.2 --config "$work/file.ini" >"$work/out" 2>&1 </dev/null || fail "in real time: $(cat "$work/out")"
fi

# ---- a file may use all that both libraries offer, whether or not its program does ----
. tests/declared.sh
declared >"$work/offered"
[ "$(wc -l <"$work/offered")" -gt 150 ] || fail "the libraries offer $(wc -l <"$work/offered") symbols"
{
  sed 's/.*/extern const char &[];/' "$work/offered" # the loader asks for the names alone
  echo 'const void *const everything[] = {'
  sed 's/$/,/' "$work/offered"
  echo '};'
} >"$work/everything.c"
$CC -shared -fPIC -DHELLO=ethd_driver_plugin drivers/hello/hello.c "$work/everything.c" -o "$work/uses_all.so" \
  $($PKG_CONFIG --cflags ethd-drivers) || fail "uses_all.so"
$CC -shared -fPIC apps/examples/law.c "$work/everything.c" -o "$work/law_uses_all.so" $($PKG_CONFIG --cflags ethd) ||
  fail "law_uses_all.so"
ini all file:uses_all.so
printf '[plugins]\nfile = law_uses_all.so\n[transition]\nlaw = mine\n' >"$work/law.ini"
loads() { "$@" >"$work/out" 2>&1 </dev/null || fail "a file that uses everything: $*: $(cat "$work/out")"; }
loads "$bin/ethd-run" --virtual --duration 0.1 --config "$work/all.ini"
loads "$bin/ethd-conform" --virtual --config "$work/all.ini"
loads "$bin/ethd-check" --open "$work/all.ini"
loads "$bin/ethd-tap" --taps 1 --config "$work/law.ini"
loads "$bin/ethd-check" --laws --plugin "$work/law_uses_all.so"
for program in "$bin"/ethd-*; do
  if head -c 2 "$program" | grep -q '#!'; then continue; fi # in Python
  nm -D --defined-only "$program" | awk '{ print $3 }' | sort | comm -23 "$work/offered" - >"$work/out"
  [ ! -s "$work/out" ] || fail "${program##*/} doesn't show: $(tr '\n' ' ' <"$work/out")"
done

# ---- bad ones: one line, and it ends before anything moves; what is said of each table is in unit/test_tables.c ----
says() { # NAME EXIT PATTERN FILE: the program's exit, and the one line that says why
  [ $code = "$2" ] || fail "$1: exit $code: $(cat "$work/out" "$work/err")"
  [ "$(wc -l <"$4")" = 1 ] && grep -q -e "$3" "$4" || fail "$1: no $3 in: $(cat "$4")"
  if LC_ALL=C grep -q '[^[:print:]]' "$4"; then fail "$1: a control character"; fi
}
refused() { # NAME EXIT PATTERN
  cp "$BUILD/tests/plugins/$1.so" "$work"
  ini bad "hello, file:$1.so"
  printf 'hang_time = 1\n' >>"$work/bad.ini"
  rm -rf "$work/rec"
  timeout -s KILL 30 "$bin/ethd-run" --config "$work/bad.ini" --virtual --duration 1 --record "$work/rec" >"$work/out" 2>"$work/err" </dev/null
  code=$?
  says "$1" "$2" "$3" "$work/err"
  [ ! -e "$work/rec/tick.npy" ] || fail "$1: ticks were made"
  timeout -s KILL 30 "$bin/ethd-conform" --config "$work/bad.ini" --virtual >"$work/out" 2>"$work/err" </dev/null
  code=$?
  grep '^table  *BROKEN' "$work/out" >"$work/table" || cp "$work/err" "$work/table" # where the program had to end itself
  says "$1, conform" 1 "$3" "$work/table"
}
refused driver_abi 2 'it was built for version 77 of the drivers. interface, this is version 4: '
refused driver_no_symbol 2 'it is no driver: it has no symbol ethd_driver_plugin'
refused mylaw 2 'it is no driver: it has no symbol ethd_driver_plugin'
refused driver_limits 2 'device broken: limits: speed: '
refused driver_units 1 'ask for more than 8 I/O threads'
refused driver_words 1 'AAA?AAA'
refused driver_hangs 1 "open of the driver broken doesn't return"
refused driver_exits 1 'open of the driver broken ended the program'
refused exits 1 'exits.so ended the program'
ini bad "hello, file:$BUILD/tests/plugins/driver_hangs_start.so"
printf 'hang_time = 1\n' >>"$work/bad.ini"
rm -rf "$work/rec"
timeout -s KILL 30 "$bin/ethd-run" --config "$work/bad.ini" --virtual --duration 1 --record "$work/rec" >"$work/out" 2>"$work/err" </dev/null
code=$?
says 'a start that hangs' 1 "start of the driver broken doesn't return" "$work/err"
grep -aq "'shape': (0,)" "$work/rec/tick.npy" || fail "a start that hangs: ticks were made"

# ---- ethd-check asks a driver's prepare and opens nothing; with --open it opens, and both are watched over ----
checked() { # NAME EXIT PATTERN [--open]
  cp "$BUILD/tests/plugins/$1.so" "$work"
  ini bad "hello, file:$1.so"
  printf 'hang_time = 1\n' >>"$work/bad.ini"
  timeout -s KILL 30 "$bin/ethd-check" ${4:-} "$work/bad.ini" >"$work/out" 2>"$work/err" </dev/null
  code=$?
  if [ "$2" = 0 ]; then
    [ $code = 0 ] && [ ! -s "$work/err" ] && grep -q -e "$3" "$work/out" || fail "check, $1: exit $code: $(cat "$work/out" "$work/err")"
  else
    says "check, $1" "$2" "$3" "$work/err"
  fi
}
checked driver_hangs 0 'hello, .*driver_hangs.so: read, not touched'
checked driver_hangs 0 'checks no setting before it is open'
checked driver_hangs 1 "open of the driver broken doesn't return" --open
checked driver_exits 0 'hello, .*driver_exits.so: read, not touched'
checked driver_exits 1 'open of the driver broken ended the program' --open
checked driver_hangs_prepare 1 "prepare of the driver broken doesn't return"
checked driver_exits_prepare 1 'prepare of the driver broken ended the program'
checked driver_hangs_limits 1 "open of the driver broken doesn't return" --open

words() { # DRIVERS KEYS PATTERN
  printf '[device]\ndriver = %s\n%b' "$1" "$2" >"$work/bad.ini"
  refuse 2 "$3" "$bin/ethd-run" --config "$work/bad.ini" --virtual --duration 1
}
echo 'no program' >"$work/text.so"
head -c 3000 "$work/hello.so" >"$work/cut.so"
words file:missing.so '' 'bad.ini: device.driver: "missing.so": .*missing.so: No such file'
words file:text.so '' "text.so is .*isn't a shared object"
words file:cut.so '' 'cut.so is cut short'
words file:. '' 'is no file'
words file: '' 'bad.ini: device.driver: found "file:.*file:PATH are allowed'
words 'file:hello.so, hello' '' 'device.driver: hello occurs twice'
words 'file:hello.so' 'colour = red\n' 'bad.ini:3: device.colour: hello has no settings'
words 'sim, file:hello.so' 'hello.colour = red\n' 'bad.ini:3: device.colour: hello has no settings'
words 'file:hello.so' 'hang_time = 0\n' 'bad.ini:3: device.hang_time: found "0", 1 to 3600 s is allowed'

# ---- what they offer ----
"$bin/ethd-check" --driver "$work/hello.so" >"$work/out" 2>&1 || fail "laws: $(cat "$work/out")"
laws=$(realpath "$bin/ethd-check")
(cd "$work" && "$laws" --driver hello.so) >"$work/out" 2>&1 || fail "laws, beside the file: $(cat "$work/out")"
grep -qx "device hello: two simulated motors; an example to copy" "$work/out" || fail "laws: $(cat "$work/out")"
"$bin/ethd-check" --driver "$BUILD/tests/plugins/driver_abi.so" >"$work/out" 2>"$work/err"
[ $? = 2 ] && grep -q 'built for version 77' "$work/err" || fail "laws: $(cat "$work/err")"
"$bin/ethd-check" --drivers --csv "$work/drivers.csv" >"$work/out" 2>&1 || fail "laws: $(cat "$work/out")"
for driver in sim counter servo ring zones nail camera hello; do
  grep -q "^device $driver: " "$work/out" || fail "laws: no $driver in: $(cat "$work/out")"
done
grep -q '^device,camera,rate,Hz,1,10000,90,' "$work/drivers.csv" || fail "$(cat "$work/drivers.csv")"

# ---- a stranger's recording: it is looked at, and its driver stays closed ----
canary=$work/canary
export canary
sed -i "s|^driver = .*|driver = file:$work/driver_canary.so|" "$work/rec_file/config.ini"
"$bin/ethd-replay" --verify "$work/rec_file" >"$work/out" 2>&1 || fail "a stranger's recording: $(cat "$work/out")"
"$bin/ethd-convert" "$work/rec_file" "$work/out.csv" >"$work/out" 2>&1 || fail "a stranger's recording: $(cat "$work/out")"
[ ! -e "$canary" ] || fail "a stranger's driver was loaded"
"$bin/ethd-run" --virtual --duration 0.1 --config "$work/two.ini" >/dev/null 2>&1 </dev/null
[ -e "$canary" ] || fail "the driver leaves no trace: the test sees nothing"
[ $failed = 0 ] && echo 'drivers in files do as built-in ones; bad ones are refused'
exit $failed
