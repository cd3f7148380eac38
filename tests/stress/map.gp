# Which K_e and B_e are stable, by delay and mass: cells are simulated, the line, of the file `curve`, is the closed form.
if (!exists("curve")) { print "map.gp: set curve, too"; exit status 2 }
if (!exists("velocity")) velocity = "difference"
set terminal pngcairo size 1400,960 font "Sans,14"
set output out

unset grid
set border 15 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6 front
set xrange [2:6]
set yrange [0:3]
set xtics ("10^2" 2, "10^3" 3, "10^4" 4, "10^5" 5, "10^6" 6)
set ytics ("1" 0, "10" 1, "10^2" 2, "10^3" 3)
set palette defined (0 "#0b5a43", 1 "#3f9b78", 2 "#a9d8b8", 3 "#e9f4dc")
set cbrange [0:3]
set cbtics ("1" 0, "10" 1, "100" 2, "1000" 3)
set cblabel "a swing falls to 1/e within, ms"
set object 1 rectangle from graph 0,0 to graph 1,1 fc rgb "#f4dcd3" fs solid noborder behind

here(n, m) = strcol("velocity") eq velocity && column("delay_ticks") == n && abs(column("mass_kg") - m) < 1e-9
lg(x) = log10(x)
within(x, a, b) = x < a ? a : x > b ? b : x
fade(g) = g < 0 ? within(lg(-1 / g), 0, 3) : NaN
# The file holds a grid of cells for each panel, one after the other.
stats in using (here(0, 0.1) ? 1 : NaN) nooutput name "CELL"
cells = int(CELL_records)
panel(row, delay) = ((velocity eq "lowpass" ? 6 : 0) + 3 * row + delay) * cells

set multiplot
set label 1 "Stable gains of the sampled wall, F = -K_e x - B_e v, 1 kHz, velocity: ".(velocity eq "lowpass" ? "low-pass of 130 Hz" : velocity) \
  at screen 0.06,0.965 font "Sans Bold,19"
set label 2 "simulated with the library's step on an exact mass: green settles, red grows. Line: closed form. Cross: the paper's gains, 2500 N/m and 45 Ns/m." \
  at screen 0.06,0.932 font "Sans,13" textcolor rgb grey
do for [row = 0:1] {
  do for [delay = 0:2] {
    m = row ? 0.3 : 0.1
    set lmargin at screen 0.065 + 0.285 * delay
    set rmargin at screen 0.065 + 0.285 * delay + 0.245
    set tmargin at screen 0.88 - 0.425 * row
    set bmargin at screen 0.88 - 0.425 * row - 0.34
    set title sprintf("%g kg, %d tick%s of delay", m, delay, delay == 1 ? "" : "s") font "Sans,14" offset 0,-0.6
    if (row) {set xlabel "K_e, N/m"} else {set xlabel ""}
    if (delay) {set ylabel ""} else {set ylabel "B_e, Ns/m"}
    if (delay == 2) {set colorbox user origin 0.915,0.115 size 0.018,0.765} else {unset colorbox}
    from = panel(row, delay); to = from + cells - 1
    plot in every ::from::to using (lg(column("k_npm"))):(lg(column("b_nspm"))):(fade(column("growth_per_tick"))) \
           with image pixels, \
         curve using (here(delay, m) ? lg(column("k_npm")) : NaN):(lg(column("b_nspm"))) with lines lc rgb "#8c1d18" lw 2.2, \
         "+" using (lg(2500)):(lg(45)) every ::0::0 with points pt 2 ps 1.6 lw 2.4 lc rgb "#1c1c1c"
    unset label 1; unset label 2
  }
}
unset multiplot
