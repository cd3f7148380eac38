# The four metrics of the paper's figures 14 to 17: medians, quartiles and extremes of the valid taps.
#   gnuplot -e "in='taps.csv'; out='boxes.png'" boxes.gp
# in: a file of ethd-tap --csv with laws smooth and offset at low and high. plant names the plant in the title.
if (!exists("in") || !exists("out")) { print "boxes.gp: set in and out: gnuplot -e \"in='taps.csv'; out='boxes.png'\" boxes.gp"; exit status 2 }
if (!exists("plant")) plant = "n"

set terminal pngcairo size 1200,1080 font "Sans,15" background "#ffffff"
set output out
set datafile separator comma
set datafile columnheaders

a = "#5b7fa6"; b = "#c0652b"; grey = "#7a7a7a"
set style data boxplot
set style boxplot fraction 1.0 nooutliers
set style fill solid 0.35 border
set boxwidth 0.5
set border 3 lc rgb grey
set tics nomirror textcolor rgb "#333333" scale 0.6
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set xtics ("A\nlow" 1, "B\nlow" 2, "A\nhigh" 3.4, "B\nhigh" 4.4) scale 0
set xrange [0.4:5]
unset key

# NaN drops a row
pick(law, speed, name, scale) = (strcol("transition") eq law && strcol("speed") eq speed && column("valid") == 1 ? scale*column(name) : NaN)
array taps[4] = [0, 0, 0, 0]
array laws[4] = ["smooth", "offset", "smooth", "offset"]
array speeds[4] = ["low", "low", "high", "high"]
do for [k=1:4] { stats in using (taps[k] = taps[k] + (pick(laws[k], speeds[k], "valid", 1) == 1), 0) nooutput }
panel = 'plot zero with lines lc rgb "#999999" lw 1, \
  in using (1):(pick("smooth", "low", name, scale)) lc rgb a lw 1.8, \
  in using (2):(pick("offset", "low", name, scale)) lc rgb b lw 1.8, \
  in using (3.4):(pick("smooth", "high", name, scale)) lc rgb a lw 1.8, \
  in using (4.4):(pick("offset", "high", name, scale)) lc rgb b lw 1.8'
zero = 0
# gnuplot draws a median in its box's colour; these are red, as a report's are.
medians = 'do for [k=1:4] { \
  stats in using (pick(laws[k], speeds[k], name, scale)) name "M" nooutput; x = real(word("1 2 3.4 4.4", k)); \
  set arrow k from x - 0.25,M_median to x + 0.25,M_median nohead front lc rgb "#c00000" lw 3 }'

set multiplot
set label 1 "Taps on a virtual wall: medians, quartiles, extremes" at screen 0.075,0.968 font "Sans Bold,18"
set label 2 "simulated; plant ".plant." is fitted to Table 1, not measured. Valid taps: ". \
  sprintf("A low %d, B low %d, A high %d, B high %d.", taps[1], taps[2], taps[3], taps[4]) \
  at screen 0.075,0.938 font "Sans,13" textcolor rgb grey
set label 3 "A" at screen 0.69,0.968 font "Sans Bold,15" textcolor rgb a
set label 4 "smooth (VO-A)" at screen 0.707,0.968 font "Sans,15" textcolor rgb "#333333"
set label 5 "B" at screen 0.845,0.968 font "Sans Bold,15" textcolor rgb b
set label 6 "offset (VO-B)" at screen 0.862,0.968 font "Sans,15" textcolor rgb "#333333"

left(i) = i ? 0.585 : 0.085
place = 'set lmargin at screen left(col); set rmargin at screen left(col) + 0.395; set tmargin at screen row ? 0.425 : 0.875; set bmargin at screen row ? 0.075 : 0.525'

row = 0; col = 0; eval(place)
set title "Ring's speed as it meets the wall, v_r(t_{r/vo})" font "Sans,15" offset 0,-0.4
set ylabel "m/s" offset 1
name = "v_rvo_mps"; scale = 1
set yrange [0:0.52]
eval(medians); eval(panel)
unset label

row = 0; col = 1; eval(place)
set title "Ring's speed as the finger touches it, v_r(t_{of/r})"
set yrange [*:*]
name = "v_of_mps"
eval(medians); eval(panel)

row = 1; col = 0; eval(place)
set title "First rebound, d_{max}"
set ylabel "mm"
set yrange [0:*]
name = "d_max_m"; scale = 1e3
eval(medians); eval(panel)

row = 1; col = 1; eval(place)
set title "Ring's smallest speed after the touch, v_{r min}"
set ylabel "m/s"
set yrange [*:*]
name = "v_rmin_mps"; scale = 1
eval(medians); eval(panel)
unset multiplot
