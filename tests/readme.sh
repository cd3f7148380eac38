#!/bin/sh
# The README's C: the first block is an application, the second a law. Both compile against the installed
# library through pkg-config; the application runs; the law loads. Its picture is what today's programs draw.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ -f README.md ] || { echo "SKIP: there is no README.md"; exit 77; }
fail() { echo "README.md: $*"; exit 1; }

awk -v to="$work" '
  /^```c[ \t\r]*$/ { n++; out = to "/" n ".c"; next }
  /^```/ { out = "" }
  out != "" { print >out }' README.md
[ -f "$work/2.c" ] || fail "fewer than two blocks of C"
for n in 1 2; do
  example=apps/examples/$(echo 'wall law' | cut -d' ' -f$n).c
  sed '1,/[*][/]$/d' "$example" | cmp - "$work/$n.c" || fail "block $n isn't $example behind its first comment"
done
grep -q 'main *(' "$work/1.c" || fail "the first block of C has no main"
grep -q 'ethd_plugin' "$work/2.c" || fail "the second block of C has no ethd_plugin"

$MAKE --no-print-directory -s B="$BUILD" DESTDIR="$work/root" PREFIX=/opt/ethd install-files >"$work/log" 2>&1 ||
  { cat "$work/log"; fail "make install failed"; }
export PKG_CONFIG_PATH="$work/root/opt/ethd/lib/pkgconfig"
export LD_LIBRARY_PATH="$work/root/opt/ethd/lib"
strict="-std=gnu11 -O2 -Wall -Wextra -Werror ${SAN:+-fsanitize=$SAN}"

$CC $strict "$work/1.c" -o "$work/app" $($PKG_CONFIG --cflags --libs ethd) || fail "the application doesn't compile"
(cd "$work" && timeout 60 ./app >app.out 2>&1) || { cat "$work/app.out"; fail "the application fails"; }
[ -s "$work/app.out" ] || fail "the application says nothing"
$CC $strict "$work/1.c" -o "$work/static" $($PKG_CONFIG --cflags ethd) "$LD_LIBRARY_PATH/libethd.a" -lm -ldl ||
  fail "the application doesn't link with libethd.a"
(cd "$work" && timeout 60 ./static >static.out 2>&1) || fail "the application fails with libethd.a"
cmp "$work/app.out" "$work/static.out"

$CC $strict -shared -fPIC "$work/2.c" -o "$work/law.so" $($PKG_CONFIG --cflags ethd) || fail "the law doesn't compile"
nm -D --defined-only "$work/law.so" | grep -q ' ethd_plugin$' || fail "the law exports no ethd_plugin"
printf '[plugins]\nfile = law.so\n' >"$work/law.ini"
"$BUILD/bin/ethd-check" "$work/law.ini" >"$work/check.out" 2>&1 || { cat "$work/check.out"; fail "the law doesn't load"; }
# Its commands, in order, as they stand there, by somebody who has a clone and a home; demo and check aren't for a test.
if [ -z "${SAN:-}" ]; then
  tree=$PWD
  mkdir -p "$work/home" "$work/clone" && cp -r apps "$work/clone"
  awk '/^```/ { code = !code } code || !/^    / { next } /^    make install/ { on = 1 } on' README.md | sed 's/^    //' >"$work/walk.sh"
  [ "$(wc -l <"$work/walk.sh")" = 8 ] || fail "these commands are found: $(cat "$work/walk.sh")"
  (
    unset PKG_CONFIG_PATH LD_LIBRARY_PATH
    export HOME="$work/home" MAKE BUILD tree
    cd "$work/clone"
    { echo 'make() { [ "$1" = install ] && (cd "$tree" && command $MAKE --no-print-directory -s B="$BUILD" DESTDIR= "$2" install-files); }'; cat "$work/walk.sh"; } >"$work/all.sh"
    sh -e "$work/all.sh" >"$work/walk.out" 2>&1
  ) || { cat "$work/walk.sh" "$work/walk.out"; fail "its commands fail"; }
  cmp "$work/app.out" - <<END || fail "its first program says something else"
$("$work/clone/wall")
END
  grep -q '^mine  *low  *20 .* %' "$work/walk.out" && [ -s "$work/clone/taps/tick.npy" ] || fail "its law isn't tapped: $(cat "$work/walk.out")"
  "$work/home/.local/bin/ethd-check" "$work/clone/mine/q.ini" | grep -q '^k_e *= 500 ' || fail "k_e isn't set"
  "$work/home/.local/bin/ethd-check" "$work/clone/mine.ini" | grep -q '^brake *= 80 ' || fail "brake isn't set"
fi
[ "$(wc -l <README.md)" -lt 150 ] || fail "$(wc -l <README.md) lines: fewer than 150 are read"

# The pictures: of these scripts and these ticks, which are the same everywhere; their pixels depend on gnuplot and its fonts.
taps=42a6338649e1bebc194926756e0336404236a2839d28dd79638cd85aaecf8729
arm=cf851ee64961e3fa842cccb6916dd9706e2c31a43d2998a3eb1db4856a0ce277
"$BUILD/bin/ethd-tap" --taps 400 --transition smooth,offset,predictive --speed high --trace "$work/taps" >/dev/null
"$BUILD/bin/ethd-tap" --arm ur5e --transition approach --trace "$work/arm" >/dev/null
drawn() { [ "$(cat apps/plot/$1.gp "$work/$1"/*.csv apps/plot/$1.png | sha256sum)" = "$2  -" ]; }
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

for n in 1 2; do echo "block $n: $(wc -l <"$work/$n.c") lines"; done
cat "$work/app.out" | head -n 5
