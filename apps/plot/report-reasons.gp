# Why taps count or don't, a bar per cell.
#   gnuplot -e "in='reasons.csv'; out='reasons.png'" report-reasons.gp
# in: a file of ethd-report. note may be left out; svg: draw an SVG, whose words can be read.
if (!exists("in") || !exists("out")) { print "report-reasons.gp: set in and out: gnuplot -e \"in='reasons.csv'; out='reasons.png'\" report-reasons.gp"; exit status 2 }
if (!exists("note")) note = ""

set datafile separator comma
set datafile columnheaders
n = 0
stats in using (n = n + 1, 0) nooutput
high = 190 + 62*n
if (exists("svg")) { set terminal svg size 1000,high font "DejaVu Sans,15" background "#ffffff" } else { set terminal pngcairo size 1000,high font "Sans,15" background "#ffffff" }
set output out
grey = "#7a7a7a"
array keys[8] = ["ok", "early-contact", "too-slow", "too-fast", "no-contact", "grazing", "double", "fault"]
# Neighbours differ in lightness too, so that they can be told apart without red or green (tests/colours.sh).
array tints[8] = [0x009e73, 0x7a1f00, 0x9ad1f5, 0x0a5a96, 0xe8e8e8, 0xe69f00, 0xb0609a, 0x000000]
set border 1 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid xtics lc rgb "#e4e4e4" lt 1 lw 1
set xrange [0:100]
set yrange [n + 0.6:0.4]
set xlabel "share of the taps, %"
set ytics scale 0
set lmargin 18
set rmargin 3
set tmargin at screen 1 - 128.0/high
set key at screen 0.985, screen 1 - 58.0/high right top horizontal samplen 1 width 0 maxrows 3 font "Sans,13"
set label 1 "Taps by reason" at screen 0.03, screen 1 - 24.0/high font "Sans Bold,18"
set label 2 note at screen 0.03, screen 1 - 50.0/high font "Sans,13" textcolor rgb grey
total(x) = column("taps")
below(k) = sum [j=1:k] (100.0*column(keys[j])/total(0))
plot for [k=1:8] in using ((below(k) + (k > 1 ? below(k - 1) : 0))/2):"row":(k > 1 ? below(k - 1) : 0):(below(k)):(column("row") - 0.36):(column("row") + 0.36):ytic(strcol("transition").", ".strcol("speed")) \
  with boxxyerror lc rgb tints[k] fs solid 1 border lc rgb "#ffffff" notitle, \
  for [k=1:8] keyentry with boxes lc rgb tints[k] fs solid 1 title (keys[k] eq "ok" ? "valid" : keys[k])
