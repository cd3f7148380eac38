# One tap on an arm in space: the plate is at the wall, standing, when the finger comes.
#   gnuplot -e "in='approach-0.4.csv'; out='arm.png'" arm.gp
# in: a file of ethd-tap --arm --trace. title, from, to (ms), scale (of the picture) may be left out.
if (!exists("in") || !exists("out")) { print "arm.gp: set in and out"; exit status 2 }
if (!exists("title")) title = "A typical tap at 0.4 m/s with a simulated UR5e: the plate stands at the wall when the finger comes"
if (!exists("from")) from = -700
if (!exists("to")) to = 90
if (!exists("scale")) scale = 1.0
set terminal pngcairo size 1500*scale,520*scale font "Sans,14" fontscale scale linewidth scale background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set grid lc rgb "#e4e4e4" lt 1
set border 3 lc rgb "#7a7a7a"
set tics nomirror
t(x) = 1e3*column("since_touch_s")
before(v) = t(0) <= 1e-6 ? v : NaN
after(v) = t(0) >= -1e-6 ? v : NaN

# the controller's wall, state vo, from its last beginning before the touch on
held = NaN
last = 0
stats in using (t(0) <= 0 && column("state") == 2 && last != 2 ? (held = t(0)) : 0, last = column("state"), 0) nooutput
set xrange [from:to]
set xlabel "time from the touch, ms" offset 0,0.4
set tmargin at screen 0.86
set bmargin at screen 0.16
set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb "#1f5fa8" lw 1.2 dt (2,3)
if (held == held) {set object 1 rectangle from held, graph 0 to to, graph 1 fc rgb "#f3f1ec" fs solid noborder behind}

set multiplot title title font "Sans Bold,17"
set lmargin at screen 0.055
set rmargin at screen 0.49
set ylabel "position along n, mm" offset 1
set yrange [-240:140]
set key top left Left reverse samplen 1.8
if (held == held) {set label 1 "held: vo" at held, graph 0.94 offset 0.5 textcolor rgb "#7a7a7a" font "Sans Italic,13"}
plot 0 with lines lc rgb "#333333" lw 1.6 dt (14,6) title "wall x_e", \
     in using (t(0)):(1e3*column("plate_m")) with lines lc rgb "#c0392b" lw 2.4 title "plate", \
     in using (t(0)):(before(1e3*column("finger_m"))) with lines lc rgb "#1f5fa8" lw 2.2 title "finger's pad", \
     in using (t(0)):(after(1e3*column("finger_m"))) with lines lc rgb "#9db7d5" lw 1.8 dt (6,4) title "hand's path"
unset label 1
set lmargin at screen 0.555
set rmargin at screen 0.99
set ylabel "speed along n, m/s" offset 1
set yrange [*:*]
set label 1 "finger touches " at 0, graph 0.94 right textcolor rgb "#1f5fa8" font "Sans,12"
unset key
plot 0 with lines lc rgb "#bbbbbb" notitle, \
     in using (t(0)):(before(column("v_finger_mps"))) with lines lc rgb "#1f5fa8" lw 2.2 notitle, \
     in using (t(0)):(after(column("v_finger_mps"))) with lines lc rgb "#9db7d5" lw 1.8 dt (6,4) notitle, \
     in using (t(0)):"v_plate_mps" with lines lc rgb "#c0392b" lw 2.4 notitle
unset multiplot
