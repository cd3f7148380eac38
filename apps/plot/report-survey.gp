# Answers by cell: a bar of shares of the answers 1 to 5, and their median. The paper's figure 18 has the means.
#   gnuplot -e "in='survey-answers.csv'; out='survey.png'" report-survey.gp
# in: a file of ethd-report. note may be left out; svg: draw an SVG, whose words can be read.
if (!exists("in") || !exists("out")) { print "report-survey.gp: set in and out: gnuplot -e \"in='survey-answers.csv'; out='survey.png'\" report-survey.gp"; exit status 2 }
if (!exists("note")) note = ""
set datafile separator comma
set datafile columnheaders
cells = 0
stats in using (cells = column("cell") > cells ? column("cell") : cells, 0) nooutput
each = 74 + 34*cells
high = 120 + 3*each
if (exists("svg")) { set terminal svg size 1100,high font "DejaVu Sans,15" background "#ffffff" } else { set terminal pngcairo size 1100,high font "Sans,15" background "#ffffff" }
set output out
grey = "#7a7a7a"
array tints[5] = [0x2166ac, 0x92c5de, 0xf2f2f2, 0xf4a582, 0xb2182b]
set border 0
set tics nomirror textcolor rgb "#333333" scale 0
set xrange [0:100]
set yrange [cells + 0.6:0.4]
unset key
array says[3] = ["Q1: felt well before (1), just when (3), well after (5) the touch was seen", \
  "Q2: the wall moved to the left (1), stood still (3), moved to the right (5)", "Q3: very natural (1) to very unnatural (5)"]
array ideal[3] = ["3", "3", "1"]
only(q) = column("question") == q && column("n") > 0
share(k) = 100.0*column(sprintf("n%d", k))/column("n")
below(k) = k < 1 ? 0 : sum [j=1:k] share(j)
set multiplot
set label 1 "Survey: how many gave each answer" at screen 0.03,1 - 24.0/high font "Sans Bold,18"
set label 2 note at screen 0.03,1 - 50.0/high font "Sans,13" textcolor rgb grey
do for [q=1:3] {
  set lmargin at screen 0.16; set rmargin at screen 0.89
  set tmargin at screen 1 - (102.0 + (q - 1)*each)/high; set bmargin at screen 1 - (102.0 + (q - 1)*each + 34.0*cells)/high
  set title says[q]."; ideal ".ideal[q] font "Sans,14" offset 0,-0.5
  if (q == 3) { set xtics ("0 %%" 0, "50 %%" 50, "100 %%" 100) } else { set xtics ("" 0) }
  set xtics format ""
  plot for [k=1:5] in using (only(q) ? (below(k) + below(k - 1))/2 : NaN):"cell":(below(k - 1)):(below(k)):(column("cell") - 0.38):(column("cell") + 0.38):ytic(strcol("transition").", ".strcol("speed")) \
      with boxxyerror lc rgb tints[k] fs solid 1 border lc rgb "#ffffff", \
    for [k=1:5] in using (only(q) && share(k) >= 6 ? (below(k) + below(k - 1))/2 : NaN):"cell":(sprintf("%d", k)) \
      with labels font "Sans,12" textcolor rgb (k == 1 || k == 5 ? "#ffffff" : "#333333"), \
    in using (only(q) ? 100 : NaN):"cell":(sprintf("  median %g", column("median"))) with labels left font "Sans,12" textcolor rgb "#333333"
  unset label
}
unset multiplot
