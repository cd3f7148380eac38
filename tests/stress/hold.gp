# Which rates and told masses hold a ring before the wall, by the observer's memory and the device's delay.
set terminal pngcairo size 1300,1150 font "Sans,13"
set output out
unset grid
set border 15 lc rgb grey
set tics nomirror scale 0.6 front
set xrange [0.025:0.525]
set yrange [0.45:2.05]
set xlabel "rate T (the law keeps to 1/2)"
set ylabel "told mass / mass"
set palette defined (0 "#0b5a43", 1 "#3f9b78", 2 "#a9d8b8", 3 "#e9f4dc")
set cbrange [0:2]
set cbtics ("1" 0, "10" 1, "100" 2)
set cblabel "a swing falls to 1/e within, ms"
set object 1 rectangle from graph 0,0 to graph 1,1 fc rgb "#f4dcd3" fs solid noborder behind
here(n, b) = column("delay_ticks") == n && abs(column("memory") - b) < 1e-9
within(x, a, b) = x < a ? a : x > b ? b : x
fade(g) = g < -0.025 ? within(log10(-1/g), 0, 2) : NaN
set multiplot layout 3,3 title "Held before the wall by predictive; red: a swing doesn't fade (simulated, the real law)" font "Sans Bold,16"
do for [n=0:2] {
  do for [b in "0.3 0.6 0.9"] {
    set title sprintf("memory %s, %d tick%s late", b, n, n == 1 ? "" : "s")
    plot in using (here(n, b + 0) && column("growth_per_tick") < -0.025 ? column("rate_t") : NaN):"told_mass":(fade(column("growth_per_tick"))) with points pt 5 ps 1.75 palette
  }
}
unset multiplot
