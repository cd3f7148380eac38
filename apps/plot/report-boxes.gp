# Medians, quartiles, extremes by cell, in the manner of the paper's figures 14 to 17; beside each box its taps.
#   gnuplot -e "in='boxes.csv'; points='points.csv'; between='lines.csv'; people='3'; out='boxes.png'" report-boxes.gp
# in, points, between: files of ethd-report; people: how many participants there are. metrics, heading and note may be
# left out; svg: draw an SVG, whose words can be read.
if (!exists("in") || !exists("out") || !exists("points") || !exists("between")) { print "report-boxes.gp: set in, points, between and out: gnuplot -e \"in='boxes.csv'; points='points.csv'; between='lines.csv'; out='boxes.png'\" report-boxes.gp"; exit status 2 }
if (!exists("metrics")) metrics = "v_rvo v_of d_max v_rmin"
if (!exists("heading")) heading = "Taps on a virtual wall"
if (!exists("note")) note = ""
if (!exists("people")) people = "0"

set datafile separator comma
set datafile columnheaders
set datafile missing NaN

# The rows of a metric stand together: from first to last, counted from 0. NaN drops those of other metrics.
only(value) = strcol("metric") eq m ? value : NaN
find_rows = 'row = -1; first = -1; last = -1; x_last = 0; \
  stats in using (row = row + 1, strcol("metric") eq m ? (first = first < 0 ? row : first, last = row, x_last = column("x")) : 0, 0) nooutput'

# Up to four cells have room beside each other twice; with more, and longer names, a panel takes the whole width.
n = words(metrics)
m = word(metrics, 1)
eval(find_rows)
cells = last - first + 1
columns = n > 1 && cells < 5 ? 2 : 1
rows = (n + columns - 1)/columns
wide = 1200
each = columns == 2 ? 470 : 430
turn = cells > 12 ? 35 : 0
foot = turn ? 150 : 98
high = 102 + each*rows
if (exists("svg")) { set terminal svg size wide,high font "DejaVu Sans,15" background "#ffffff" } else { set terminal pngcairo size wide,high font "Sans,15" background "#ffffff" }
set output out

grey = "#7a7a7a"
# strategies keep their colours; others take the last
array laws[4] = [0x4f86c0, 0xb4531a, 0xb5c44a, 0x2f1f45]
tint(law) = laws[law eq "smooth" ? 1 : law eq "offset" ? 2 : law eq "abrupt" ? 3 : 4]
# eight participants can be told apart (after Okabe and Ito; tests/colours.sh); more are grey
array who[8] = [0x0072b2, 0xe69f00, 0x000000, 0xcc79a7, 0x009e73, 0xd55e00, 0x56b4e9, 0x8c6d1f]
colour(person) = people + 0 > 0 && people + 0 <= 8 ? who[int(person) + 1] : 0x555555
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set xtics scale 0
if (turn) { set xtics rotate by turn right }
set style fill solid 0.3 border
unset key
set boxwidth 0.36

title(m) = m eq "v_rvo" ? "Ring's speed as it meets the wall, v_r(t_{r/vo})" : \
  m eq "v_of" ? "Ring's speed as the finger touches it, v_r(t_{of/r})" : m eq "d_max" ? "First rebound, d_{max}" : \
  m eq "v_rmin" ? "Ring's smallest speed after the touch, v_{r min}" : m eq "delay" ? "Touch felt after it is seen, t_{of/r} - t_{seen}" : \
  m eq "delta_s" ? "Time of braking, {/Symbol D}s" : m eq "eps" ? "Offset of the wall, {/Symbol e}" : m
unit(m) = m eq "d_max" || m eq "eps" ? "mm" : m eq "delay" || m eq "delta_s" ? "ms" : "m/s"
join = turn ? ", " : "\n"
label(x) = strcol("transition").join.strcol("speed").join."n = ".strcol("n")

left(i) = columns == 2 && i % 2 ? 0.59 : 0.085
right(i) = columns == 2 ? left(i) + 0.39 : 0.975
head = 94.0/high
top(i) = 1 - head - (i/columns)*(1 - head)/rows - 34.0/high
bottom(i) = 1 - head - (i/columns + 1)*(1 - head)/rows + foot*1.0/high

set multiplot
set label 1 heading at screen left(0),1 - 24.0/high font "Sans Bold,18"
set label 2 note at screen left(0),1 - 48.0/high font "Sans,12" textcolor rgb grey
do for [i=0:n-1] {
  m = word(metrics, i + 1)
  eval(find_rows)
  set lmargin at screen left(i); set rmargin at screen right(i)
  set tmargin at screen top(i); set bmargin at screen bottom(i)
  set title title(m) font "Sans,15" offset 0,-0.4
  set ylabel unit(m) offset 1
  set xrange [0.4:x_last + 0.6]
  set yrange [*:*]
  if (m eq "d_max" || m eq "eps" || m eq "delta_s" || m eq "v_rvo") { set yrange [0:*] }
  unset object
  if (m eq "delay") {
    set object 1 rectangle from graph 0, first -15 to graph 1, first 45 fc rgb "#eef3ee" fs solid noborder behind
    set label 9 "not noticed: 15 ms early to 45 ms late (published)" at graph 0.02, first 45 offset 0,-0.7 font "Sans Italic,12" textcolor rgb grey
    set yrange [-25:60]
  }
  plot 0 with lines lc rgb "#b0b0b0" lw 1, \
    in every ::first::last using (column("x") - 0.06):"q1":"min":"max":"q3":(tint(strcol("transition"))) \
      with candlesticks lc rgb variable lw 1.8 whiskerbars 0.4, \
    in every ::first::last using "x":"median":xtic(label(0)) with points pt -1, \
    between using (only(column("x"))):"y":"dx":"dy":(colour(column("person"))) with vectors nohead lc rgb variable lw 1.4 dt (6,3), \
    points using (only(column("x"))):"value":(colour(column("person"))) with points pt 7 ps 0.55 lc rgb variable, \
    in every ::first::last using (column("x") - 0.24):"median":(0.36):(0) with vectors nohead lc rgb "#c00000" lw 3
  unset label
}
unset multiplot
