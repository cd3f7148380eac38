# Mean answers by cell, in the manner of the paper's figure 18.
#   gnuplot -e "in='survey-means.csv'; out='survey.png'" report-survey.gp
# in: a file of ethd-report. note may be left out.
if (!exists("in") || !exists("out")) { print "report-survey.gp: set in and out: gnuplot -e \"in='survey-means.csv'; out='survey.png'\" report-survey.gp"; exit status 2 }
if (!exists("note")) note = ""
set terminal pngcairo size 1200,470 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
grey = "#7a7a7a"
tint(law) = law eq "smooth" ? 0x5b7fa6 : law eq "offset" ? 0xc0652b : law eq "abrupt" ? 0x7a9a55 : 0x8a6aa8
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set yrange [0.8:5.2]
set ytics 1
set boxwidth 0.6
set style fill solid 0.5 border
unset key
array says[3] = ["Q1: the touch came before (1) .. after (5)", "Q2: the wall went left (1) .. right (5)", "Q3: natural (1) .. unnatural (5)"]
array ideal[3] = [3, 3, 1]
set multiplot
set label 1 "Survey: mean answers" at screen 0.05,0.95 font "Sans Bold,18"
set label 2 note at screen 0.05,0.89 font "Sans,13" textcolor rgb grey
do for [q=1:3] {
  set lmargin at screen 0.05 + 0.32*(q - 1); set rmargin at screen 0.05 + 0.32*(q - 1) + 0.27
  set tmargin at screen 0.78; set bmargin at screen 0.2
  set title says[q] font "Sans,14" offset 0,-0.4
  if (q == 1) { set ylabel "score" offset 1 } else { unset ylabel }
  plot ideal[q] with lines lc rgb "#c00000" lw 1.2 dt (6,4), \
    in using 0:(column(sprintf("q%d", q))):(tint(strcol("transition"))):xtic(strcol("transition")."\n".strcol("speed")."\nn = ".strcol("n")) with boxes lc rgb variable
  unset label
}
unset multiplot
