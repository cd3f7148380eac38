# Complementary distribution of the loop's wake-up latency and of its tick time.
#   gnuplot -e "in='latency.csv'; out='latency.png'" latency.gp
# in: a file of ethd-latency --csv.
if (!exists("in") || !exists("out")) { print "latency.gp: set in and out: gnuplot -e \"in='latency.csv'; out='latency.png'\" latency.gp"; exit status 2 }

set terminal pngcairo size 1100,640 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma

stats in skip 1 nooutput
columns = STATS_columns
# Of each column: how many samples there are, and how many the curve has passed.
array total[5] = [0.0, 0.0, 0.0, 0.0, 0.0]
array passed[5] = [0.0, 0.0, 0.0, 0.0, 0.0]
do for [c = 3:columns] { stats in using (total[c] = total[c] + column(c), 0) skip 1 nooutput }
# The share of the samples that took longer than the end of a bin. The curve ends on the floor, with the last sample.
share(c) = total[c] - passed[c] > 0 ? (total[c] - passed[c])/total[c] : 0.5/total[c]
tail(c) = (passed[c] = passed[c] + column(c), passed[c] - column(c) < total[c] ? share(c) : NaN)

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set logscale xy
set format y "10^{%T}"
set xlabel "us"
set ylabel "share that took longer"
set yrange [0.4/total[3]:1.1]
set key top right spacing 1.3
set lmargin at screen 0.1
set rmargin at screen 0.95
set tmargin at screen 0.86
set bmargin at screen 0.13
set label 1 "Latency of the loop" at screen 0.1,0.955 font "Sans Bold,18"
set label 2 sprintf("%.0f ticks on this machine, beside what else ran; the right ends are the maxima", total[3]) \
  at screen 0.1,0.905 font "Sans,13" textcolor rgb grey

set style data lines
plot in using (1e6*$2):(tail(3)) skip 1 lw 2.4 lc rgb "#c0652b" title "wake-up", \
  in using (1e6*$2):(tail(4)) skip 1 lw 2.4 lc rgb "#5b7fa6" title "tick: read, step, write", \
  for [c = 5:columns] in using (1e6*$2):(tail(c)) skip 1 lw 2 dt 2 lc rgb "#7a7a7a" title "cyclictest"
