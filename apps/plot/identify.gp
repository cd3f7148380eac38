# What a fit says of a stretch of motion, what it leaves, and the spectrum of that.
#   gnuplot -e "in='fit.csv'; out='fit.png'; about=''" identify.gp
# in: a file of ethd-identify --csv.
if (!exists("in") || !exists("out")) { print "identify.gp: set in and out: gnuplot -e \"in='fit.csv'; out='fit.png'\" identify.gp"; exit status 2 }
if (!exists("about")) about = ""

set terminal pngcairo size 1200,1100 font "Sans,14" background "#ffffff"
set output out
set datafile separator comma
grey = "#7a7a7a"
blue = "#2f5d8a"
red = "#b8452f"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set lmargin at screen 0.115
set rmargin at screen 0.97
set label 1 "Measured and predicted motion, and the residual" at screen 0.115,0.97 font "Sans Bold,18"
set label 2 about at screen 0.115,0.943 font "Sans,13" textcolor rgb grey
part(n, y) = int(column(1)) == n ? y : NaN

set multiplot
set tmargin at screen 0.92
set bmargin at screen 0.66
set ylabel "joint angle, mrad" offset 0.5,0
set format x ""
set key at screen 0.97,0.975 right horizontal samplen 2
plot in using (part(0, $2)):($3 * 1e3) skip 1 with points pt 7 ps 0.5 lc rgb blue title "measured", \
     in using (part(0, $2)):($4 * 1e3) skip 1 with lines lc rgb red lw 1.5 title "predicted"
unset label 1
unset label 2
unset key
set tmargin at screen 0.62
set bmargin at screen 0.42
set format x "%g"
set xlabel "time, s"
set ylabel "residual, mrad" offset 0.5,0
plot in using (part(0, $2)):($5 * 1e3) skip 1 with impulses lc rgb blue

set tmargin at screen 0.32
set bmargin at screen 0.08
set logscale y
set format y "10^{%T}"
set xlabel "frequency, Hz"
set ylabel "residual's spectrum, rad^2/Hz" offset 0.5,0
set key at screen 0.97,0.35 right horizontal samplen 2
plot in using (part(1, $2)):3 skip 1 with lines lc rgb blue lw 2 title "residual", \
     in using (part(1, $2)):4 skip 1 with lines lc rgb grey dt 2 title "rounding to counts alone"
unset multiplot
