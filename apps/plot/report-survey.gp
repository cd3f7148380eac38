# Answers to one question by cell: a bar of shares of each answer; the median, and the mean as in the paper's figure 18.
#   gnuplot -e "in='survey-answers.csv'; out='survey-q1.png'; question='1'; answers='5'" report-survey.gp
# in: a file of ethd-report. scale says what the first and the last answer mean and may be left out; svg: draw an SVG,
# whose words can be read.
if (!exists("in") || !exists("out") || !exists("question") || !exists("answers")) { print "report-survey.gp: set in, out, question and answers: gnuplot -e \"in='survey-answers.csv'; out='survey-q1.png'; question='1'; answers='5'\" report-survey.gp"; exit status 2 }
if (!exists("scale")) scale = ""
set datafile separator comma
set datafile columnheaders
asked = question + 0
last = answers + 0
cells = 0
stats in using (cells = column("cell") > cells ? column("cell") : cells, 0) nooutput
high = 106 + 34*cells
if (exists("svg")) { set terminal svg size 1100,high noenhanced font "DejaVu Sans,15" background "#ffffff" } else { set terminal pngcairo size 1100,high noenhanced font "Sans,15" background "#ffffff" }
set output out
array tints[9] = [0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b]
tint(k) = int(1.5 + (k - 1)*8.0/(last - 1)) # of answer k: both ends of the scale and its middle are those of the tints
set border 0
set tics nomirror textcolor rgb "#333333" scale 0
set ytics left offset screen -0.16,0 # every line of words begins below the title
set xrange [0:100]
set yrange [cells + 0.6:0.4]
unset key
only(q) = column("question") == q && column("n") > 0
share(k) = 100.0*column(sprintf("n%d", k))/column("n")
below(k) = k < 1 ? 0 : sum [j=1:k] share(j)
set label 1 "Q".question.": shares of the answers, ".scale at screen 0.03,1 - 24.0/high font "Sans Bold,15"
set lmargin at screen 0.2; set rmargin at screen 0.82
set tmargin at screen 1 - 52.0/high; set bmargin at screen 1 - (52.0 + 34.0*cells)/high
set xtics ("0 %%" 0, "50 %%" 50, "100 %%" 100)
# labels have a place even where they are empty: gnuplot 5.4 ends on a list of labels that are all undefined
plot for [k=1:last] in using (only(asked) ? (below(k) + below(k - 1))/2 : NaN):"cell":(below(k - 1)):(below(k)):(column("cell") - 0.38):(column("cell") + 0.38):ytic(strcol("transition").", ".strcol("speed")) \
    with boxxyerror lc rgb tints[tint(k)] fs solid 1 border lc rgb "#bbbbbb", \
  for [k=1:last] in using (only(asked) ? (below(k) + below(k - 1))/2 : 0):"cell":(only(asked) && share(k) >= 6 ? sprintf("%d", k) : "") \
    with labels font "Sans,12" textcolor rgb (tint(k) < 3 || tint(k) > 7 ? "#ffffff" : "#333333"), \
  in using (100):"cell":(only(asked) ? sprintf("  median %g, mean %.2f", column("median"), column("mean")) : "") with labels left font "Sans,12" textcolor rgb "#333333"
