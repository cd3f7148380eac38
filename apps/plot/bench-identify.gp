# What identification asks of the simulator: simulated seconds per CPU second against error.
#   gnuplot -e "in='identify.csv'; out='identify.png'" bench-identify.gp
# in: a file of ethd-bench identify.
if (!exists("in") || !exists("out")) { print "bench-identify.gp: set in and out: gnuplot -e \"in='identify.csv'; out='identify.png'\" bench-identify.gp"; exit status 2 }

set terminal pngcairo size 1150,700 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set tmargin at screen 0.86
set rmargin at screen 0.72
set label 1 "Encoders predicted from commands: speed against error" at screen 0.085,0.955 font "Sans Bold,18"
set label 2 "simulated arms without a finger, windows of 0.25 s; tolerances 10^{-4} to 10^{-11} m/s; against DOPRI5 in steps of 10 us" \
  at screen 0.085,0.912 font "Sans,12" textcolor rgb grey
set xrange [0:*]
set xlabel "simulated seconds per CPU second" offset 0,0.2
set logscale y
set format y "10^{%T}"
set ylabel "largest error at the ring, m" offset 0.5
set key at screen 0.985,0.84 right top Left reverse samplen 2 spacing 1.3 noenhanced
array plant[4] = ["n", "b", "p, elastic", "n, coupled"]
array tint[4] = ["#333333", "#1f5fa8", "#c0392b", "#2e7d4f"]
here(i, how) = strcol("plant") eq plant[i] && strcol("simulator") eq how ? column("seconds_per_cpu_second") : NaN
plot for [i = 1:4] in using (here(i, "four side by side")):"error_m" with linespoints pt 7 ps 1.2 lw 2.5 lc rgb tint[i] title plant[i].": side by side", \
     for [i = 1:4] in using (here(i, "one after another")):"error_m" with linespoints pt 6 ps 1.1 lw 1.5 dt 2 lc rgb tint[i] title plant[i].": one by one"
