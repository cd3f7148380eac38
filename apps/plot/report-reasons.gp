# Why taps count or don't, a bar per cell.
#   gnuplot -e "in='reasons.csv'; out='reasons.png'" report-reasons.gp
# in: a file of ethd-report. note may be left out.
if (!exists("in") || !exists("out")) { print "report-reasons.gp: set in and out: gnuplot -e \"in='reasons.csv'; out='reasons.png'\" report-reasons.gp"; exit status 2 }
if (!exists("note")) note = ""

set datafile separator comma
set datafile columnheaders
n = 0
stats in using (n = n + 1, 0) nooutput
set terminal pngcairo size 1000,150 + 62*n font "Sans,15" background "#ffffff"
set output out
grey = "#7a7a7a"
array keys[8] = ["ok", "early-contact", "too-slow", "too-fast", "no-contact", "grazing", "double", "fault"]
array tints[8] = [0x6a9e6a, 0xc0652b, 0x9db7d5, 0x5b7fa6, 0xc9c9c9, 0xe0c060, 0x8a6aa8, 0x333333]
set border 1 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid xtics lc rgb "#e4e4e4" lt 1 lw 1
set xrange [0:100]
set yrange [n + 0.6:0.4]
set xlabel "share of the taps, %"
set ytics scale 0
set lmargin 16
set rmargin 3
set tmargin at screen 1 - 78.0/(150 + 62*n)
set key at screen 0.99, screen 0.985 right top horizontal samplen 1 width -1 maxrows 2 font "Sans,13"
set label 1 "Taps by reason" at screen 0.03, screen 1 - 24.0/(150 + 62*n) font "Sans Bold,18"
set label 2 note at screen 0.03, screen 1 - 50.0/(150 + 62*n) font "Sans,13" textcolor rgb grey
total(x) = column("taps")
below(k) = sum [j=1:k] (100.0*column(keys[j])/total(0))
plot for [k=1:8] in using ((below(k) + (k > 1 ? below(k - 1) : 0))/2):"row":(k > 1 ? below(k - 1) : 0):(below(k)):(column("row") - 0.36):(column("row") + 0.36):ytic(strcol("transition").", ".strcol("speed")) \
  with boxxyerror lc rgb tints[k] fs solid 1 noborder notitle, \
  for [k=1:8] keyentry with boxes lc rgb tints[k] fs solid 1 title (keys[k])
