# Readers of files: ns a byte over the size of the file, which a linear reader keeps.
#   gnuplot -e "in='readers.csv'; out='readers.png'" bench-readers.gp
# in: a file of ethd-bench readers.
if (!exists("in") || !exists("out")) { print "bench-readers.gp: set in and out: gnuplot -e \"in='readers.csv'; out='readers.png'\" bench-readers.gp"; exit status 2 }

set terminal pngcairo size 1150,700 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set datafile missing NaN

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set tmargin at screen 0.86
set rmargin at screen 0.72
set label 1 "Reading files: time a byte over the size" at screen 0.085,0.955 font "Sans Bold,18"
set label 2 "a level line is time linear in the file; dashed: expat or strtod alone on the same bytes" \
  at screen 0.085,0.912 font "Sans,12" textcolor rgb grey
set logscale xy
set xlabel "bytes" offset 0,0.2
set format x "10^{%T}"
set ylabel "ns a byte" offset 0.5
set key at screen 0.985,0.84 right top Left reverse samplen 2 spacing 1.3 noenhanced
array reader[5] = ["SVG circles", "SVG path", "scene", "motion CSV", "taps of a report"]
array tint[5] = ["#333333", "#1f5fa8", "#c0392b", "#2e7d4f", "#b07d12"]
here(i, own) = strcol("reader") eq reader[i] && (strcol("who") eq "libethd") == own ? column("ns_per_byte") : NaN
plot for [i = 1:5] in using "bytes":(here(i, 1)) with linespoints pt 7 ps 1.2 lw 2.5 lc rgb tint[i] title reader[i], \
     for [i = 1:5] in using "bytes":(here(i, 0)) with linespoints pt 6 ps 1 lw 1.2 dt 2 lc rgb tint[i] notitle
