#!/bin/sh
# The example mesh.c on balls of 320 to 81920 triangles: the end effector stands as far before the mesh as NumPy finds it from
# all triangles, and the difference from the ball itself falls as one over their number.
. tests/begin.sh
embree=
for version in 4 3; do
  printf '#include <embree%s/rtcore.h>\nint main(void) { rtcReleaseDevice(rtcNewDevice(0)); }\n' $version >"$folder/try.c"
  $CC "$folder/try.c" -o "$folder/try" -lembree$version 2>/dev/null && embree=-lembree$version && break
done
[ -z "${SAN:-}" ] || { echo "SKIP: a sanitizer is too slow for a loop in true time"; exit 77; }
[ -n "$embree" ] && $PKG_CONFIG --exists assimp || { echo "SKIP: libembree-dev and libassimp-dev"; exit 77; }
$CC -std=gnu11 -O2 -Wall -Wextra -Werror -Iinclude apps/examples/mesh.c -o "$folder/mesh" \
  "$BUILD/libethd.a" $($PKG_CONFIG --cflags --libs assimp) $embree -lm || fail "mesh.c doesn't compile"
"$PYTHON" tests/mesh.py "$folder/mesh" "$folder" || fail "mesh"
"$folder/mesh" "$folder/none.obj" 2>"$folder/err" && fail "a file that isn't there"
grep -q none.obj "$folder/err" || fail "$(cat "$folder/err")"

# an arm taps a mesh under a law of one's own, as apps/README.md shows: in the end the plate stands at the box
$CC -shared -fPIC apps/examples/arm_law.c -Iinclude -o "$folder/mine.so" -lm || fail "arm_law.c"
{ printf '[plugins]\nfile = mine.so\n[transition]\nlaw = mine\n'; sed '/^\[scene\]/,$d' apps/config/ur5e.ini; } >"$folder/mesh.ini"
cp apps/config/ur5e.arm "$folder"
printf 'v %s\n' '-0.46 -0.6 -0.2' '0 -0.6 -0.2' '0 0.4 -0.2' '-0.46 0.4 -0.2' '-0.46 -0.6 0.8' '0 -0.6 0.8' '0 0.4 0.8' '-0.46 0.4 0.8' >"$folder/box.obj"
printf 'f %s\n' '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8' >>"$folder/box.obj"
$CC -std=gnu11 -O2 -Wall -Wextra -Werror -DMESH -Iinclude apps/examples/arm.c -o "$folder/arm" -L"$BUILD" -lethd-drivers -lethd \
  $($PKG_CONFIG --cflags --libs assimp) $embree -lm || fail "arm.c with a mesh doesn't compile"
LD_LIBRARY_PATH=$BUILD "$folder/arm" "$folder/mesh.ini" 5 "$folder/box.obj" >"$folder/arm.out" 2>&1 || fail "arm: $(cat "$folder/arm.out")"
tail -n 1 "$folder/arm.out" | awk '{ print $0; exit !($4 > -0.4605 && $4 < -0.4595 && $8 * $8 < 2.5e-7 && /armed, no fault/) }' || fail "the plate doesn't stand at the box"
exit $failed
