# A scene, the boxes of its trees by level, and the arm's reach.
#   gnuplot -e "in='walls.csv'; out='walls.png'" scene.gp
# in: a file of ethd-scene info --plot. name may be left out; x0, x1, y0, y1 (m) show a part.
if (!exists("in") || !exists("out")) { print "scene.gp: set in and out: gnuplot -e \"in='x.csv'; out='x.png'\" scene.gp"; exit status 2 }
if (!exists("name")) name = in

set terminal pngcairo size 1400,1250 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders

is(what) = strcol("what") eq what
bounded(x) = is("wall") || is("solid") || is("box")
pieces = 0
boxes = 0
stats in using (pieces = pieces + bounded(0), boxes = boxes + is("box"), 0) nooutput
# What the picture shows: the bounded objects; half-planes alone: the arm's reach.
shown(v) = (pieces > 0 ? bounded(0) : is("reach")) ? v : NaN
stats in using (shown(column("x_m"))) nooutput name "X"
stats in using (shown(column("y_m"))) nooutput name "Y"
least = 1
levels = 0
if (boxes > 0) {
  stats in using (is("box") ? column("number") : NaN) nooutput name "L"
  least = int(L_min)
  levels = int(L_max)
}
margin = 0.06 * (X_max - X_min > Y_max - Y_min ? X_max - X_min : Y_max - Y_min)
if (margin == 0) margin = 0.1
if (!exists("x0")) x0 = X_min - margin
if (!exists("x1")) x1 = X_max + margin
if (!exists("y0")) y0 = Y_min - margin
if (!exists("y1")) y1 = Y_max + margin

set size ratio -1
set xrange [x0:x1]
set yrange [y0:y1]
set grid lc rgb "#ececec" lt 1 lw 1
set border 3 lc rgb "#7a7a7a"
set tics nomirror textcolor rgb "#333333" scale 0.6
set xlabel "x, m"
set ylabel "y, m" offset 1
set key outside right top Left reverse samplen 2 spacing 1.3
set title (levels > 0 ? sprintf("%s: its objects and the boxes of its trees, levels %d to %d", name, least, levels) \
                      : sprintf("%s: its objects; too few for a tree", name)) noenhanced font "Sans Bold,17"

# The leaves' boxes are palest; each level up is darker and thicker.
box(l) = l == 1 ? 0xc8ddf0 : l == 2 ? 0x8fbbe0 : l == 3 ? 0x4f93cc : l == 4 ? 0x2467a8 : l == 5 ? 0x6a51a3 : 0x3f007d
plot for [l = least:levels] in using (is("box") && column("number") == l ? column("x_m") : NaN):"y_m":"dx_m":"dy_m" \
       with vectors nohead lc rgb box(l) lw (0.8 + 0.4 * l) title sprintf("boxes of level %d", l), \
     in using (is("reach") ? column("x_m") : NaN):"y_m":"dx_m":"dy_m" with vectors nohead lc rgb "#d98a00" lw 1.6 title "arm's reach", \
     in using (is("halfplane") ? column("x_m") : NaN):"y_m":"dx_m":"dy_m" with vectors nohead lc rgb "#7a7a7a" lw 2.5 title "half-planes", \
     in using (is("solid") ? column("x_m") : NaN):"y_m":"dx_m":"dy_m" with vectors nohead lc rgb "#222222" lw 2.2 title "solids", \
     in using (is("wall") ? column("x_m") : NaN):"y_m":"dx_m":"dy_m" with vectors nohead lc rgb "#c0392b" lw 2.2 title "thin walls"
