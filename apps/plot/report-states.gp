# States and beta over time, in the manner of the paper's figure 6: a row per trace.
#   gnuplot -e "in='offset-low.csv offset-high.csv'; titles='offset-low offset-high'; out='states.png'" report-states.gp
# in: files of ethd-tap --trace or ethd-report, without spaces in their names. from, to (ms; without it until the ring
# has left the wall), note may be left out; svg: draw an SVG, whose words can be read.
if (!exists("in") || !exists("out")) { print "report-states.gp: set in and out: gnuplot -e \"in='x.csv'; out='x.png'\" report-states.gp"; exit status 2 }
if (!exists("titles")) titles = in
if (!exists("note")) note = ""
if (!exists("from")) from = -30
from = from + 0

n = words(in)
high = 150 + 190*n
set datafile separator comma
set datafile columnheaders
# the whole encounter: until a while after the last tick that isn't transparent with full tracking
if (!exists("to")) {
  last = 0; end = 0
  do for [i=1:n] { stats word(in, i) using (end = 1e3*column("since_wall_s") > end ? 1e3*column("since_wall_s") : end, column("state") > 0 || column("beta") < 0.999 ? (last = 1e3*column("since_wall_s") > last ? 1e3*column("since_wall_s") : last) : 0, 0) nooutput }
  to = last + 40 < end ? last + 40 : end
}
if (exists("svg")) { set terminal svg size 1200,high font "DejaVu Sans,15" background "#ffffff" } else { set terminal pngcairo size 1200,high font "Sans,15" background "#ffffff" }
set output out
grey = "#7a7a7a"
array states[3] = [0xedf4f9, 0xf6c07a, 0xd3c2e3]
tint(k) = states[k + 1]
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set xrange [from:to]
set yrange [0:1.15]
set ytics 0.25
set ylabel "{/Symbol b}" offset 1.5 textcolor rgb "#2e7d4f"
unset key
t(x) = 1e3*column("since_wall_s")
set lmargin at screen 0.08
set rmargin at screen 0.92
set border 11 lc rgb grey
set ytics nomirror
set y2tics 2 textcolor rgb "#c0392b"
set y2range [-2:5] # a deeper ring leaves the picture, so that the wall's offset stays visible
set y2label "in the wall, mm" offset -1 textcolor rgb "#c0392b"
top(i) = 1 - (104.0 + 190.0*i)/high
bottom(i) = top(i) - 140.0/high

set multiplot
set label 1 "Active state and weight {/Symbol b} of the tracking torque" at screen 0.08,1 - 24.0/high font "Sans Bold,18"
set label 2 note at screen 0.08,1 - 50.0/high font "Sans,13" textcolor rgb grey
array names[3] = ["transparent", "braking", "vo"]
do for [k=0:2] {
  at_x = real(word("0.665 0.79 0.885", k + 1))
  set object 10 + k rectangle from screen at_x,1 - 58.0/high to screen at_x + 0.015,1 - 42.0/high fc rgb tint(k) fs solid border lc rgb grey
  set label 10 + k names[k + 1] at screen at_x + 0.022,1 - 50.0/high font "Sans,14" textcolor rgb "#333333"
}
do for [i=0:n-1] {
  file = word(in, i + 1)
  set tmargin at screen top(i); set bmargin at screen bottom(i)
  set title word(titles, i + 1) font "Sans,15" offset 0,-0.6
  if (i == n - 1) { set format x "%g"; set xlabel "time from t_{r/vo}, ms" offset 0,0.4 } else { set format x ""; unset xlabel }
  set arrow 1 from 0,0 to 0,1.15 nohead lc rgb "#999999" lw 1.2 front
  eps = NaN
  stats file using (t(0) <= to && strlen(strcol("offset_wall_m")) ? (eps = 1e3*column("offset_wall_m")) : 0, 0) nooutput
  if (eps == eps) {
    set arrow 2 from graph 0.6, second 0 to graph 0.6, second eps heads size screen 0.003,90 front lc rgb "#8a5700" lw 1.6
    set label 2 sprintf("{/Symbol e} %.2f mm", eps) at graph 0.608, second (eps > 0 && eps < 1.5 ? 0 : eps) offset 0,-0.65 front font "Sans,13" textcolor rgb "#8a5700"
  }
  # a tick's box is wider than the tick, so that no seam shows within a state
  plot file using (t(0) + 0.5):(1.15):(1.5):(tint(int(column("state")))) with boxes lc rgb variable fs solid 1 noborder, \
    file using (t(0)):(1e3*column("ring_m")) axes x1y2 with lines lc rgb "#c0392b" lw 1.4 dt (6,3), \
    0 axes x1y2 with lines lc rgb "#7a7a7a" lw 1.2, \
    file using (t(0)):(eps == eps ? 1e3*column("offset_wall_m") : 0) axes x1y2 with lines lc rgb "#d98a00" lw 2.4, \
    file using (t(0)):"beta" with steps lc rgb "#2e7d4f" lw 2.6
  unset label; unset object; unset arrow
}
unset multiplot
