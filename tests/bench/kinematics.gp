# Kinematics of the planar arm: time against error.
set terminal pngcairo size 1100,700 font "Sans,15"
set output out

set tmargin at screen 0.86
set label 1 "Kinematics of a planar arm: forward kinematics, Jacobian, J^Tf and J^{-1}e" at screen 0.075,0.955 font "Sans Bold,18"
set label 2 "at 1024 places of the workspace away from singularities, links 0.25 m; reference: long double" \
  at screen 0.075,0.912 font "Sans,13" textcolor rgb grey
set logscale x
set xrange [10:1000]
set xlabel "run time of one place, ns" offset 0,0.2
set format y "%.1f"
set yrange [0:1.6]
set ylabel "largest error, 10^{-15} of the largest value" offset 0.5
ours(s) = s[1:7] eq "libethd"
tint(s) = ours(s) ? 0xc0392b : 0x1f5fa8
e(i) = 1e15*column("error_relative")
# labels of close neighbours stand apart
apart(i) = strstrt(strcol("method"), "libm") ? 0.055 : strstrt(strcol("method"), "libethd serial") ? -0.055 : 0
plot in using "time_ns":(e(0)):(tint(strcol("method"))) with points pt 7 ps 1.8 lc rgb variable, \
     in using "time_ns":(e(0) + apart(0)):(sprintf("%s, %.0f ns", strcol("method"), column("time_ns"))) with labels left offset 1.4,0 font "Sans,14" textcolor rgb "#333333"
