# Medians, quartiles, extremes by cell, in the manner of the paper's figures 14 to 17.
#   gnuplot -e "in='boxes.csv'; points='points.csv'; out='boxes.png'; metrics='v_rvo v_of d_max v_rmin'" report-boxes.gp
# in, points: files of ethd-report. heading and note may be left out.
if (!exists("in") || !exists("out") || !exists("points")) { print "report-boxes.gp: set in, points and out: gnuplot -e \"in='boxes.csv'; points='points.csv'; out='boxes.png'\" report-boxes.gp"; exit status 2 }
if (!exists("metrics")) metrics = "v_rvo v_of d_max v_rmin"
if (!exists("heading")) heading = "Taps on a virtual wall"
if (!exists("note")) note = ""

n = words(metrics)
rows = (n + 1)/2
wide = n > 1 ? 1200 : 940
high = 90 + 470*rows
set terminal pngcairo size wide,high font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set datafile missing NaN

grey = "#7a7a7a"
# strategies keep their colours; others take the last
tint(law) = law eq "smooth" ? 0x5b7fa6 : law eq "offset" ? 0xc0652b : law eq "abrupt" ? 0x7a9a55 : 0x8a6aa8
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set xtics scale 0
set style fill solid 0.3 border
unset key
set boxwidth 0.52

title(m) = m eq "v_rvo" ? "Ring's speed as it meets the wall, v_r(t_{r/vo})" : \
  m eq "v_of" ? "Ring's speed as the finger touches it, v_r(t_{of/r})" : m eq "d_max" ? "First rebound, d_{max}" : \
  m eq "v_rmin" ? "Ring's smallest speed after the touch, v_{r min}" : m eq "delay" ? "Touch felt after it is seen, t_{of/r} - t_{seen}" : \
  m eq "delta_s" ? "Time of braking, {/Symbol D}s" : m eq "eps" ? "Offset of the wall, {/Symbol e}" : m
unit(m) = m eq "d_max" || m eq "eps" ? "mm" : m eq "delay" || m eq "delta_s" ? "ms" : "m/s"
# The rows of a metric stand together: from first to last, counted from 0. NaN drops those of other metrics.
only(value) = strcol("metric") eq m ? value : NaN
find_rows = 'row = -1; first = -1; last = -1; x_last = 0; \
  stats in using (row = row + 1, strcol("metric") eq m ? (first = first < 0 ? row : first, last = row, x_last = column("x")) : 0, 0) nooutput'

left(i) = n > 1 ? (i % 2 ? 0.59 : 0.085) : 0.13
right(i) = n > 1 ? left(i) + 0.39 : 0.96
head = 82.0/high
top(i) = 1 - head - (i/2)*(1 - head)/rows - 34.0/high
bottom(i) = 1 - head - (i/2 + 1)*(1 - head)/rows + 98.0/high

set multiplot
set label 1 heading at screen left(0),1 - 24.0/high font "Sans Bold,18"
set label 2 note at screen left(0),1 - 52.0/high font "Sans,13" textcolor rgb grey
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
    in every ::first::last using "x":"q1":"min":"max":"q3":(tint(strcol("transition"))):xtic(strcol("transition")."\n".strcol("speed")."\nn = ".strcol("n")) \
      with candlesticks lc rgb variable lw 1.8 whiskerbars 0.4, \
    points using (only(column("x"))):"value" with points pt 7 ps 0.45 lc rgb "#c0333333", \
    in using (only(column("x")) - 0.26):"median":(0.52):(0) with vectors nohead lc rgb "#c00000" lw 3
  unset label
}
unset multiplot
