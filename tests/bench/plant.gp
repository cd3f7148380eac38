# The plant's integration: run time against error.
set terminal pngcairo size 1200,800 font "Sans,14"
set output out
# The names in order of appearance; NaN drops the rows of the others.
array names[99]
count = 0
known(name) = count == 0 ? 0 : sum [k = 1:count] (names[k] eq name)
stats in using (known(strcol(1)) || strcol(1) eq "method" ? 0 : (count = count + 1, names[count] = strcol(1)), 0) nooutput

set tmargin at screen 0.87
set label 1 "Moving the plant alone: run time against error" at screen 0.075,0.962 font "Sans Bold,18"
set label 2 "plant n, simulated, plausible and not measured; torques recorded in closed loop; against GSL's rk8pd with events at 10^{-14}" \
  at screen 0.075,0.922 font "Sans,12" textcolor rgb grey
set logscale xy
set xlabel "run time of a simulated second, s" offset 0,0.2
set format x "10^{%T}"
set format y "10^{%T}"
set yrange [1e-13:1e-3]
set ylabel "largest error of ring or finger, m" offset 0.5
set key outside right top Left reverse samplen 2 spacing 1.3 noenhanced
array colour[13] = [0xc0392b, 0xe59866, 0xcfcfcf, 0xa8a8a8, 0x707070, 0x303030, 0x1f5fa8, 0x7fb0e0, 0x7d3c98, 0x2e8b57, 0x8fcfa8, 0xb7950b, 0x117a8b]
plot for [i = 1:count] in using 4:(strcol(1) eq names[i] ? $3 : NaN) with linespoints pt 7 ps (i == 1 ? 1.5 : 0.9) lw (i == 1 ? 3 : 1.5) \
  lc rgb colour[i] title names[i]
