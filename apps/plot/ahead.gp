# What a finger feels of the wall's offset, against its speed, under each law, with the bound of any law that reacts.
#   gnuplot -e "in='felt.csv'; out='felt.png'; a=49; gap=0.0047" ahead.gp
# in: speed_mps, then the mean felt offset of abrupt, smooth, offset, predictive in mm (empty: none), as apps/ahead.sh
# makes it. a: (F_sat + f_c)/m, m/s^2; gap: R_r - R_f - lag, m.
if (!exists("in") || !exists("out") || !exists("a") || !exists("gap")) { print "ahead.gp: set in, out, a and gap"; exit status 2 }
if (!exists("plant")) plant = "n"
set terminal pngcairo size 1000,700 font "Sans,14" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set title "Offset felt 60 ms after the touch, plant ".plant." (simulated, not realtime)" font ",16"
set xlabel "speed of the hand, m/s"
set ylabel "felt offset, mm"
set logscale y
set yrange [0.01:10]
set grid lc rgb "#e4e4e4" lt 1
set border 3
set tics nomirror
set key left top Left reverse
reactive(v) = v**2/(2*a) > gap ? 1e3*(v**2/(2*a) - gap) : NaN
plot 1e3*x**2/(2*a) with lines lc rgb "#333333" lw 2 dt (12,6) title "v^2/(2a): what a reaction at the wall takes", \
     reactive(x) with lines lc rgb "#333333" lw 2 dt (3,5) title "v^2/(2a) - gap: the least that it can be felt", \
     in using 1:4 with linespoints lc rgb "#1f5fa8" lw 2.4 pt 7 title "offset (VO-B)", \
     in using 1:5 with linespoints lc rgb "#c0392b" lw 2.4 pt 5 title "predictive"
