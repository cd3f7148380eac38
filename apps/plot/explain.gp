# What the paper says, a row each, and where plants lie in the bounds of it: in the strip a line is met.
#   gnuplot -e "in='lines.csv'; out='lines.png'" explain.gp
# in: a file of ethd-explain --csv.
if (!exists("in") || !exists("out")) { print "explain.gp: set in and out: gnuplot -e \"in='lines.csv'; out='lines.png'\" explain.gp"; exit status 2 }

set terminal pngcairo size 1080,840 font "Sans,12" noenhanced background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set datafile missing NaN

grey = "#7a7a7a"
least = -1.5
most = 2.5
rows = 24
array colour[8] = ["#2f5d8a", "#d9a441", "#5b9e8f", "#b8452f", "#7a5ba6", "#4d4d4d", "#8fb04a", "#c06090"]
array shape[8] = [7, 5, 9, 13, 11, 4, 6, 8]

# the names of the plants, each of which has as many rows as there are lines
array plant[8]
count = 0
stats in using (int($0) % rows == 0 ? (count = count + 1, plant[count] = strcol("plant"), 0) : 0) nooutput

set border 1 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.4
set lmargin at screen 0.46
set rmargin at screen 0.96
set tmargin at screen 0.855
set bmargin at screen 0.085
set xrange [least - 0.15:most + 0.15]
set yrange [rows + 0.7:0.3]
set xtics ("lower bound" 0, "upper bound" 1, "" -1, "" 2)
set label 1 "What the paper says, and what plants make of it" at screen 0.03,0.965 font "Sans Bold,17"
set label 2 "24 lines, their bounds drawn as wide as each other: a mark in the strip meets its line, one at an edge is far out or has no value" \
  at screen 0.03,0.928 font "Sans,12" textcolor rgb grey
set label 3 "Table 1" at screen 0.03,graph 0.845 font "Sans Bold,12"
set label 4 "section 4" at screen 0.03,graph 0.45 font "Sans Bold,12"
set label 5 "gains" at screen 0.03,graph 0.11 font "Sans Bold,12"
set object 1 rectangle from 0, graph 0 to 1, graph 1 fc rgb "#e3eee3" fs solid noborder behind
set arrow 1 from graph 0, first 8.5 to graph 1, first 8.5 nohead lc rgb grey lw 1
set arrow 2 from graph 0, first 19.5 to graph 1, first 19.5 nohead lc rgb grey lw 1
do for [i = 1:rows] { set arrow 10 + i from graph 0, first i to graph 1, first i nohead lc rgb "#e4e4e4" lw 1 back }
set key at screen 0.96,0.893 right top horizontal maxrows 1 samplen 1 font "Sans,12"

within(x) = x < least ? least : x > most ? most : x
# a value that a plant doesn't have is at the right edge
plot in every ::0::rows - 1 using (0.5):"line":ytic(10) with points ps 0 notitle, \
  for [k = 1:count] in every ::(k - 1) * rows::k * rows - 1 \
    using (strcol("place") eq "" ? most : within(column("place"))):(column("line") + 0.16 * (k - (count + 1) / 2.0)) \
    with points pt shape[k] ps 1.3 lc rgb colour[k] title plant[k]
