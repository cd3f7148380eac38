#!/bin/sh
# An installed tree is complete and readable, pkg-config and CMake find it, it can be moved, it links shared and static, and
# its path may have spaces and other names; after uninstalling only what was there before is left, also when installing was
# stopped on the way.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED $*"; exit 1; }
run() { # ROOT PREFIX TARGET...
  root=$1 prefix=$2
  shift 2
  $MAKE --no-print-directory -s B="$BUILD" DESTDIR="$root" PREFIX="$prefix" "$@" >"$work/log" 2>&1 || { cat "$work/log"; return 1; }
}
sanitizer=${SAN:+-fsanitize=$SAN}

# ---- into an empty root ----
root=$work/root at=$work/root/opt/ethd
mkdir -p "$root/opt/ethd/lib" "$root/opt/ethd/share/other" && : >"$root/opt/ethd/share/other/file"
run "$root" /opt/ethd install-files || fail "make install"
for header in include/ethd/*.h; do cmp "$header" "$at/$header"; done
for program in "$BUILD"/bin/ethd-*; do [ -x "$at/bin/${program##*/}" ] || fail "${program##*/} isn't installed"; done
for library in libethd libethd-drivers; do
  [ -f "$at/lib/$library.a" ] || fail "lib/$library.a isn't installed"
  [ "$(readlink "$at/lib/$library.so")" = $library.so.0 ] || fail "$library.so isn't a link to $library.so.0"
  readelf -d "$at/lib/$library.so.0" | grep -q "SONAME.*\[$library.so.0\]" || fail "the SONAME isn't $library.so.0"
done
cmp LICENSE "$at/share/doc/libethd/LICENSE" || fail "the licence isn't installed"
[ -z "$(find "$root" -type f ! -perm -444)" ] || fail "installed, but not readable by all"
diff -r -x installed "$BUILD/share/ethd" "$at/share/ethd" || fail "share/ethd differs"
if grep -rIlF -e "$PWD" -e "$BUILD" -e "$work" "$at/lib" "$at/include" "$at/share"; then fail "holds a path of the build"; fi
version=$(sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
for name in ethd ethd-drivers; do
  found=$(PKG_CONFIG_PATH=$at/lib/pkgconfig $PKG_CONFIG --modversion $name)
  [ -n "$version" ] && [ "$found" = "$version" ] || fail "$name.pc says version '$found', ethd.h '$version'"
done
mkdir "$work/other" && sed 's/^Version: .*/Version: 99.0.0/' "$at/lib/pkgconfig/ethd.pc" >"$work/other/ethd.pc"
PKG_CONFIG_PATH=$work/other:$at/lib/pkgconfig $PKG_CONFIG --exists ethd-drivers && fail "ethd-drivers takes another version's ethd"
echo '/opt/ethd/share/ethd/of_an_earlier_version' >>"$at/share/ethd/installed" && : >"$at/share/ethd/of_an_earlier_version"
run "$root" /opt/ethd install-files || fail "make install, again"
[ ! -e "$at/share/ethd/of_an_earlier_version" ] || fail "an earlier version's file stays"

# ---- moved, to a path with spaces; every public inline function and both libraries link ----
moved="$work/a tree"
mv "$at" "$moved"
export PKG_CONFIG_PATH="$moved/lib/pkgconfig" LD_LIBRARY_PATH="$moved/lib"
cat >"$work/inline.c" <<'END'
#include <ethd/maths.h>
#include <stdio.h>
int main(int argc, char **argv) {
  ethd_vec v = {3.0 * argc, 4.0 * argc};
  (void)argv;
  return printf("%g\n", ethd_vec_norm(v)) != 2;
}
END
cat >"$work/drivers.c" <<'END'
#include <ethd/config.h>
#include <ethd/conform.h>
#include <ethd/ethd.h>
#include <ethd/loop.h>
#include <ethd/record.h>
#include <ethd/sim.h>
#include <stdio.h>
int main(void) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd_loop_def def = ethd_loop_default();
  if (ethd_config_load(NULL, &config, message)) return puts(message), 1;
  int drivers = 0;
  while (ethd_drivers[drivers]) drivers++;
  printf("%s, %d drivers, %g s\n", config->setup.transition->law.id, drivers, def.period);
  ethd_config_free(config);
  return ethd_recording_verify("/nowhere", true, message) == ETHD_OK;
}
END
links() { # NAME FLAGS...: as pkg-config says it, words with spaces and all
  name=$1
  shift
  eval "$CC -O0 $sanitizer -Wall -Wextra -Werror '$work/$name.c' -o '$work/$name' $*" || fail "$name doesn't link: $*"
}
links inline "$($PKG_CONFIG --cflags --libs ethd)"
[ "$("$work/inline")" = 5 ] || fail "inline"
links drivers "$($PKG_CONFIG --cflags --libs ethd-drivers)"
shared=$("$work/drivers") || fail "the drivers' library: $shared"
readelf -d "$work/drivers" | grep -q 'NEEDED.*libethd-drivers.so.0' || fail "not the shared library"
# A program that was told where the drivers' library is, and calls nothing of the other: that one stands beside.
cat >"$work/beside.c" <<'END'
#include <ethd/loop.h>
int main(void) { return !(ethd_loop_default().period > 0); }
END
links beside "-Wl,--as-needed -Wl,-rpath,'$moved/lib' $($PKG_CONFIG --cflags --libs ethd-drivers)"
readelf -d "$work/beside" | grep -q 'NEEDED.*libethd.so.0' && fail "beside: it calls libethd itself"
env -u LD_LIBRARY_PATH "$work/beside" || fail "libethd-drivers doesn't find libethd beside itself"
if [ -z "$sanitizer" ]; then
  links inline "-static $($PKG_CONFIG --static --cflags --libs ethd)"
  [ "$("$work/inline")" = 5 ] || fail "inline, static"
  rm "$moved"/lib/*.so
  links drivers "$($PKG_CONFIG --static --cflags --libs ethd-drivers)"
  [ "$(env -u LD_LIBRARY_PATH "$work/drivers")" = "$shared" ] || fail "the drivers' archive"
  for library in libethd libethd-drivers; do ln -s $library.so.0 "$moved/lib/$library.so"; done
fi
cat >"$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(try C)
find_package(ethd 0.1 REQUIRED)
foreach(kind "" "-static")
  add_executable(inline${kind} inline.c)
  target_link_libraries(inline${kind} ethd::ethd${kind})
  add_executable(drivers${kind} drivers.c)
  target_link_libraries(drivers${kind} ethd::drivers${kind})
endforeach()
if(NOT EXISTS "${ETHD_DATA_DIR}/n.plant")
  message(FATAL_ERROR "ETHD_DATA_DIR is ${ETHD_DATA_DIR}")
endif()
function(asked found) # what find_package gets
  set(ethd_FOUND)
  find_package(ethd QUIET ${ARGN})
  if(NOT found STREQUAL "${ethd_FOUND}")
    message(FATAL_ERROR "find_package(ethd ${ARGN}): ${ethd_FOUND} ${ethd_NOT_FOUND_MESSAGE}")
  endif()
endfunction()
string(REGEX MATCH "^([0-9]+)[.]([0-9]+)" minor "${ethd_VERSION}")
math(EXPR next "${CMAKE_MATCH_2} + 1")
asked(1 ${ethd_VERSION})
asked(1 ${ethd_VERSION} EXACT)
asked(1 ${minor})
asked(1)
asked(0 ${CMAKE_MATCH_1}.${next})
asked(0 ${ethd_VERSION}.1 EXACT)
asked(0 ${ethd_VERSION}.1)
if(NOT CMAKE_VERSION VERSION_LESS 3.19)
  asked(1 ${minor}...<${CMAKE_MATCH_1}.${next})
  asked(1 0.0.1...2)
  asked(1 0.0.1...${ethd_VERSION})
  asked(0 0.0.1...<${ethd_VERSION})
  asked(0 0.0.1...0.0.9)
  asked(0 ${ethd_VERSION}.1...9)
endif()
asked(1 ${minor} COMPONENTS drivers ethd-static)
asked(1 OPTIONAL_COMPONENTS gpu)
asked(0 COMPONENTS drivers gpu)
find_package(ethd COMPONENTS gpu)
END
if command -v cmake >/dev/null; then
  env -u LD_LIBRARY_PATH CFLAGS="$sanitizer" cmake -S "$work" -B "$work/cmake" -DCMAKE_C_COMPILER="${CC%% *}" -DCMAKE_PREFIX_PATH="$moved" >"$work/log" 2>&1 &&
    env -u LD_LIBRARY_PATH cmake --build "$work/cmake" >>"$work/log" 2>&1 || { cat "$work/log"; fail "CMake"; }
  tr '\n' ' ' <"$work/log" | tr -s ' ' | grep -q 'ethd has no component gpu: ethd, drivers, ethd-static and drivers-static are known' ||
    fail "an unknown component: $(cat "$work/log")"
  for kind in "" -static; do
    [ "$("$work/cmake/inline$kind")" = 5 ] && [ "$("$work/cmake/drivers$kind")" = "$shared" ] || fail "CMake's programs$kind"
  done
else
  fail "no cmake, which .ci/setup check brings"
fi
unset PKG_CONFIG_PATH LD_LIBRARY_PATH
mv "$moved" "$at"

# ---- uninstalled ----
run "$root" /opt/ethd uninstall || fail "make uninstall"
left=$(cd "$root/opt/ethd" && find . | sort | tr '\n' ' ')
[ "$left" = ". ./lib ./share ./share/other ./share/other/file " ] || fail "after uninstall there is: $left"
run "$root" /opt/ethd uninstall && fail "uninstalled twice"
grep -q "nothing of ours is installed in $root/opt/ethd" "$work/log" || fail "twice: $(cat "$work/log")"

# ---- where it is built: its own sources would be what an uninstall takes away ----
mkdir "$work/source" && ln -s "$PWD/include" "$work/source/include"
run "" "$work/source" install-files && fail "into the source tree"
grep -q "^install: $work/source is where it is built: choose another place" "$work/log" || fail "into the source tree: $(cat "$work/log")"
[ "$(ls "$work/source")" = include ] || fail "into the source tree: $(ls "$work/source")"

# ---- into the system: it says what the loader needs; a path with spaces; no rights ----
run "" "$work/my tools" install-files || fail "a path with spaces"
grep -q "the loader doesn't search $work/my tools/lib yet: .* or set LD_LIBRARY_PATH=$work/my tools/lib" "$work/log" || fail "no word on the loader: $(cat "$work/log")"
eval "$CC $sanitizer '$work/drivers.c' -o '$work/drivers' $(PKG_CONFIG_PATH="$work/my tools/lib/pkgconfig" $PKG_CONFIG --cflags --libs ethd-drivers)"
[ "$(LD_LIBRARY_PATH="$work/my tools/lib" "$work/drivers")" = "$shared" ] || fail "from a path with spaces"
[ -n "$sanitizer" ] || "$work/my tools/bin/ethd-tap" --taps 1 >/dev/null || fail "ethd-tap from a path with spaces"
run "" "$work/my tools" uninstall || fail "uninstall from a path with spaces"
[ ! -e "$work/my tools" ] || fail "left: $(find "$work/my tools")"
run "" "$work/somebody's" install-files && [ -x "$work/somebody's/bin/ethd-tap" ] || fail "a path with a quote"
run "" "$work/somebody's" uninstall && [ ! -e "$work/somebody's" ] || fail "uninstall from a path with a quote"
run "" "$work/back\\new" install-files && [ -x "$work/back\\new/bin/ethd-tap" ] || fail "a path with a backslash"
grep -qF "the loader doesn't search $work/back\\new/lib yet" "$work/log" || fail "a backslash: $(cat "$work/log")"
run "" "$work/back\\new" uninstall && [ -z "$(find "$work" -name 'back*')" ] || fail "uninstall from a path with a backslash"
: >"$work/file"
run "" "$work/file/x" install-files && fail "below a file"
[ "$(grep -c 'sudo make install' "$work/log")" = 1 ] || fail "no rights: $(cat "$work/log")"
mkdir "$work/bin"
printf '#!/bin/sh\nexit 1\n' >"$work/bin/realpath" && chmod +x "$work/bin/realpath"
PATH=$work/bin:$PATH run "" "$work/no place" install-files && fail "without realpath"
[ "$(grep -c 'no place, says realpath' "$work/log")" = 1 ] && [ ! -e "$work/no place" ] || fail "without realpath: $(cat "$work/log")"
rm "$work/bin/realpath"
run "" relative install-files && fail "a relative path"
grep -q 'relative: PREFIX and LIBDIR begin with /' "$work/log" || fail "a relative path: $(cat "$work/log")"

# ---- stopped on the way, by a failure or killed: uninstalling leaves nothing, also when that is stopped first ----
stops() { # COMMAND CALL ACTION: that call of it is its last
  printf '#!/bin/sh\necho >>"$0.calls"\n[ "$(wc -l <"$0.calls")" -lt %s ] || { %s; exit 1; }\nexec %s "$@"\n' "$2" "$3" "$(command -v "$1")" >"$work/bin/$1"
  chmod +x "$work/bin/$1"
  : >"$work/bin/$1.calls"
}
nothing() { # WHAT
  [ ! -e "$work/on the way" ] || fail "$1 leaves $(find "$work/on the way" | sed -n '1,5p')"
}
on_the_way() { run "" "$work/on the way/ethd" "$@"; }
on_the_way install-files && grep -q "^share/ethd/n.ini$" "$work/on the way/ethd/share/ethd/installed" || fail "on the way: $(cat "$work/log")"
on_the_way uninstall || fail "uninstalled"
nothing "uninstalling"
for how in 'exit 1' 'kill -9 $PPID'; do
  for call in 2 3 40 150; do
    stops install $call "$how"
    PATH=$work/bin:$PATH on_the_way install-files >/dev/null 2>&1 && fail "install goes on after call $call of install: $how"
    [ $call = 2 ] || { on_the_way uninstall || fail "uninstall after call $call of install: $how"; }
    if [ "$call $how" = '2 kill -9 $PPID' ]; then find "$work/on the way" -depth -type d -exec rmdir '{}' +; fi # folders alone
    nothing "call $call of install, $how, then uninstall,"
  done
done
on_the_way install-files || fail "make install"
stops rm 20 'kill -9 $PPID'
PATH=$work/bin:$PATH on_the_way uninstall >/dev/null 2>&1 && fail "uninstall goes on after call 20 of rm"
on_the_way uninstall || fail "uninstall after an uninstall that was stopped"
nothing "uninstalling twice"

# ---- another name of the same place; a tree that was moved ----
mkdir "$work/real" && ln -s real "$work/link"
run "" "$work/none/..//link/ethd/" LIBDIR="$work/real/./ethd/lib/machine" install-files || fail "another name of a place"
[ "$(PKG_CONFIG_PATH=$work/link/ethd/lib/machine/pkgconfig $PKG_CONFIG --variable=prefix ethd)" = "$work/link/ethd/lib/machine/pkgconfig/../../.." ] ||
  fail "its prefix: $(cat "$work/real/ethd/lib/machine/pkgconfig/ethd.pc")"
note=$work/real/ethd/share/ethd/installed
sed -i "/^=/d; s|^[^/]|$work/link/ethd/&|; s|/[.]/$|/|" "$note" # as an older version has it
run "" "$work/real/ethd" LIBDIR="$work/real/ethd/lib/machine" install-files || fail "over an older version"
[ -x "$work/real/ethd/bin/ethd-tap" ] || fail "an older version takes away what the new one brought"
grep -q '^/.*ethd-' "$note" && fail "an older version's names stay: $(grep '^/' "$note")"
mv "$work/real/ethd" "$work/real/moved"
run "" "$work/real/ethd" install-files || fail "beside a tree that was moved"
run "" "$work/link/moved" uninstall || fail "uninstall of a tree that was moved"
[ ! -e "$work/real/moved" ] && [ -x "$work/real/ethd/bin/ethd-tap" ] || fail "a moved tree: $(find "$work/real" | sed -n '1,5p')"
run "" "$work/real/ethd/" uninstall || fail "uninstall by another name"
[ "$(find "$work/real")" = "$work/real" ] || fail "by another name: $(find "$work/real")"

# ---- a folder that is a link now: what the older version calls it isn't another file ----
mkdir -p "$work/linked/programs" && ln -s programs "$work/linked/bin"
run "" "$work/linked" install-files || fail "into a folder that is a link"
note=$work/linked/share/ethd/installed
sed -i "/^=/d; s|^[^/]|$work/linked/&|" "$note" # as an older version has it
run "" "$work/linked" install-files || fail "over an older version, into a folder that is a link"
[ -x "$work/linked/programs/ethd-tap" ] || fail "an older version takes away what the new one brought through a link"
mv "$work/linked/lib" "$work/linked/lib64" && ln -s lib64 "$work/linked/lib"
run "" "$work/linked" install-files || fail "into a folder that has become a link"
[ -f "$work/linked/lib64/libethd.a" ] || fail "the new library goes as the old one, through a link"
run "" "$work/linked" uninstall || fail "uninstall through links"
[ -z "$(find "$work/linked" -type f)" ] || fail "through links: $(find "$work/linked" -type f | sed -n '1,5p')"

# ---- two at once ----
mkdir "$work/at once"
exec 8<"$work/at once"
flock 8
$MAKE --no-print-directory -s B="$BUILD" DESTDIR= PREFIX="$work/at once" install-files >"$work/once" 2>&1 8<&- &
tries=0
until grep -q 'waiting for another one' "$work/once"; do
  tries=$((tries + 1))
  [ $tries -lt 600 ] && [ ! -e "$work/at once/bin" ] || fail "two at once: $(cat "$work/once")"
  sleep 0.1
done
exec 8<&-
wait $! || fail "after another one: $(cat "$work/once")"
run "" "$work/at once" uninstall || fail "after two at once"
[ "$(find "$work/at once")" = "$work/at once" ] || fail "two at once leave $(find "$work/at once" | sed -n '1,5p')"
mkdir "$work/unlocked"
for code in 71 127; do # no locks in this file system; no flock
  printf '#!/bin/sh\nexit %s\n' $code >"$work/unlocked/flock" && chmod +x "$work/unlocked/flock"
  PATH=$work/unlocked:$PATH run "" "$work/at once" install-files || fail "flock fails with $code: $(cat "$work/log")"
  grep -q waiting "$work/log" && fail "waits for nobody: $(cat "$work/log")"
  PATH=$work/unlocked:$PATH run "" "$work/at once" uninstall || fail "flock fails with $code: $(cat "$work/log")"
done

# ---- libraries beside the prefix, in a folder with a space and a & in its name ----
run "" "$work/my tools" LIBDIR="$work/lib & more" install-files || fail "LIBDIR"
eval "$CC $sanitizer '$work/inline.c' -o '$work/inline' $(PKG_CONFIG_PATH="$work/lib & more/pkgconfig" $PKG_CONFIG --cflags --libs ethd)"
rm -rf "$work/cmake"
CFLAGS="$sanitizer" cmake -S "$work" -B "$work/cmake" -DCMAKE_C_COMPILER="${CC%% *}" -DCMAKE_PREFIX_PATH="$work/lib & more/cmake" >"$work/log" 2>&1 ||
  fail "CMake: $(cat "$work/log")"
run "" "$work/my tools" LIBDIR="$work/lib & more" uninstall && [ ! -e "$work/my tools" ] && [ ! -e "$work/lib & more" ] || fail "LIBDIR, uninstalled"
# In a copy of a tree they are the original's; when a tree was moved they are its own.
run "" "$work/original" LIBDIR="$work/lib of the original" install-files && cp -a "$work/original" "$work/copy" || fail "libraries beside the original"
run "" "$work/copy" install-files && [ -f "$work/copy/lib/libethd.a" ] || fail "into a copy"
[ -f "$work/lib of the original/libethd.a" ] || fail "installing into a copy takes away the original's libraries"
rm -r "$work/copy" && cp -a "$work/original" "$work/copy"
run "" "$work/copy" uninstall && [ ! -e "$work/copy" ] || fail "uninstall of a copy: $(find "$work/copy" | sed -n '1,5p')"
[ -f "$work/lib of the original/libethd.a" ] || fail "uninstalling a copy takes away the original's libraries"
mv "$work/original" "$work/another"
run "" "$work/another" uninstall && [ ! -e "$work/another" ] && [ ! -e "$work/lib of the original" ] || fail "moved, with libraries beside it"
echo "$shared"
