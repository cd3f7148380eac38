# A ring's calibration: what each sensor counted at which distance, and how far the found distance is off.
#   gnuplot -e "in='ring.csv'; out='ring.png'" calibration.gp
# in: a file of ethd-calibrate --csv.
if (!exists("in") || !exists("out")) { print "calibration.gp: set in and out: gnuplot -e \"in='ring.csv'; out='ring.png'\" calibration.gp"; exit status 2 }

set terminal pngcairo size 1200,860 font "Sans,14" background "#ffffff"
set output out
set datafile separator comma

n = 0
squares = 0.0
most = 0.0
stats in using (n = n + 1, squares = squares + $6**2, most = abs($6) > most ? abs($6) : most, 0) skip 1 nooutput
rms = n > 0 ? 1e3*sqrt(squares/n) : 0
most = most > 0 ? 1e3*most : 1e-3

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set palette defined (0 "#2f5d8a", 5 "#5b9e8f", 10 "#d9a441", 15 "#b8452f")
set cbrange [0:15]
unset colorbox
set lmargin at screen 0.115
set rmargin at screen 0.97
set label 1 "Calibration of the proximity ring" at screen 0.115,0.965 font "Sans Bold,18"
set label 2 sprintf("error %.4f mm rms, at most %.4f mm; a colour a sensor, from 0 (blue) to 15 (red)", rms, most) \
  at screen 0.115,0.93 font "Sans,13" textcolor rgb grey

set multiplot
set tmargin at screen 0.9
set bmargin at screen 0.47
set logscale y
set xrange [0:*]
set ylabel "counts above dark" offset 0.5,0
set format x ""
plot in using ($4 * 1e3):($2 - $3):1 skip 1 with points pt 7 ps 0.9 lc palette notitle

unset label 1
unset label 2
unset logscale y
set tmargin at screen 0.42
set bmargin at screen 0.09
set format x "%g"
set xlabel "distance of the rod from the sensor, mm"
set ylabel "found less placed, mm" offset 1.2,0
set yrange [-1.15*most:1.15*most]
plot 0 lc rgb grey lw 1 notitle, in using ($4 * 1e3):($6 * 1e3):1 skip 1 with points pt 7 ps 0.9 lc palette notitle
unset multiplot
