#!/bin/sh
# What libethd.so and libethd-drivers.so show, what libethd.so needs; what the control side's objects need.
. tests/begin.sh
. tests/declared.sh
LC_ALL=C
export LC_ALL
so=$BUILD/libethd.so.0
fail() { echo "$*"; failed=1; }

exported() { nm -D --defined-only "$1" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort -u; }
exported "$so" >"$folder/exported"
exported "$BUILD/libethd-drivers.so.0" >"$folder/exported-drivers"
if [ -n "${SAN:-}" ]; then echo "SKIP: a sanitizer's build needs the sanitizer's symbols"; exit 77; fi

cat "$folder/exported" "$folder/exported-drivers" | grep -vE '^ethd_[a-z]' >"$folder/foreign" && fail "exported, but not called ethd_*:" && cat "$folder/foreign"
for archive in libethd.a libethd-drivers.a; do
  nm -g --defined-only "$BUILD/$archive" | awk 'NF == 3 { print $3 }' | grep -v '^ethd_' >"$folder/foreign" &&
    fail "$archive: global, but not called ethd_*:" && cat "$folder/foreign"
done
compare() { # NAME HEADER...: what the library of this name exports is what its headers declare
  name=$1
  shift
  declared "$@" | diff - "$folder/$name" >"$folder/diff" && return
  fail "$name: ETHD_API in its headers (<) differs from what the library exports (>):"
  cat "$folder/diff"
}
compare exported $(grep -L 'Links from libethd-drivers' include/ethd/*.h)
compare exported-drivers $(grep -l 'Links from libethd-drivers' include/ethd/*.h)

exact='fabs|floor|ceil|round|trunc|rint|nearbyint|lround|llround|lrint|llrint|fmin|fmax|copysign|fmod|remainder|nextafter|ldexp|frexp|scalbn|modf'
control="mem(cpy|move|set|cmp|chr)|sqrt|$exact"
# The compiler's own: start files of a shared object, integer helpers of 32-bit machines.
compiler='_GLOBAL_OFFSET_TABLE_|__cxa_finalize|__gmon_start__|_ITM_(de)?registerTMCloneTable|__u?(div|mod|divmod|mul|ashl|ashr|lshr)[sdt]i[34]|__aeabi_[a-z0-9_]+'
library="$control|str[a-z]+|malloc|calloc|free|aligned_alloc|dl(open|sym|close|error)|__isoc23_str[a-z]+"

needs() { nm -u "$@" | awk 'NF >= 2 { sub(/@.*/, "", $2); print $2 }' | sort -u; }
needs "$so" | grep -vxE "$library|$compiler" >"$folder/so" && fail "libethd.so needs what it may not:" && cat "$folder/so"
for object in $RT_OBJECTS; do
  needs "$object" | grep -vxE "$control|ethd_[a-z0-9_]+|$compiler" >"$folder/object" &&
    fail "$object, of the control side, needs what it may not:" && cat "$folder/object"
done
# The loop's thread sleeps and reads the clock, by Xenomai's names where it is built for that.
clock='(__cobalt_)?clock_(nanosleep|gettime)'
for object in $LOOP_OBJECTS; do
  needs "$object" | grep -vxE "$control|$clock|ethd_[a-z0-9_]+|$compiler" >"$folder/object" &&
    fail "$object, of the loop's thread, needs what it may not:" && cat "$folder/object"
done
# The C library's text depends on the process's locale: drivers/runtime/text/locale.c alone asks for it. lib's parser gives strtod digits
# without a point; ini.c and camera.c set a locale while inih and jansson read.
local='(__)?(isoc[0-9]+_)?v?([fd]|sn?|as)?w?(printf|scanf)(_chk)?|(__isoc[0-9]+_)?(strto(d|f|ld)|wcsto[a-z]+)|atof|strf(rom.*|mon|ptime)|__ctype_.*|is(alnum|alpha|blank|cntrl|digit|graph|lower|print|punct|space|upper|xdigit)|to(upper|lower)|strn?casecmp|strcasestr|(str|wcs)(coll|xfrm)|alphasort|glob|fnmatch|regcomp|x?p?str?error(_r)?|perror|mb[a-z]+|wc[a-z]+|isw[a-z]+|(set|use|new|dup)locale|localeconv|nl_langinfo'
nm -A -u "$BUILD/libethd.a" "$BUILD/libethd-drivers.a" "$BUILD/libethd-apps.a" "$BUILD"/obj/apps/ethd-*.o |
  awk '{ sub(/@.*/, "", $NF); sub(/:[^:]*$/, "", $1); print $1, $NF }' | grep -E " ($local)\$" |
  grep -vE ':locale.o |libethd.a:text.o strtod$|:(ini|camera).o uselocale$' >"$folder/local" &&
  fail "text that depends on the process's locale (see drivers/runtime/text/locale.h):" && cat "$folder/local"
echo "$(wc -l <"$folder/exported") exported, $(echo $RT_OBJECTS $LOOP_OBJECTS | wc -w) objects of the control side"
exit $failed
