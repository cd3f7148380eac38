# How late the loop woke and how long its ticks took: of so many, how many took longer.
#   gnuplot -e "in='latency.csv'; out='latency.png'" latency.gp
# in: a file of ethd-latency --csv.
if (!exists("in") || !exists("out")) { print "latency.gp: set in and out: gnuplot -e \"in='latency.csv'; out='latency.png'\" latency.gp"; exit status 2 }

set terminal pngcairo size 1100,640 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma

columns = int(system(sprintf("head -n 1 '%s' | awk -F, '{ print NF }'", in)))
total(c) = real(system(sprintf("awk -F, 'NR > 1 { n += $%d } END { print n + 0 }' '%s'", c, in)))
# share of the samples that took longer than the end of a bin, in us; the last one sits on the floor
tail(c) = sprintf("< awk -F, -v OFS=, 'NR > 1 { n += $%d; t[NR] = $2 * 1e6; k[NR] = n; if ($%d) last = NR } END { for (i = 2; i <= last; i++) { s = (n - k[i]) / n; print t[i], (s > 0 ? s : 0.5 / n) } }' '%s'", c, c, in)

grey = "#7a7a7a"
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid lc rgb "#e4e4e4" lt 1 lw 1
set logscale xy
set format y "10^{%T}"
set xlabel "us"
set ylabel "share that took longer"
set yrange [0.4/total(3):1.1]
set key top right spacing 1.3
set lmargin at screen 0.1
set rmargin at screen 0.95
set tmargin at screen 0.86
set bmargin at screen 0.13
set label 1 "Latency of the loop" at screen 0.1,0.955 font "Sans Bold,18"
set label 2 sprintf("%.0f ticks on this machine, beside what else ran; the right ends are the maxima", total(3)) \
  at screen 0.1,0.905 font "Sans,13" textcolor rgb grey

set style data lines
if (columns > 4) {
  plot tail(3) lw 2.4 lc rgb "#c0652b" title "wake-up", tail(4) lw 2.4 lc rgb "#5b7fa6" title "tick: read, step, write", \
    tail(5) lw 2 dt 2 lc rgb "#7a7a7a" title "cyclictest"
} else {
  plot tail(3) lw 2.4 lc rgb "#c0652b" title "wake-up", tail(4) lw 2.4 lc rgb "#5b7fa6" title "tick: read, step, write"
}
