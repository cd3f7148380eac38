# One tap, in the manner of the paper's figures 9 to 12.
#   gnuplot -e "in='offset-high.csv'; out='offset-high.png'; title='offset, high speed'" tap.gp
# in: a file of ethd-tap --trace. title, from, to (ms), scale (of the picture) may be left out; plant names the plant
# in the title, empty: the tap was measured.
if (!exists("in") || !exists("out")) { print "tap.gp: set in and out: gnuplot -e \"in='x.csv'; out='x.png'\" tap.gp"; exit status 2 }
if (!exists("title")) title = in
if (!exists("plant")) plant = "q"
if (!exists("from")) from = -40
if (!exists("to")) to = 90
if (!exists("scale")) scale = 1.0

if (exists("svg")) { set terminal svg size 1200,1300 font "DejaVu Sans,15" background "#ffffff" } else { set terminal pngcairo size 1200*scale,1300*scale font "Sans,15" fontscale scale linewidth scale background "#ffffff" }
set output out
set datafile separator comma
set datafile columnheaders

ring = "#c0392b"; finger = "#1f5fa8"; hand = "#9db7d5"; wall = "#333333"; moved = "#d98a00"; grey = "#7a7a7a"
set style line 1 lc rgb ring lw 2.6
set style line 2 lc rgb finger lw 2.6
set style line 3 lc rgb hand lw 1.8 dt (10,6)
set style line 4 lc rgb wall lw 1.8 dt (14,6)
set style line 5 lc rgb moved lw 2.4 dt (6,4)
set grid lc rgb "#e4e4e4" lt 1 lw 1
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set xrange [from:to]
set lmargin at screen 0.12
set rmargin at screen 0.84
set key at screen 0.85, graph 0.98 left top Left reverse samplen 1.6 spacing 1.25
t(x) = 1e3*column("since_wall_s")

# t_of/r: the first tick at or after t_r/vo with the pad pressing
touch = NaN
stats in using (column("since_wall_s") >= -1e-9 && column("pad_force_N") > 0 && touch != touch ? (touch = 1e3*column("since_wall_s")) : 0) nooutput
# d_max: from the ring's first peak in the wall to the valley after it, each once the ring has turned by 0.1 mm;
# v_rmin: the ring's smallest speed in the 0.1 s after the touch. As apps/tap/metrics.c has them.
peak = NaN; valley = NaN; t_peak = NaN; t_valley = NaN; turned = 0; v_rmin = NaN; t_rmin = NaN
follow(x, at) = at < -1e-9 || turned == 2 ? 0 : turned == 0 ? \
  (peak != peak || x > peak ? (peak = x, t_peak = at) : x < peak - 0.1 ? (turned = 1, valley = x, t_valley = at) : 0) : \
  x < valley ? (valley = x, t_valley = at) : x > valley + 0.1 ? (turned = 2) : 0
stats in using (follow(1e3*column("measured_m"), t(0)), 0) nooutput
stats in using (touch == touch && t(0) > touch + 1e-9 && t(0) <= touch + 100 + 1e-9 && (v_rmin != v_rmin || column("v_ring_mps") < v_rmin) ? (v_rmin = column("v_ring_mps"), t_rmin = t(0)) : 0, 0) nooutput
stats [*:*] in using (t(0) >= from && t(0) <= to ? 1e3*column("ring_m") : NaN) nooutput name "R"
moved_any = 0
stats in using (moved_any = moved_any + (strlen(strcol("offset_wall_m")) > 0), 0) nooutput
top = R_max > 8 ? 10 : R_max + 2
bottom = R_min < -14 ? -14 : R_min

set multiplot
set label 1 title.", one typical tap" at screen 0.12,0.972 font "Sans Bold,19"
origin = plant eq "" ? "measured" : "simulated; plant ".plant." is fitted to Table 1, not measured"
set label 2 origin.". Time from t_{r/vo}: the ring meets the wall." \
  at screen 0.12,0.947 font "Sans,13" textcolor rgb grey
marks = 'set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb "#aaaaaa" lw 1.4; if (touch == touch) {set arrow 2 from touch,graph 0 to touch,graph 1 nohead lc rgb finger lw 1.2 dt (2,3)}'
eval(marks)

# ---- positions ----
set tmargin at screen 0.925
set bmargin at screen 0.565
set format x ""
set ylabel "position along n, mm" offset 0.2
set yrange [bottom:top]
set object 1 rectangle from graph 0, first 0 to graph 1, graph 1 fc rgb "#f3f1ec" fs solid noborder behind
set label 3 "virtual wall" at graph 0.012, first (top - 0.07*(top - bottom)) textcolor rgb grey font "Sans Italic,13"
if (turned > 0) {
  set arrow 3 from t_valley,peak to t_valley,valley heads size 2,90 front lc rgb ring lw 1.6
  set arrow 4 from t_peak,peak to t_valley,peak nohead front lc rgb ring lw 1.2 dt (2,3)
  set label 6 sprintf("d_{max} %.2f mm", peak - valley) at screen 0.85, graph 0.5 textcolor rgb ring font "Sans,13"
}
offset_style = moved_any ? 5 : 4 # where the wall didn't move, its line once more: a curve without a point is warned of
plot in using (t(0)):(1e3*column("hand_m")) with lines ls 3 title "hand's path", \
     0 with lines ls 4 title "wall x_e", \
     in using (t(0)):(moved_any ? 1e3*column("offset_wall_m") : 0) with lines ls offset_style \
       title (moved_any ? "wall x_{/Symbol e}" : ""), \
     in using (t(0)):(1e3*column("measured_m")) with lines lc rgb ring lw 1.2 dt (3,3) title "measured", \
     in using (t(0)):(1e3*column("finger_m")) with lines ls 2 title "finger's pad", \
     in using (t(0)):(1e3*column("ring_m")) with lines ls 1 title "ring's front"
unset object 1
unset label 1; unset label 2; unset label 3; unset label 6; unset arrow 3; unset arrow 4

# ---- speed ----
set tmargin at screen 0.545
set bmargin at screen 0.34
set ylabel "speed along n, m/s"
set yrange [*:*]
if (touch == touch) {set label 4 "finger touches" at touch, graph 1.04 textcolor rgb finger font "Sans,13"}
set label 5 "ring meets wall " at 0, graph 0.07 right textcolor rgb grey font "Sans,13"
if (v_rmin == v_rmin) { # a ring around the point
  set label 7 "" at t_rmin,v_rmin point pt 6 ps 1.6 lc rgb ring lw 2 front
  set label 8 sprintf("v_{r min} %.3f m/s", v_rmin) at screen 0.85, graph 0.6 textcolor rgb ring font "Sans,13"
}
plot 0 with lines lc rgb "#bbbbbb" lw 1 notitle, \
     in using (t(0)):"v_finger_mps" with lines lc rgb finger lw 1.6 title "finger", \
     in using (t(0)):"v_ring_mps" with lines ls 1 title "ring"
unset label 4; unset label 5; unset label 7; unset label 8

# ---- state ----
set tmargin at screen 0.32
set bmargin at screen 0.215
unset ylabel
set yrange [-0.25:2.25]
set ytics ("transparent" 0, "braking" 1, "vo" 2)
plot in using (t(0)):"state" with steps lc rgb "#444444" lw 2.2 notitle
set ytics auto

# ---- beta ----
set tmargin at screen 0.195
set bmargin at screen 0.065
set format x "%g"
set xlabel "time from t_{r/vo}, ms" offset 0,0.4
set ylabel "{/Symbol b}" offset 0.2
set yrange [0:1.1]
set ytics 0.25
plot in using (t(0)):"beta" with steps lc rgb "#2e7d4f" lw 2.4 notitle
unset multiplot
