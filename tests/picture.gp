# What the pictures of bench have in common. A picture's own file, or race.gp, follows:
#   gnuplot -e "in='NAME.csv'; out='NAME.png'" tests/picture.gp tests/bench/race.gp
if (!exists("in") || !exists("out")) { print "picture.gp: set in and out"; exit status 2 }
set datafile separator comma
set datafile columnheaders
grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
unset key
