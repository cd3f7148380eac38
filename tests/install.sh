#!/bin/sh
# Installed into an empty DESTDIR: everything there, readable, found by pkg-config; uninstalled: nothing left.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
prefix=/opt/ethd
at=$root$prefix
run() { $MAKE --no-print-directory -s B="$BUILD" DESTDIR="$root" PREFIX=$prefix "$@"; }
fail() { echo "$*"; exit 1; }

run install-files >"$work/log" 2>&1 || { cat "$work/log"; fail "make install failed"; }
mkdir -p "$at/share/other" && : >"$at/share/other/file" && : >"$at/include/other.h"

for header in include/ethd/*.h; do cmp "$header" "$at/$header"; done
for program in "$BUILD"/bin/ethd-*; do
  [ -x "$at/bin/${program##*/}" ] || fail "${program##*/} isn't installed"
done
for file in libethd.a libethd-drivers.a libethd.so.0 pkgconfig/ethd.pc; do
  [ -f "$at/lib/$file" ] || fail "lib/$file isn't installed"
done
[ "$(readlink "$at/lib/libethd.so")" = libethd.so.0 ] || fail "libethd.so isn't a link to libethd.so.0"
readelf -d "$at/lib/libethd.so.0" | grep -q 'SONAME.*\[libethd.so.0\]' || fail "the SONAME isn't libethd.so.0"
[ -z "$(find "$root" -type f ! -perm -444)" ] || fail "installed, but not readable by all"
diff -r "$BUILD/share/ethd" "$at/share/ethd" || fail "share/ethd differs"
if grep -rIlF -e "$PWD" -e "$BUILD" "$at/lib/pkgconfig" "$at/include" "$at/share"; then fail "holds a path of the build"; fi

version=$(sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
found=$(PKG_CONFIG_PATH=$at/lib/pkgconfig $PKG_CONFIG --modversion ethd)
[ -n "$version" ] && [ "$found" = "$version" ] || fail "ethd.pc says version '$found', ethd.h '$version'"

run uninstall >"$work/log" 2>&1 || { cat "$work/log"; fail "make uninstall failed"; }
left=$(cd "$at" && find . ! -type d | sort | tr '\n' ' ')
[ "$left" = "./include/other.h ./share/other/file " ] || fail "after uninstall there is: $left"
[ ! -d "$at/include/ethd" ] && [ ! -d "$at/share/ethd" ] || fail "uninstall left our folders"
