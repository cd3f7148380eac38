#!/bin/sh
# An installed tree is complete and readable, pkg-config and CMake find it, it can be moved, it links shared and static, and
# its path may have spaces and other names; after uninstalling only what was there before is left, also when installing was
# stopped on the way.
set -eu
. tests/begin.sh
fail() { echo "FAILED $*"; exit 1; }
run() { # ROOT PREFIX TARGET...
  root=$1 prefix=$2
  shift 2
  $MAKE --no-print-directory -s B="$BUILD" DESTDIR="$root" PREFIX="$prefix" "$@" >"$folder/log" 2>&1 || { cat "$folder/log"; return 1; }
}
sanitizer=${SAN:+-fsanitize=$SAN}

# ---- into an empty root ----
root=$folder/root at=$folder/root/opt/ethd
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
if grep -rIlF -e "$PWD" -e "$BUILD" -e "$folder" "$at/lib" "$at/include" "$at/share"; then fail "holds a path of the build"; fi
version=$(sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
for name in ethd ethd-drivers; do
  found=$(PKG_CONFIG_PATH=$at/lib/pkgconfig $PKG_CONFIG --modversion $name)
  [ -n "$version" ] && [ "$found" = "$version" ] || fail "$name.pc says version '$found', ethd.h '$version'"
done
mkdir "$folder/other" && sed 's/^Version: .*/Version: 99.0.0/' "$at/lib/pkgconfig/ethd.pc" >"$folder/other/ethd.pc"
PKG_CONFIG_PATH=$folder/other:$at/lib/pkgconfig $PKG_CONFIG --exists ethd-drivers && fail "ethd-drivers takes another version's ethd"
echo 'share/ethd/of_an_earlier_version' >>"$at/share/ethd/installed" && : >"$at/share/ethd/of_an_earlier_version"
run "$root" /opt/ethd install-files || fail "make install, again"
[ ! -e "$at/share/ethd/of_an_earlier_version" ] || fail "an earlier version's file stays"

# ---- moved, to a path with spaces; every public inline function and both libraries link ----
moved="$folder/a tree"
mv "$at" "$moved"
export PKG_CONFIG_PATH="$moved/lib/pkgconfig" LD_LIBRARY_PATH="$moved/lib"
cat >"$folder/inline.c" <<'END'
#include <ethd/maths.h>
#include <stdio.h>
int main(int argc, char **argv) {
  ethd_vec v = {3.0 * argc, 4.0 * argc};
  (void)argv;
  return printf("%g\n", ethd_vec_norm(v)) != 2;
}
END
cat >"$folder/drivers.c" <<'END'
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
  return ethd_recording_verify("/nowhere", true, NULL, message) == ETHD_OK;
}
END
links() { # NAME FLAGS...: as pkg-config says it, words with spaces and all
  name=$1
  shift
  eval "$CC -O0 $sanitizer -Wall -Wextra -Werror '$folder/$name.c' -o '$folder/$name' $*" || fail "$name doesn't link: $*"
}
links inline "$($PKG_CONFIG --cflags --libs ethd)"
[ "$("$folder/inline")" = 5 ] || fail "inline"
links drivers "$($PKG_CONFIG --cflags --libs ethd-drivers)"
shared=$("$folder/drivers") || fail "the drivers' library: $shared"
readelf -d "$folder/drivers" | grep -q 'NEEDED.*libethd-drivers.so.0' || fail "not the shared library"
# A program that was told where the drivers' library is, and calls nothing of the other: that one stands beside.
cat >"$folder/beside.c" <<'END'
#include <ethd/loop.h>
int main(void) { return !(ethd_loop_default().period > 0); }
END
links beside "-Wl,--as-needed -Wl,-rpath,'$moved/lib' $($PKG_CONFIG --cflags --libs ethd-drivers)"
readelf -d "$folder/beside" | grep -q 'NEEDED.*libethd.so.0' && fail "beside: it calls libethd itself"
env -u LD_LIBRARY_PATH "$folder/beside" || fail "libethd-drivers doesn't find libethd beside itself"
if [ -z "$sanitizer" ]; then
  links inline "-static $($PKG_CONFIG --static --cflags --libs ethd)"
  [ "$("$folder/inline")" = 5 ] || fail "inline, static"
  rm "$moved"/lib/*.so
  links drivers "$($PKG_CONFIG --static --cflags --libs ethd-drivers)"
  [ "$(env -u LD_LIBRARY_PATH "$folder/drivers")" = "$shared" ] || fail "the drivers' archive"
  for library in libethd libethd-drivers; do ln -s $library.so.0 "$moved/lib/$library.so"; done
fi
cat >"$folder/CMakeLists.txt" <<'END'
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
  env -u LD_LIBRARY_PATH CFLAGS="$sanitizer" cmake -S "$folder" -B "$folder/cmake" -DCMAKE_C_COMPILER="${CC%% *}" -DCMAKE_PREFIX_PATH="$moved" >"$folder/log" 2>&1 &&
    env -u LD_LIBRARY_PATH cmake --build "$folder/cmake" >>"$folder/log" 2>&1 || { cat "$folder/log"; fail "CMake"; }
  tr '\n' ' ' <"$folder/log" | tr -s ' ' | grep -q 'ethd has no component gpu: ethd, drivers, ethd-static and drivers-static are known' ||
    fail "an unknown component: $(cat "$folder/log")"
  for kind in "" -static; do
    [ "$("$folder/cmake/inline$kind")" = 5 ] && [ "$("$folder/cmake/drivers$kind")" = "$shared" ] || fail "CMake's programs$kind"
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
grep -q "nothing of ours is installed in $root/opt/ethd" "$folder/log" || fail "twice: $(cat "$folder/log")"

# ---- where it is built: its own sources would be what an uninstall takes away ----
mkdir "$folder/source" && ln -s "$PWD/include" "$folder/source/include"
run "" "$folder/source" install-files && fail "into the source tree"
grep -q "^install: $folder/source is where it is built: choose another place" "$folder/log" || fail "into the source tree: $(cat "$folder/log")"
[ "$(ls "$folder/source")" = include ] || fail "into the source tree: $(ls "$folder/source")"

# ---- into the system: it says what the loader needs; a path with spaces; no rights ----
run "" "$folder/my tools" install-files || fail "a path with spaces"
grep -q "the loader doesn't search $folder/my tools/lib yet: .* or set LD_LIBRARY_PATH=$folder/my tools/lib" "$folder/log" || fail "no word on the loader: $(cat "$folder/log")"
eval "$CC $sanitizer '$folder/drivers.c' -o '$folder/drivers' $(PKG_CONFIG_PATH="$folder/my tools/lib/pkgconfig" $PKG_CONFIG --cflags --libs ethd-drivers)"
[ "$(LD_LIBRARY_PATH="$folder/my tools/lib" "$folder/drivers")" = "$shared" ] || fail "from a path with spaces"
[ -n "$sanitizer" ] || "$folder/my tools/bin/ethd-tap" --taps 1 >/dev/null || fail "ethd-tap from a path with spaces"
run "" "$folder/my tools" uninstall || fail "uninstall from a path with spaces"
[ ! -e "$folder/my tools" ] || fail "left: $(find "$folder/my tools")"
run "" "$folder/somebody's" install-files && [ -x "$folder/somebody's/bin/ethd-tap" ] || fail "a path with a quote"
run "" "$folder/somebody's" uninstall && [ ! -e "$folder/somebody's" ] || fail "uninstall from a path with a quote"
run "" "$folder/back\\new" install-files && [ -x "$folder/back\\new/bin/ethd-tap" ] || fail "a path with a backslash"
grep -qF "the loader doesn't search $folder/back\\new/lib yet" "$folder/log" || fail "a backslash: $(cat "$folder/log")"
run "" "$folder/back\\new" uninstall && [ -z "$(find "$folder" -name 'back*')" ] || fail "uninstall from a path with a backslash"
: >"$folder/file"
run "" "$folder/file/x" install-files && fail "below a file"
[ "$(grep -c 'sudo make install' "$folder/log")" = 1 ] || fail "no rights: $(cat "$folder/log")"
run "" relative install-files && fail "a relative path"
grep -q 'relative: PREFIX and LIBDIR begin with /' "$folder/log" || fail "a relative path: $(cat "$folder/log")"

# ---- stopped on the way, by a failure or killed: uninstalling leaves nothing, also when that is stopped first ----
mkdir "$folder/bin"
stops() { # COMMAND CALL ACTION: that call of it is its last
  printf '#!/bin/sh\necho >>"$0.calls"\n[ "$(wc -l <"$0.calls")" -lt %s ] || { %s; exit 1; }\nexec %s "$@"\n' "$2" "$3" "$(command -v "$1")" >"$folder/bin/$1"
  chmod +x "$folder/bin/$1"
  : >"$folder/bin/$1.calls"
}
nothing() { # WHAT
  [ ! -e "$folder/on the way" ] || fail "$1 leaves $(find "$folder/on the way" | sed -n '1,5p')"
}
on_the_way() { run "" "$folder/on the way/ethd" "$@"; }
on_the_way install-files && grep -q "^share/ethd/n.ini$" "$folder/on the way/ethd/share/ethd/installed" || fail "on the way: $(cat "$folder/log")"
on_the_way uninstall || fail "uninstalled"
nothing "uninstalling"
for how in 'exit 1' 'kill -9 $PPID'; do
  for call in 1 2 40 100; do
    stops install $call "$how"
    PATH=$folder/bin:$PATH on_the_way install-files >/dev/null 2>&1 && fail "install goes on after call $call of install: $how"
    on_the_way uninstall || fail "uninstall after call $call of install: $how"
    nothing "call $call of install, $how, then uninstall,"
  done
done
on_the_way install-files || fail "make install"
stops rm 20 'kill -9 $PPID'
PATH=$folder/bin:$PATH on_the_way uninstall >/dev/null 2>&1 && fail "uninstall goes on after call 20 of rm"
on_the_way uninstall || fail "uninstall after an uninstall that was stopped"
nothing "uninstalling twice"

# ---- a tree that was moved, beside a new one ----
run "" "$folder/first" install-files && mv "$folder/first" "$folder/moved" && run "" "$folder/first" install-files || fail "beside a tree that was moved"
run "" "$folder/moved" uninstall || fail "uninstall of a tree that was moved"
[ ! -e "$folder/moved" ] && [ -x "$folder/first/bin/ethd-tap" ] || fail "a moved tree: $(find "$folder/moved" | sed -n '1,5p')"
run "" "$folder/first/" uninstall && [ ! -e "$folder/first" ] || fail "uninstall: $(find "$folder/first" | sed -n '1,5p')"

# ---- libraries beside the prefix, in a folder with a space and a & in its name ----
run "" "$folder/my tools" LIBDIR="$folder/lib & more" install-files || fail "LIBDIR"
eval "$CC $sanitizer '$folder/inline.c' -o '$folder/inline' $(PKG_CONFIG_PATH="$folder/lib & more/pkgconfig" $PKG_CONFIG --cflags --libs ethd)"
rm -rf "$folder/cmake"
CFLAGS="$sanitizer" cmake -S "$folder" -B "$folder/cmake" -DCMAKE_C_COMPILER="${CC%% *}" -DCMAKE_PREFIX_PATH="$folder/lib & more/cmake" >"$folder/log" 2>&1 ||
  fail "CMake: $(cat "$folder/log")"
run "" "$folder/my tools" LIBDIR="$folder/lib & more" uninstall && [ ! -e "$folder/my tools" ] && [ ! -e "$folder/lib & more" ] || fail "LIBDIR, uninstalled"
echo "$shared"
