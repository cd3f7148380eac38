# How wrong facts and sensors reach the finger: mean felt offset under predictive against what is off.
#   gnuplot -e "in='off.csv'; out='off.png'" ahead-sensitivity.gp
# in: what, value, low and high mm (first taps), low and high mm (after ten taps of learning), as apps/ahead.sh makes it.
if (!exists("in") || !exists("out")) { print "ahead-sensitivity.gp: set in and out"; exit status 2 }
set terminal pngcairo size 1200,900 font "Sans,13" background "#ffffff"
set output out
set datafile separator comma
set datafile missing ""
set grid lc rgb "#e4e4e4" lt 1
set border 3
set tics nomirror
set yrange [0:*]
set offsets graph 0.05, graph 0.05, graph 0.35, 0
set key right top Left reverse
set ylabel "felt offset, mm"
pick(what, c) = strcol(1) eq what ? column(c) : NaN
set multiplot layout 2,2 title "predictive on plant n at 0.2 and 0.4 m/s (simulated, not realtime)" font ",16"
do for [what in "mass friction delay noise"] {
  set xlabel what eq "mass" || what eq "friction" ? what." told to the law / of the plant" : what eq "delay" ? "delay of the plant, ms (0.071 is told)" : "noise of the proximity ring, mm"
  plot in using (pick(what, 2)):(pick(what, 3)) with linespoints lc rgb "#1f5fa8" pt 7 lw 2 title "0.2 m/s", \
       in using (pick(what, 2)):(pick(what, 4)) with linespoints lc rgb "#c0392b" pt 7 lw 2 title "0.4 m/s", \
       in using (pick(what, 2)):(pick(what, 5)) with linespoints lc rgb "#1f5fa8" pt 6 dt (8,5) title "0.2, ten taps learnt", \
       in using (pick(what, 2)):(pick(what, 6)) with linespoints lc rgb "#c0392b" pt 6 dt (8,5) title "0.4, ten taps learnt"
}
unset multiplot
