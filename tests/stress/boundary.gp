# The sampled loop's boundary of stability: found by simulation (points), closed form (lines), in units of the
# mass and the period.
set terminal pngcairo size 1200,960 font "Sans,14"
set output out

array tone[3] = ["#1f5fa8", "#c0652b", "#2e7d4f"]
array velocity[4] = ["difference", "lowpass 130 Hz", "lowpass 400 Hz", "lsq of 4"]
set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set xrange [1e-4:1]
set yrange [1e-3:3]
set key left top Left reverse samplen 1.5 spacing 1.2

here(v, n) = strcol("velocity") eq v && column("delay_ticks") == n
k(name) = column(name) * column("period_s")**2 / column("mass_kg")
b(name) = column(name) * column("period_s") / column("mass_kg")

set multiplot
set label 1 "Boundary of stability, F = -K x - B v, n ticks late, by velocity estimator" at screen 0.07,0.965 font "Sans Bold,19"
set label 2 "points: where the library's step on an exact mass begins to grow, by bisection. Lines: closed form. Stable on the left." \
  at screen 0.07,0.935 font "Sans,13" textcolor rgb grey
do for [i = 1:4] {
  c = (i - 1) % 2; r = (i - 1) / 2
  set lmargin at screen 0.085 + 0.48 * c
  set rmargin at screen 0.085 + 0.48 * c + 0.415
  set tmargin at screen 0.88 - 0.43 * r
  set bmargin at screen 0.88 - 0.43 * r - 0.33
  set title velocity[i] font "Sans,15" offset 0,-0.6
  if (r) {set xlabel "K T^2 / m"} else {set xlabel ""}
  if (c) {set ylabel ""} else {set ylabel "B T / m"}
  plot for [n = 0:2] in using (here(velocity[i], n) ? k("k_analytic_npm") : NaN):(b("b_analytic_nspm")) \
         with lines lc rgb tone[n + 1] lw 1.8 notitle, \
       for [n = 0:2] in using (here(velocity[i], n) ? k("k_found_npm") : NaN):(b("b_found_nspm")) \
         with points pt 7 ps 0.7 lc rgb tone[n + 1] title sprintf("n = %d", n)
  unset label 1; unset label 2
}
unset multiplot
