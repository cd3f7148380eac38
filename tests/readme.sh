#!/bin/sh
# The README's C: the first block is an application, the second a law; apps/README has one more application. Both compile against the installed
# library through pkg-config; the application runs; the law loads. Its picture is what today's programs draw.
set -eu
. tests/begin.sh
[ -f README.md ] || { echo "SKIP: there is no README.md"; exit 77; }
fail() { echo "README.md: $*"; exit 1; }

awk -v to="$folder" '
  /^```c[ \t\r]*$/ { n++; out = to "/" n ".c"; next }
  /^```/ { out = "" }
  out != "" { print >out }' README.md apps/README.md
[ -f "$folder/3.c" ] || fail "fewer than three blocks of C"
for n in 1 2 3; do
  example=apps/examples/$(echo 'wall law space' | cut -d' ' -f$n).c
  sed '1,/[*][/]$/d' "$example" | cmp - "$folder/$n.c" || fail "block $n isn't $example behind its first comment"
done
grep -q 'main *(' "$folder/1.c" || fail "the first block of C has no main"
grep -q 'ethd_plugin' "$folder/2.c" || fail "the second block of C has no ethd_plugin"

$MAKE --no-print-directory -s B="$BUILD" DESTDIR="$folder/root" PREFIX=/opt/ethd install-files >"$folder/log" 2>&1 ||
  { cat "$folder/log"; fail "make install failed"; }
export PKG_CONFIG_PATH="$folder/root/opt/ethd/lib/pkgconfig"
export LD_LIBRARY_PATH="$folder/root/opt/ethd/lib"
strict="-std=gnu11 -O2 -Wall -Wextra -Werror ${SAN:+-fsanitize=$SAN}"

$CC $strict "$folder/1.c" -o "$folder/app" $($PKG_CONFIG --cflags --libs ethd) || fail "the application doesn't compile"
(cd "$folder" && timeout 60 ./app >app.out 2>&1) || { cat "$folder/app.out"; fail "the application fails"; }
[ -s "$folder/app.out" ] || fail "the application says nothing"
$CC $strict "$folder/1.c" -o "$folder/static" $($PKG_CONFIG --cflags ethd) "$LD_LIBRARY_PATH/libethd.a" -lm -ldl ||
  fail "the application doesn't link with libethd.a"
(cd "$folder" && timeout 60 ./static >static.out 2>&1) || fail "the application fails with libethd.a"
cmp "$folder/app.out" "$folder/static.out"

$CC $strict -shared -fPIC "$folder/2.c" -o "$folder/law.so" $($PKG_CONFIG --cflags ethd) || fail "the law doesn't compile"
nm -D --defined-only "$folder/law.so" | grep -q ' ethd_plugin$' || fail "the law exports no ethd_plugin"
printf '[plugins]\nfile = law.so\n' >"$folder/law.ini"
"$BUILD/bin/ethd-check" "$folder/law.ini" >"$folder/check.out" 2>&1 || { cat "$folder/check.out"; fail "the law doesn't load"; }
# Its commands, in order, as they stand there, by somebody who has a clone and a home; demo and check aren't for a test.
if [ -z "${SAN:-}" ]; then
  tree=$PWD
  mkdir -p "$folder/home" "$folder/clone" && cp -r apps "$folder/clone"
  awk '/^```/ { code = !code } code || !/^    / { next } /^    make install/ { on = 1 } on' README.md | sed 's/^    //' >"$folder/walk.sh"
  [ "$(wc -l <"$folder/walk.sh")" = 8 ] || fail "these commands are found: $(cat "$folder/walk.sh")"
  (
    unset PKG_CONFIG_PATH LD_LIBRARY_PATH
    export HOME="$folder/home" MAKE BUILD tree
    cd "$folder/clone"
    { echo 'make() { [ "$1" = install ] && (cd "$tree" && command $MAKE --no-print-directory -s B="$BUILD" DESTDIR= "$2" install-files); }'; cat "$folder/walk.sh"; } >"$folder/all.sh"
    sh -e "$folder/all.sh" >"$folder/walk.out" 2>&1
  ) || { cat "$folder/walk.sh" "$folder/walk.out"; fail "its commands fail"; }
  cmp "$folder/app.out" - <<END || fail "its first program says something else"
$("$folder/clone/wall")
END
  grep -q '^mine  *low  *20 .* %' "$folder/walk.out" && [ -s "$folder/clone/taps/tick.npy" ] || fail "its law isn't tapped: $(cat "$folder/walk.out")"
  "$folder/home/.local/bin/ethd-check" "$folder/clone/mine/q.ini" | grep -q '^k_e *= 500 ' || fail "k_e isn't set"
  "$folder/home/.local/bin/ethd-check" "$folder/clone/mine.ini" | grep -q '^brake *= 80 ' || fail "brake isn't set"
fi
[ "$(wc -l <README.md)" -lt 150 ] || fail "$(wc -l <README.md) lines: fewer than 150 are read"

# The pictures: of these scripts and these ticks, which are the same everywhere; their pixels depend on gnuplot and its fonts.
taps=42a6338649e1bebc194926756e0336404236a2839d28dd79638cd85aaecf8729
arm=0271f95ee736ffbdf50c3041e468ab17066c3e98e7ee883d0b534796221000c3
"$BUILD/bin/ethd-tap" --taps 400 --transition smooth,offset,predictive --speed high --trace "$folder/taps" >/dev/null
"$BUILD/bin/ethd-tap" --arm ur5e --transition approach --trace "$folder/arm" >/dev/null
drawn() { [ "$(cat apps/plot/$1.gp "$folder/$1"/*.csv apps/plot/$1.png | sha256sum)" = "$2  -" ]; }
drawn taps $taps ||
  fail "the picture isn't what is drawn today. Look at a new one, and give its sum here:
  build/bin/ethd-tap --taps 400 --transition smooth,offset,predictive --speed high --trace traces
  gnuplot -e \"in='traces'; out='apps/plot/taps.png'; scale=0.7\" apps/plot/taps.gp
  cat apps/plot/taps.gp traces/*.csv apps/plot/taps.png | sha256sum"
drawn arm $arm ||
  fail "the arm's picture isn't what is drawn today. Look at a new one, and give its sum here:
  build/bin/ethd-tap --arm ur5e --transition approach --trace traces
  gnuplot -e \"in='traces/approach-0.4.csv'; out='apps/plot/arm.png'; scale=0.7\" apps/plot/arm.gp
  cat apps/plot/arm.gp traces/*.csv apps/plot/arm.png | sha256sum"

for n in 1 2; do echo "block $n: $(wc -l <"$folder/$n.c") lines"; done
cat "$folder/app.out" | head -n 5
