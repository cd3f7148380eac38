# Simulated hours per CPU hour: run time against error of whole taps.
#   gnuplot -e "in='hours.csv'; out='hours.png'" bench-hours.gp
# in: a file of ethd-bench hours.
if (!exists("in") || !exists("out")) { print "bench-hours.gp: set in and out: gnuplot -e \"in='hours.csv'; out='hours.png'\" bench-hours.gp"; exit status 2 }

set terminal pngcairo size 1100,700 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set tmargin at screen 0.86
set label 1 "Whole taps in closed loop: run time against error" at screen 0.085,0.955 font "Sans Bold,18"
set label 2 "plant n, simulated, plausible and not measured; device, controller and its record; against the loop at tolerance 10^{-13}" \
  at screen 0.085,0.912 font "Sans,12" textcolor rgb grey
set xrange [0:*]
set xlabel "CPU time of a simulated second, us" offset 0,0.2
set logscale y
set format y "10^{%T}"
set ylabel "largest error of ring or finger, m" offset 0.5
set key top right Left reverse samplen 2
us(name) = 1e6*column(name)
plot in using (us("time_s")):"error_m" with linespoints pt 7 ps 1.4 lw 2.5 lc rgb 0xc0392b title "record", \
     in using (us("time_truth_s")):"error_m" with linespoints pt 7 ps 1.0 lw 1.5 lc rgb 0xe59866 title "record and truth", \
     in using (strlen(strcol("setting")) ? us("time_s") : NaN):"error_m":(sprintf("%s: %.0f hours per CPU hour", strcol("setting"), column("hours_per_cpu_hour"))) \
       with labels right offset -1.2,-0.2 font "Sans,13" textcolor rgb "#333333" notitle
