# As the paper's figures 9 and 10, or 11 and 12, and the law that brakes before the wall beside them: a typical tap of each.
#   gnuplot -e "in='traces'; speed='high'; out='taps.png'" taps.gp
# in: a folder of ethd-tap --trace with smooth-, offset- and predictive-SPEED.csv. plant names the plant in the title, scale that of the picture.
if (!exists("in") || !exists("out")) { print "taps.gp: set in and out"; exit status 2 }
if (!exists("speed")) speed = "high"
if (!exists("plant")) plant = "q"
if (!exists("scale")) scale = 1.0
set terminal pngcairo size 1500*scale,900*scale font "Sans,14" fontscale scale linewidth scale background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders
set grid lc rgb "#e4e4e4" lt 1
set border 3 lc rgb "#7a7a7a"
set tics nomirror
laws = "smooth offset predictive"
first = speed eq "low" ? 9 : 11
names = sprintf("'smooth (VO-A, figure %d)' 'offset (VO-B, figure %d)' 'predictive'", first, first + 1)
file(i) = in."/".word(laws, i)."-".speed.".csv"
t(x) = 1e3*column("since_wall_s")
left(i) = 0.055 + 0.32*(i - 1)
set xrange [-40:90]

set multiplot title "A typical tap at ".speed." speed (simulated; plant ".plant." is fitted to Table 1, not measured)" font "Sans Bold,17"
do for [i=1:3] {
  touch = NaN
  stats file(i) using (column("since_wall_s") >= -0.02 && column("pad_force_N") > 0 && touch != touch ? (touch = t(0)) : 0) nooutput
  moved = 0
  stats file(i) using (moved = moved + (strlen(strcol("offset_wall_m")) > 0), 0) nooutput
  set lmargin at screen left(i)
  set rmargin at screen left(i) + 0.275
  set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb "#aaaaaa" lw 1.4
  if (touch == touch) {set arrow 2 from touch,graph 0 to touch,graph 1 nohead lc rgb "#1f5fa8" lw 1.2 dt (2,3)}
  set tmargin at screen 0.89
  set bmargin at screen 0.47
  set title word(names, i) offset 0,-0.5
  set yrange [-12:6]
  set format x ""
  unset xlabel
  set ylabel i == 1 ? "position along n, mm" : "" offset 1
  set key bottom right Left reverse samplen 1.5
  plot 0 with lines lc rgb "#333333" lw 1.6 dt (14,6) title i == 1 ? "wall x_e" : "", \
       file(i) using (t(0)):(moved ? 1e3*column("offset_wall_m") : 0) with lines lc rgb (moved ? "#d98a00" : "#333333") lw 2.2 dt (6,4) title (moved ? "wall x_{/Symbol e}" : ""), \
       file(i) using (t(0)):(1e3*column("finger_m")) with lines lc rgb "#1f5fa8" lw 2.2 title i == 1 ? "finger's pad" : "", \
       file(i) using (t(0)):(1e3*column("ring_m")) with lines lc rgb "#c0392b" lw 2.4 title i == 1 ? "ring's front" : ""
  set tmargin at screen 0.43
  set bmargin at screen 0.08
  unset title
  set yrange [-0.5:0.8]
  set format x "%g"
  set xlabel "time from t_{r/vo}, ms" offset 0,0.4
  set ylabel i == 1 ? "speed along n, m/s" : "" offset 1
  if (touch == touch) {set label 1 " finger touches" at touch, graph 0.95 textcolor rgb "#1f5fa8" font "Sans,12"}
  plot 0 with lines lc rgb "#bbbbbb" notitle, \
       file(i) using (t(0)):"v_finger_mps" with lines lc rgb "#1f5fa8" lw 1.6 notitle, \
       file(i) using (t(0)):"v_ring_mps" with lines lc rgb "#c0392b" lw 2.4 notitle
  unset label 1
  unset arrow
}
unset multiplot
