# Sensors of the finger: error of the estimate, and taps in which the finger meets the ring too early, over the speed.
#   gnuplot -e "in='sensors.csv'; out='sensors.png'" bench-sensors.gp
# in: a file of ethd-bench sensors.
if (!exists("in") || !exists("out")) { print "bench-sensors.gp: set in and out: gnuplot -e \"in='sensors.csv'; out='sensors.png'\" bench-sensors.gp"; exit status 2 }

set terminal pngcairo size 1250,640 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set xrange [0.15:0.75]
set xtics 0.1
set xlabel "commanded speed of the hand, m/s" offset 0,0.3
array name[6] = ["16 rays", "nail plate", "16 zones", "12 zones", "8 zones", "camera 90 Hz"]
array tint[6] = ["#333333", "#1f5fa8", "#7fb98f", "#2e7d4f", "#14401f", "#c0392b"]
array mark[6] = [7, 5, 9, 9, 9, 13]
here(i, what) = strcol("sensor") eq name[i] ? column(what) : NaN
silent(i, what) = strcol("sensor") eq (i == 4 ? "12 zones (silent)" : "camera (silent)") ? column(what) : NaN

set multiplot
set tmargin at screen 0.78
set bmargin at screen 0.13
set label 1 "What measures the finger: error and early contacts over the speed" at screen 0.07,0.955 font "Sans Bold,18"
set label 2 "simulated taps under the offset strategy, plant n, same hands for all; sensors assumed or from makers' figures, not measured" \
  at screen 0.07,0.905 font "Sans,13" textcolor rgb grey

set lmargin at screen 0.085
set rmargin at screen 0.46
set title "error of the finger toward the wall, before it, rms" font "Sans,15" offset 0,-0.5
set ylabel "mm" offset 0.5
set logscale y
set yrange [0.03:3]
set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5)
unset key
plot for [i = 1:6] in using "speed_mps":(here(i, "error_toward_mm")) with points pt mark[i] ps 1.3 lc rgb tint[i], \
  for [i = 1:6] in using "speed_mps":(here(i, "error_toward_mm")) smooth unique with lines lw 2 lc rgb tint[i], \
  for [i = 4:6:2] in using "speed_mps":(silent(i, "error_toward_mm")) smooth unique with lines lw 2 dt (4,5) lc rgb tint[i]
unset label

set lmargin at screen 0.53
set rmargin at screen 0.83
unset logscale y
set title "the finger meets the ring before the wall" font "Sans,15" offset 0,-0.5
set ylabel "% of the taps" offset 1
set yrange [-3:103]
set ytics 20
set key at screen 0.995,0.74 right top samplen 1.5 spacing 1.4 font "Sans,13"
plot for [i = 1:6] in using "speed_mps":(100*here(i, "early_share")) with points pt mark[i] ps 1.3 lc rgb tint[i] notitle, \
  for [i = 1:6] in using "speed_mps":(100*here(i, "early_share")) smooth unique with lines lw 2 lc rgb tint[i] title name[i], \
  NaN with lines lw 2 dt (4,5) lc rgb grey title "noise not told"
unset multiplot
