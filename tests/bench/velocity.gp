# Velocity estimators: run time against error, lag against noise, and when the ring is said to stand still.
set terminal pngcairo size 1500,720 font "Sans,15"
set output out

families = "difference lowpass lsq foaw kalman 'kalman with torque'"
colors = "0x7a7a7a 0xd98a00 0x2e7d4f 0x1f5fa8 0x8e44ad 0xc0392b"
tint(i) = int(word(colors, i))
of(f, name) = strcol("method") eq f ? column(name) : NaN

set multiplot
set tmargin at screen 0.775
set bmargin at screen 0.115
set label 1 "Joint speed from an encoder: run time, noise and lag" at screen 0.055,0.955 font "Sans Bold,18"
set label 2 "simulated: 48000 counts a turn read every ms, a count a tick is 32.7 mm/s at the ring; braking as plant n does it, from 0.4 m/s to 20 mm/s in 8.2 ms" \
  at screen 0.055,0.912 font "Sans,13" textcolor rgb grey
do for [i = 1:words(families)] {
  set label 10 + i word(families, i) at screen 0.07 + (i < 2 ? 0 : i < 3 ? 0.105 : i < 4 ? 0.195 : i < 5 ? 0.255 : i < 6 ? 0.32 : 0.40),0.866 \
    font "Sans,14" point pt 7 ps 1.5 lc rgb tint(i) offset 1,0
}
set label 20 "numbers: Hz; samples; unknown acceleration in rad/s^2" at screen 0.63,0.866 font "Sans,13" textcolor rgb grey

set lmargin at screen 0.055
set rmargin at screen 0.32
set title "run time against error" font "Sans,15" offset 0,-0.5
set logscale xy
set xrange [1:200]
set yrange [0.05:300]
set xlabel "run time of a step, ns" offset 0,0.3
set ylabel "rms error, mm/s; full: at 30 mm/s, open: braking" offset 1.5
plot for [i = 1:words(families)] in using (of(word(families, i), "time_ns")):"steady_rms_mmps" with points pt 7 ps 1.5 lc rgb tint(i), \
     for [i = 1:words(families)] in using (of(word(families, i), "time_ns")):"braking_rms_mmps" with points pt 6 ps 1.5 lw 2 lc rgb tint(i)
unset label

set lmargin at screen 0.395
set rmargin at screen 0.655
set title "noise against lag"
set xrange [0.05:20]
set yrange [4:300]
set xlabel "rms error at 30 mm/s, mm/s"
set ylabel "rms error while braking, mm/s"
plot for [i = 1:words(families)] in using (of(word(families, i), "steady_rms_mmps")):"braking_rms_mmps" with linespoints pt 7 ps 1.5 lw 1.6 lc rgb tint(i), \
     in using "steady_rms_mmps":"braking_rms_mmps":(column("setting") > 0 ? sprintf("%g", column("setting")) : "") with labels left offset 0.9,0.35 font "Sans,12" textcolor rgb "#333333"

set lmargin at screen 0.73
set rmargin at screen 0.985
set title "|v| < v_{th} = 20 mm/s declared"
set xrange [0.05:20]
unset logscale y
set yrange [0:8]
set ylabel "after the truth, ms; mean and sd" offset 0.5
plot for [i = 1:words(families)] in using (column("shown") == 1 ? of(word(families, i), "steady_rms_mmps") : NaN):"declared_ms":"declared_sd_ms" with yerrorbars pt 7 ps 1.5 lw 1.6 lc rgb tint(i), \
     in using (column("shown") == 1 ? column("steady_rms_mmps") : NaN):"declared_ms":(column("setting") > 0 ? sprintf("%g", column("setting")) : "") with labels left offset 0.9,0.45 font "Sans,12" textcolor rgb "#333333"
unset multiplot
