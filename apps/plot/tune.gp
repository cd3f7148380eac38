# What a search for gains found: braking against tracking, coloured by the wall, a point each.
#   gnuplot -e "in='tune.csv'; out='tune.png'" tune.gp
# in: a file of ethd-tune --csv. heading may be left out.
if (!exists("in") || !exists("out")) { print "tune.gp: set in and out: gnuplot -e \"in='tune.csv'; out='tune.png'\" tune.gp"; exit status 2 }
if (!exists("heading")) heading = "Gains"

set terminal pngcairo size 1200,860 font "Sans,14" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set datafile missing NaN

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set logscale xy
set autoscale fix
set offsets graph 0.04, graph 0.04, graph 0.04, graph 0.04
set xtics (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10)
set ytics (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10)
set cbtics (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10)
set lmargin at screen 0.1
set rmargin at screen 0.86
set tmargin at screen 0.84
set bmargin at screen 0.1
set label 1 heading at screen 0.1,0.965 font "Sans Bold,18"
set label 2 "each axis: mean figure over the configuration's own, 1 is as good, less is better; simulated taps" \
  at screen 0.1,0.925 font "Sans,13" textcolor rgb grey
set xlabel "tracking: early contacts and lag, times the own"
set ylabel "brake: wall's offset and time of braking, times the own" offset 1,0
set cblabel "wall: rebound and speed at touch, times the own"
set palette defined (0 "#2f5d8a", 0.5 "#5b9e8f", 0.75 "#d9a441", 1 "#b8452f")
set logscale cb
set key at screen 0.86,0.905 right top horizontal maxrows 2 samplen 1 width -3 font "Sans,11"
on(name) = exp(column("goal_".name))
last(k) = column("round") == 4 && column(k) == 1
plot in using (column("keeps") == 0 && column("point") > 0 ? on("tracking") : NaN):(on("brake")) with points pt 2 ps 0.9 lw 1 lc rgb "#b0b0b0" title "thin margins", \
  in using (column("keeps") == 1 ? on("tracking") : NaN):(on("brake")):(on("wall")) with points pt 7 ps 0.6 lc palette title "tapped", \
  in using (column("settled") == 0 ? on("tracking") : NaN):(on("brake")) with points pt 2 ps 1.2 lw 2 lc rgb "#b8452f" title "restless at its margin", \
  in using (column("round") == 4 && column("point") > 0 ? on("tracking") : NaN):(on("brake")):(on("wall")) with points pt 7 ps 1.3 lc palette title "last round", \
  in using (last("front") ? on("tracking") : NaN):(on("brake")) with points pt 6 ps 1.9 lw 1.4 lc rgb "#333333" title "front", \
  in using (column("round") == 4 && column("point") == 0 ? on("tracking") : NaN):(on("brake")) with points pt 2 ps 2.4 lw 3 lc rgb "#000000" title "own gains", \
  in using (column("chosen") == 1 ? on("tracking") : NaN):(on("brake")) with points pt 8 ps 3 lw 3 lc rgb "#c0652b" title "chosen"
