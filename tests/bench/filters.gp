# Finger filters: run time against the error of the extrapolated position.
set terminal pngcairo size 1250,800 font "Sans,15"
set output out

any = 0
stats in using (any = any + (strcol("set") eq "all recorded"), 0) nooutput
set logscale xy
set xrange [0.4:300]
set yrange [0.06:4]
set ytics (0.1, 0.2, 0.5, 1, 2)
set xlabel "run time of a tick, ns" offset 0,0.3

tint(m) = m eq "ca" ? 0xc0392b : m eq "cv" ? 0xd98a00 : m eq "alpha-beta" ? 0x2e7d4f : m[1:5] eq "Eigen" ? 0x1f5fa8 : 0x7a7a7a
here(ms) = strcol("set") eq set && column("latency_ms") == ms ? column("time_ns") : NaN
# where names stand, with gnuplot's words for it
name = 'with labels font "Sans,14" textcolor rgb "#333333"'
at(m, ms) = (strcol("method")[1:5] eq m[1:5] ? here(ms) : NaN)
panel = 'plot for [ms in "0 3 6"] in using (here(int(ms))):"error_rms_mm":(tint(strcol("method"))) with points pt (ms eq "0" ? 7 : ms eq "3" ? 9 : 5) ps 1.6 lc rgb variable, \
  in using (at("ca", 0)):"error_rms_mm":"method" @name center offset 0,-0.95, \
  in using (at("alpha-beta", 0)):"error_rms_mm":"method" @name right offset 0.8,-0.95, \
  in using (at("cv", 6)):"error_rms_mm":"method" @name center offset 0,1.0, \
  in using (at("hold", 6)):"error_rms_mm":"method" @name center offset 0,1.0, \
  in using (at("two readings", 6)):"error_rms_mm":"method" @name center offset 0,1.0, \
  in using (at("Eigen", 3)):"error_rms_mm":(strcol("method")." (ca)") @name left offset 1.2,0'

set multiplot
set tmargin at screen 0.80
set bmargin at screen 0.11
set label 1 "Where the finger is now, from late readings: run time against error" at screen 0.085,0.958 font "Sans Bold,18"
set label 2 "readings at 300 Hz, 0.1 mm of simulated noise; output every ms; all tuned to the reaches; reference: the movement" \
  at screen 0.085,0.918 font "Sans,13" textcolor rgb grey
do for [k = 0:2] {
  set label 10 + k sprintf("latency %d ms", 3*k) at screen 0.11 + 0.13*k,0.880 font "Sans,14" point pt (k == 0 ? 7 : k == 1 ? 9 : 5) ps 1.5 lc rgb "#555555" offset 1.2,0
}

set lmargin at screen 0.085
set rmargin at screen 0.50
set title "40 minimum-jerk reaches, 0.5 to 1.1 m/s" font "Sans,15" offset 0,-0.5
set ylabel "rms error, mm (each axis)" offset 0.5
set = "reaches"
eval(panel)
unset label

set lmargin at screen 0.565
set rmargin at screen 0.98
unset ylabel
set title any ? "recorded human movements" : "recorded human movements: none were there"
set = "all recorded"
if (any) {eval(panel)} else {plot NaN}
unset multiplot
