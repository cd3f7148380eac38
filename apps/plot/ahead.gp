# What a finger feels of the wall's offset and of the ring's rebound, against its speed, under each law, with the bound of
# any law that reacts.
#   gnuplot -e "in='felt.csv'; out='felt.png'; a=49; gap=0.0047" ahead.gp
# in: speed_mps, then the mean felt offset of abrupt, smooth, offset, predictive in mm (empty: none), then their mean first
# rebounds, as apps/ahead.sh makes it. a: (F_sat + f_c)/m, m/s^2; gap: R_r - R_f - lag, m.
if (!exists("in") || !exists("out") || !exists("a") || !exists("gap")) { print "ahead.gp: set in, out, a and gap"; exit status 2 }
if (!exists("plant")) plant = "n"
set terminal pngcairo size 1400,700 font "Sans,14" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set xlabel "speed of the hand, m/s"
set logscale y
set yrange [0.01:60]
set grid lc rgb "#e4e4e4" lt 1
set border 3
set tics nomirror
set key left top Left reverse
reactive(v) = v**2/(2*a) > gap ? 1e3*(v**2/(2*a) - gap) : NaN
set multiplot layout 1,2 title "Plant ".plant." (simulated, not realtime)" font ",16"
set title "wall's offset felt 60 ms after the touch"
set ylabel "offset, mm (abrupt, smooth: 0, their wall never moves)"
plot 1e3*x**2/(2*a) with lines lc rgb "#333333" lw 2 dt (12,6) title "v^2/(2a): what a reaction at the wall takes", \
     reactive(x) with lines lc rgb "#333333" lw 2 dt (3,5) title "v^2/(2a) - gap: the least that it can be felt", \
     in using 1:4 with linespoints lc rgb "#1f5fa8" lw 2.4 pt 7 title "offset (VO-B)", \
     in using 1:5 with linespoints lc rgb "#c0392b" lw 2.4 pt 5 title "predictive"
set title "ring's first rebound at the wall"
set ylabel "d_{max}, mm"
plot in using 1:6 with linespoints lc rgb "#7a7a7a" lw 2 pt 6 title "abrupt", \
     in using 1:7 with linespoints lc rgb "#2e7d4f" lw 2 pt 9 title "smooth (VO-A)", \
     in using 1:8 with linespoints lc rgb "#1f5fa8" lw 2.4 pt 7 title "offset (VO-B)", \
     in using 1:9 with linespoints lc rgb "#c0392b" lw 2.4 pt 5 title "predictive"
unset multiplot
