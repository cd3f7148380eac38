#!/bin/sh
# ethd-scene: distances of points against numbers worked out by hand, the summary, and each refusal.
. tests/begin.sh
program=$BUILD/bin/ethd-scene
cd "$folder" || exit 1

cat >walls.scene <<'END'
# the paper's wall and things around it
halfplane -1 0 -0.238 material=soft
circle 3 4 1
box 3 -4 1 0.5 1.5707963267948966
polygon 10 0 12 0 12 1 11 1 11 2 10 2   # an L
segment 20 0 22 0
material soft k_e=500
END
# Columns in another order, one more, CRLF.
printf 'note,y_m,x_m\r\nwall,0.25,0.25\r\ninside,4,3\r\nfree,4,5\r\nbox,-4,4\r\nreflex,0.75,10.75\r\nnotch,1.25,11.5\r\nend,4,25\r\n' >points.csv
"$program" query --scene walls.scene --in points.csv --out out.csv || fail "query fails"
cat >expected.csv <<'END'
distance_m,nx,ny,object
0.012,-1,0,0
-1,any,any,1
1,-1,0,1
0.5,-1,0,2
-0.35355339059327379,-0.70710678118654757,-0.70710678118654757,3
0.25,0,-1,3
5,-0.6,-0.8,4
END
awk -F, '
  NR == FNR { line[NR] = $0; lines = NR; next }
  { n = split(line[FNR], want, ","); if (NF != n) bad = 1 }
  FNR == 1 { if ($0 != line[1]) bad = 1; next }
  { for (i = 1; i <= n; i++)
      if (want[i] != "any" && ($i - want[i] > 1e-14 || want[i] - $i > 1e-14)) { print FNR ": " $i ", not " want[i]; bad = 1 } }
  END { exit bad || FNR != lines }' expected.csv out.csv || fail "query's answers differ"
grep -q '^-0.35355339059327379,' out.csv || fail "fewer than 17 digits"

"$program" info walls.scene >info.txt || fail "info fails"
for line in '5 objects' 'halfplane  *1' 'segments: *7' 'materials: *1' 'x 2 to 22 m, y -5 to 5 m' 'build time:' \
  'memory: *[0-9]* bytes' 'out of reach: 4 of 5'; do
  grep -q "$line" info.txt || fail "info lacks: $line"
done
# An arm of 2 x 2.1 m reaches circle and box, (3, 4) - 1 and (3, -4) - 0.9.
printf '[arm]\nlink1 = 2\nlink2 = 2.1\n' >arm.ini
"$program" info walls.scene --config arm.ini | grep -q 'out of reach: 2 of 5' || fail "info ignores the configuration"

# What the arm can't reach, a controller isn't burdened with; numbers stay the file's.
printf 'circle 9 9 1\nhalfplane -1 0 -0.238\ncircle 9 -9 1\n' >far.scene
printf '[scene]\nfile = far.scene\n' >far.ini
printf 't_s,q1_rad,q2_rad,xf_m,yf_m,vxf_mps,vyf_mps\n0,1.5707963,0,0.25,0.25,0,0\n' >tick.csv
"$BUILD/bin/ethd-replay" --config far.ini --in tick.csv --out tick_out.csv >replay.txt || fail "the replay fails"
grep -q 'queried in 1, 2 objects out of reach dropped' replay.txt || fail "not told what was dropped: $(cat replay.txt)"
"$program" info far.scene | grep -q 'out of reach: 2 of 3' || fail "info doesn't say what would be dropped"

: >empty.scene
printf 'x_m,y_m\n1,2\n' >one.csv
"$program" query --scene empty.scene --in one.csv --out empty.csv || fail "an empty scene is refused"
grep -q '^inf,.*,-1$' empty.csv || fail "an empty scene has a nearest object"

"$program" --help | grep -q 'ethd-scene query --scene' || fail "no example in --help"
"$program" --help | grep -qx '  box X Y HALF_W HALF_H ANGLE \[material=NAME\]' || fail "--help doesn't show a box"
"$program" --version | grep -q . || fail "no version"

cat >drawing.svg <<'END'
<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="100mm" viewBox="0 0 200 100">
  <title>a room</title>
  <path fill="none" stroke="black" d="M10 10h180v80h-180z"/>
  <text x="20" y="20">a door</text>
  <circle cx="100" cy="50" r="10"/>
  <g display="none"><text>hidden</text></g>
</svg>
END
"$program" convert --in drawing.svg --out room.scene --origin 0.1,0.2 >convert.txt || fail "convert fails"
cat >expected.scene <<'END'
polyline 0.11 0.29 0.29 0.29 0.29 0.21 0.11 0.21 0.11 0.29
circle 0.2 0.25 0.01
END
"$program" convert --in expected.scene --out normal.scene >/dev/null && cmp expected.scene normal.scene ||
  fail "a scene isn't its own normal form"
awk 'NR == FNR { for (i = 1; i <= NF; i++) want[NR, i] = $i; next }
  { for (i = 1; i <= NF; i++) if (i == 1 ? $i != want[FNR, i] : $i - want[FNR, i] > 1e-15 || want[FNR, i] - $i > 1e-15) { print $i; bad = 1 } }
  END { exit bad || FNR != 2 }' expected.scene room.scene || fail "the drawing became: $(cat room.scene)"
for line in '2 objects, 4 segments' '1 user unit = 0.001 m; y up' 'corner at 0.1, 0.2 m, its size 0.2 x 0.1 m' 'left out: 2 text$'; do
  grep -q "$line" convert.txt || fail "convert doesn't say: $line"
done
"$program" convert --in walls.scene --out copy.scene >/dev/null || fail "a scene isn't written again"
"$program" query --scene copy.scene --in points.csv --out copy.csv && cmp out.csv copy.csv || fail "a copy gives other distances"

# The picture, and the CSV that its script draws alone.
if gnuplot -e 'set terminal pngcairo' </dev/null 2>/dev/null; then
  for scene in walls far room; do
    "$program" info $scene.scene --plot "$scene's.png" >plot.txt 2>&1 || fail "no picture of $scene: $(cat plot.txt)"
    [ "$(head -c 4 "$scene's.png" | tail -c 3)" = PNG ] || fail "$scene's picture is no PNG"
  done
  # The scenes that came along: half-planes alone. What is drawn is told by its colour: how many of its pixels, and where.
  cat >pixels.py <<'END'
import struct, sys, zlib
data = open(sys.argv[1], "rb").read()
w, h, depth, kind = struct.unpack(">IIBB", data[16:26])
assert (w, h) == (1400, 1250) and depth == 8 and kind in (2, 6), (w, h, depth, kind)
at, packed = 8, b""
while at < len(data):
    n, = struct.unpack(">I", data[at:at + 4])
    if data[at + 4:at + 8] == b"IDAT": packed += data[at + 8:at + 8 + n]
    at += n + 12
raw, size = zlib.decompress(packed), 3 if kind == 2 else 4
rows, before, line = [], bytearray(w * size), w * size + 1
for y in range(h):
    f, row = raw[y * line], bytearray(raw[y * line + 1:(y + 1) * line])
    for i in range(len(row)) if f else ():
        a, b, c = (row[i - size], before[i], before[i - size]) if i >= size else (0, before[i], 0)
        if f == 1: d = a
        elif f == 2: d = b
        elif f == 3: d = (a + b) // 2
        else: d = a if abs(b - c) <= abs(a - c) and abs(b - c) <= abs(a + b - 2 * c) else b if abs(a - c) <= abs(a + b - 2 * c) else c
        row[i] = (row[i] + d) & 255
    rows.append(row)
    before = row
def has(x, y, colour): return any(tuple(rows[y][size * i:size * i + 3]) == colour for i in range(x - 2, x + 3))
orange, grey = (0xd9, 0x8a, 0), (0x7a, 0x7a, 0x7a)
reach = [i for i in range(120, 1085) for y in range(140, 1110, 7) if tuple(rows[y][size * i:size * i + 3]) == orange]
scale, middle = (max(reach) - min(reach)), (max(reach) + min(reach)) / 2 # 1 m
column = lambda m: sum(has(round(middle + m * scale), y, grey) for y in range(140, 1110))
print(scale, column(0.238), column(0.368), column(-0.238))
END
  for scene in wall room; do
    "$program" info "$BUILD/share/ethd/$scene.scene" --plot $scene-shipped.png >plot.txt 2>&1 || fail "no picture of $scene.scene: $(cat plot.txt)"
    "${PYTHON:-python3}" pixels.py $scene-shipped.png >$scene.pixels || fail "$scene.scene: $(cat $scene.pixels)"
  done
  # The arm's reach is 1 m wide and nearly fills the picture; the wall at x = 0.238 m crosses it, the room's other at 0.368.
  awk 'NR == 1 { exit !($1 > 800 && $2 > 900 && $3 < 50 && $4 < 50) }' wall.pixels || fail "the wall isn't where it is: $(cat wall.pixels)"
  awk 'NR == 1 { exit !($1 > 800 && $2 > 900 && $3 > 900 && $4 < 50) }' room.pixels || fail "the room isn't where it is: $(cat room.pixels)"
  gnuplot -e "in='room''s.csv'; out='again.png'" "$BUILD/share/ethd/plot/scene.gp" && [ -s again.png ] ||
    fail "the script doesn't draw the CSV alone"
else
  "$program" info walls.scene --plot "walls's.png" >plot.txt 2>&1 && fail "a picture without gnuplot?"
fi
awk -F, '$1 == "solid" && $2 == 1 { r = sqrt(($3 - 3) ^ 2 + ($4 - 4) ^ 2); n += r > 0.999999 && r < 1.000001 } END { exit n != 96 }' "walls's.csv" ||
  fail "the circle isn't in the picture's CSV"
awk -F, '$1 == "solid" && $2 == 2 { x = $3 - 3; y = $4 + 4; if (x < 0) x = -x; if (y < 0) y = -y; n++; bad += x > 0.500001 || y > 1.000001; corners += x > 0.499999 && y > 0.999999 } END { exit n != 96 || bad || corners < 4 }' "walls's.csv" ||
  fail "the box isn't in the picture's CSV"
grep -q '^solid,3,10,0,2,0$' "walls's.csv" || fail "the polygon isn't in the picture's CSV"

# refused PATTERN ARGUMENTS...: nothing on stdout, nothing written over, no temporary file
kept=kept.csv* try=yes
echo old >kept.csv
refused() {
  pattern=$1
  shift
  refuse 2 "$pattern" "$program" "$@"
  [ ! -s out ] || fail "$*: says something on stdout"
}

printf 'circle 0 0 1\n\ncircle 0 0\n' >count.scene
printf 'polygon 0 0 1 1 1 0 0 1\n' >bow.scene
printf 'x_m\n1\n' >missing.csv
printf 'x_m,y_m\n1,\n' >hole.csv
printf 'x_m,y_m\n1,2e10\n' >far.csv
: >empty.csv2
q() { pattern=$1; scene=$2; points=$3; refused "$pattern" query --scene "$scene" --in "$points" --out kept.csv; }
q 'count.scene:3: .*circle.*found 2.*; circle X Y R is allowed' count.scene one.csv
q 'bow.scene:1: .*edges 0 and 2' bow.scene one.csv
q 'nowhere.scene: ' nowhere.scene one.csv
q '\.: ' . one.csv
q 'missing.csv:1: .*y_m' walls.scene missing.csv
q 'hole.csv:2: y_m: ' walls.scene hole.csv
q 'far.csv:2: y_m: .*2e+10' walls.scene far.csv
q 'empty.csv2' walls.scene empty.csv2
q 'nowhere.csv: ' walls.scene nowhere.csv
# a mark before UTF-8 is none of the text's, whatever the text is; UTF-16 is named; a drawing is told what makes a scene of it
{ printf '\357\273\277'; cat walls.scene; } >marked.scene
{ printf '\357\273\277'; cat points.csv; } >marked.csv
"$program" query --scene marked.scene --in marked.csv --out marked.out >marked.txt 2>&1 && cmp out.csv marked.out || fail "a mark before UTF-8 is taken for text: $(cat marked.txt)"
for file in n.ini n.plant svd48v.map; do { printf '\357\273\277'; cat "$BUILD/share/ethd/$file"; } >"marked-$file"; done
cp "$BUILD/share/ethd/wall.scene" "$BUILD/share/ethd/n.plant" .
"$BUILD/bin/ethd-check" marked-n.ini >marked.txt 2>&1 || fail "a configuration with a mark: $(cat marked.txt)"
{ sed '/^\[device\]/,$d' marked-n.ini; printf '[device]\ndriver = servo\nmap = marked-svd48v.map\n'; } >servo.ini
"$BUILD/bin/ethd-check" servo.ini >marked.txt 2>&1 || fail "a map with a mark: $(cat marked.txt)"
{ sed '/^\[device\]/,$d' marked-n.ini; printf '[device]\nplant = marked-n.plant\n'; } >planted.ini
"$BUILD/bin/ethd-check" planted.ini >marked.txt 2>&1 || fail "a plant with a mark: $(cat marked.txt)"
printf '\377\376h\0a\0' >wide.scene
refused 'wide.scene: its text is UTF-16: save it as UTF-8' info wide.scene
printf '<svg xmlns="http://www.w3.org/2000/svg"/>' >room.svg && cp room.svg room.txt && printf '  0\nSECTION\n' >room.dxf
for drawing in room.svg room.txt; do refused "$drawing: is a drawing, not a scene: ethd-scene convert --in DRAWING.svg --out NAME.scene" info $drawing; done
refused 'room.dxf: is a drawing, not a scene: ethd-scene convert' info room.dxf
# a solid with another side near by: 4 mm of a box, 2 mm of a triangle; walls of one side, and thick ones, are none
printf 'box 0.25 0.25 0.002 0.1 0\npolygon 0 0 1 0 0 0.002\ncapsule 0 0 1 0 0.006\nsegment 0 0 1 1\n' >thin.scene
"$program" info thin.scene | grep -q '^thin:  *2 solids are thinner than 10 mm, object 1 (polygon) is 2 mm: a ring .* pushed out on the other side; the force of a segment' || fail "thin solids: $("$program" info thin.scene)"
"$program" info walls.scene | grep -q '^thin' && fail "thick solids are called thin"
{ sed 's/^file = .*/file = thin.scene/' "$BUILD/share/ethd/n.ini"; } >thin.ini
"$BUILD/bin/ethd-check" thin.ini | grep -q '^scene  *2 solids are thinner' || fail "ethd-check doesn't name thin solids"
refused 'query, info or convert'
refused '"draw"' draw
refused 'query needs' query --scene walls.scene
refused 'no such argument' query walls.scene
refused 'info needs' info
refused 'for query' info walls.scene --in one.csv
refused 'no such argument' info walls.scene more
refused 'frobnicate' info --frobnicate walls.scene
refused 'count.scene:3: ' info count.scene
printf '<svg xmlns="http://www.w3.org/2000/svg" width="1mm" height="1mm">\n<text/></svg>\n' >text.svg
cp drawing.svg drawing.txt
refused 'text.svg: nothing that a scene can hold is drawn on its page' convert --in text.svg --out kept.csv
refused 'drawing.txt.*svg, .dxf or .scene' convert --in drawing.txt --out kept.csv
refused 'nowhere.svg' convert --in nowhere.svg --out kept.csv
refused 'convert needs' convert --in drawing.svg
refused 'are for drawings' convert --in walls.scene --out kept.csv --scale 2
refused 'tolerance: found "0"' convert --in drawing.svg --out kept.csv --tolerance 0
refused 'origin: found "1"' convert --in drawing.svg --out kept.csv --origin 1
refused 'for convert' info walls.scene --scale 2
refused 'for info' convert --in drawing.svg --out kept.csv --config x.ini
refused 'plot: found "x.pdf"' convert --in drawing.svg --out kept.csv --plot x.pdf
refused 'plot: found "x.pdf"' info walls.scene --plot x.pdf
refused 'nowhere.ini: ' info walls.scene --config nowhere.ini
[ $failed = 0 ] && echo "distances, summary and refusals as expected"
exit $failed
