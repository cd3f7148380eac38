#!/bin/sh
# The example mesh.c on balls of 320 to 81920 triangles: the end effector stands as far before the mesh as NumPy finds it from
# all triangles, and the difference from the ball itself falls as one over their number.
. tests/begin.sh
embree=
for version in 4 3; do
  printf '#include <embree%s/rtcore.h>\nint main(void) { rtcReleaseDevice(rtcNewDevice(0)); }\n' $version >"$folder/try.c"
  $CC "$folder/try.c" -o "$folder/try" -lembree$version 2>/dev/null && embree=-lembree$version && break
done
[ -n "$embree" ] && $PKG_CONFIG --exists assimp || { echo "SKIP: libembree-dev and libassimp-dev"; exit 77; }
$CC -std=gnu11 -O2 -Wall -Wextra -Werror ${SAN:+-fsanitize=$SAN} -Iinclude apps/examples/mesh.c -o "$folder/mesh" \
  "$BUILD/libethd.a" $($PKG_CONFIG --cflags --libs assimp) $embree -lm || fail "mesh.c doesn't compile"
"$PYTHON" tests/mesh.py "$folder/mesh" "$folder" || fail "mesh"
"$folder/mesh" "$folder/none.obj" 2>"$folder/err" && fail "a file that isn't there"
grep -q none.obj "$folder/err" || fail "$(cat "$folder/err")"
exit $failed
