# Early touches and felt offset of taps on an arm, against its delay, the gap and the bias of the headset.
#   gnuplot -e "in='sweep.csv'; out='sweep.png'; laws='smooth approach'; base='8 60 0'" sensitivity.gp
# in: a file of ethd-tap --arm --plot. laws: those that are drawn; base: the values (ms, mm, mm) while another one is varied. name: the title.
if (!exists("in") || !exists("out") || !exists("laws")) { print "sensitivity.gp: set in, out and laws"; exit status 2 }
if (!exists("name")) name = in
if (!exists("base")) base = ""
set terminal pngcairo size 1500,880 font "Sans,14" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set grid lc rgb "#e4e4e4" lt 1
set border 3 lc rgb "#7a7a7a"
set tics nomirror
varied = "delay_s gap_m bias_m"
titles = "'delay of the arm, ms' 'gap from finger to plate, mm' 'bias of the headset, mm'"
colours = "#7a7a7a #c0392b #d98a00 #2e7d4f #1f5fa8 #6a51a3"
known = "abrupt smooth offset predictive approach"
colour(law) = word(colours, (k = 0, sum [i=1:words(known)] (word(known, i) eq law ? (k = i) : 0), k > 0 ? k : 6))
is(law, i) = strcol("transition") eq law && strcol("varied") eq word(varied, i)
at(law, i, y) = is(law, i) ? y : NaN
x(i) = 1e3*column("value")
left(i) = 0.08 + 0.31*(i - 1)

set multiplot title name font "Sans Bold,17"
do for [i=1:3] {
  set lmargin at screen left(i)
  set rmargin at screen left(i) + 0.29
  set xrange [*:*]
  set yrange [*:*]
  unset logscale y
  stats in using (strcol("varied") eq word(varied, i) ? x(i) : NaN) nooutput name "X"
  pad = 0.03*(X_max - X_min)
  set xrange [X_min - pad:X_max + pad]
  if (words(base) == 3) {
    here = real(word(base, i))
    set arrow 1 from here,graph 0 to here,graph 1 nohead lc rgb "#aaaaaa" lw 1.4 back
  }
  set tmargin at screen 0.91
  set bmargin at screen 0.53
  set format y i == 1 ? "%g" : ""
  set yrange [-3:103]
  set ytics 20
  set format x ""
  unset xlabel
  set ylabel i == 1 ? "early touches, %" : "" offset 1
  set key at screen 0.99,0.955 right vertical maxrows 1 Left reverse samplen 1.6 width 1
  plot for [j=1:words(laws)] in using (x(i)):(at(word(laws, j), i, 100*column("early_share"))) \
    with linespoints pt 7 ps 0.9 lw 2.2 lc rgb colour(word(laws, j)) title i == 3 ? word(laws, j) : ""
  set tmargin at screen 0.49
  set bmargin at screen 0.09
  set logscale y
  set yrange [0.001:200]
  set ytics auto
  set format x "%g"
  set xlabel word(titles, i) offset 0,0.4
  set ylabel i == 1 ? "felt offset without sign, mm\n{/*0.85 mean, and dashed the largest}" : "" offset 0.5
  plot for [j=1:words(laws)] in using (x(i)):(at(word(laws, j), i, 1e3*abs(column("felt_m")))) \
    with linespoints pt 7 ps 0.9 lw 2.2 lc rgb colour(word(laws, j)) title "", \
    for [j=1:words(laws)] in using (x(i)):(at(word(laws, j), i, 1e3*abs(column("deepest_m")))) \
    with lines lw 1.4 dt (6,4) lc rgb colour(word(laws, j)) title ""
}
unset multiplot
