# Ring fits: time against the centre's error, beside the Cramer-Rao bound.
set terminal pngcairo size 1200,1000 font "Sans,15"
set output out

set xrange [0:250]
set logscale y
set yrange [0.05:8]
set ytics (0.05, 0.1, 0.2, 0.5, 1, 2, 5)

tint(m) = m eq "robust" ? 0xc0392b : m eq "kasa" ? 0xd98a00 : 0x1f5fa8
here(name) = strcol("scenario") eq scenario ? column(name) : NaN
left(i) = i ? 0.595 : 0.1
place = 'set lmargin at screen left(col); set rmargin at screen left(col) + 0.385; set tmargin at screen row ? 0.435 : 0.855; set bmargin at screen row ? 0.085 : 0.52'
panel = 'plot in using (0):(here("bound_sought_mm")):(250):(0) with vectors nohead lc rgb "#333333" lw 1.6 dt (12,6), \
  in using (0):(here("bound_known_mm")):(250):(0) with vectors nohead lc rgb "#333333" lw 1.6 dt (2,4), \
  in using (here("time_ns")):(column("error_rms_mm")):(tint(strcol("method"))) with points pt 7 ps 1.7 lc rgb variable, \
  in using (strcol("method") eq "kasa" ? here("time_ns") : NaN):"error_rms_mm":(strcol("method")) with labels right offset -1.2,0.55 font "Sans,14" textcolor rgb "#333333", \
  in using (strcol("method") eq "centroid" && scenario ne "arc" ? here("time_ns") : NaN):"error_rms_mm":(strcol("method")) with labels center offset 0,1.2 font "Sans,14" textcolor rgb "#333333", \
  in using (strcol("method") eq "centroid" && scenario eq "arc" ? here("time_ns") : NaN):"error_rms_mm":(strcol("method")) with labels left offset 1.2,-0.4 font "Sans,14" textcolor rgb "#333333", \
  in using (strcol("method") eq "kasa" || strcol("method") eq "centroid" ? NaN : here("time_ns")):"error_rms_mm":(strcol("method")) with labels left offset 1.2,0.55 font "Sans,14" textcolor rgb "#333333"'

set multiplot
set label 1 "Centre of the finger from 16 rays: run time against error" at screen 0.09,0.966 font "Sans Bold,18"
set label 2 "simulated: normal noise of 0.173 mm a ray, ring 12 mm, finger 7.5 mm within 4 mm of its middle" \
  at screen 0.09,0.935 font "Sans,13" textcolor rgb grey
set arrow 1 from screen 0.09,0.908 to screen 0.11,0.908 nohead lc rgb "#333333" lw 1.6 dt (12,6)
set label 3 "Cramer-Rao bound, radius sought" at screen 0.117,0.908 font "Sans,13"
set arrow 2 from screen 0.40,0.908 to screen 0.435,0.908 nohead lc rgb "#333333" lw 1.6 dt (2,4)
set label 4 "Cramer-Rao bound, radius known (robust knows it)" at screen 0.442,0.908 font "Sans,13"

row = 0; col = 0; eval(place)
set format x ""
set title "all 16 rays" font "Sans,15" offset 0,-0.5
set ylabel "rms error of the centre, mm" offset 0.5
scenario = "full"
eval(panel)
unset label; unset arrow

row = 0; col = 1; eval(place)
set title "an arc of 8 rays lost"
unset ylabel
scenario = "arc"
eval(panel)

row = 1; col = 0; eval(place)
set format x "%g"
set title "one ray off by 3 mm"
set xlabel "run time of a fit, ns" offset 0,0.3
set ylabel "rms error of the centre, mm" offset 0.5
scenario = "outlier"
eval(panel)

row = 1; col = 1; eval(place)
set title "rays read in turn within 3.3 ms, finger at 0.4 m/s"
unset ylabel
scenario = "skew"
eval(panel)
unset multiplot
