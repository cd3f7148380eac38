# Scene queries: time over the number of segments, beside other libraries.
set terminal pngcairo size 1500,1000 font "Sans,15"
set output out
set datafile missing NaN

set logscale xy
set xrange [0.8:150000]
set yrange [8:2e6]
set format x "10^{%L}"

array names[4] = ["libethd", "libethd loose", "Embree", "CGAL"]
array tints[4] = ["#c0392b", "#e59866", "#1f5fa8", "#1e8449"]
# the libraries' versions follow their names
is(i) = strcol("contender") eq names[i] || (i > 2 && strstrt(strcol("contender"), names[i]) == 1)
here(i) = strcol("scene") eq scene && strcol("mode") eq mode && is(i)

left(c) = 0.075 + 0.31*c
place = 'set lmargin at screen left(col); set rmargin at screen left(col) + 0.28; set tmargin at screen row ? 0.46 : 0.845; set bmargin at screen row ? 0.085 : 0.505'
panel = 'plot for [k in scene eq "contour" ? "4 3 2 1" : "4 3 1"] in using (here(int(k)) ? column("segments") : NaN):(here(int(k)) ? column("mean_ns") : NaN) with linespoints lc rgb tints[int(k)] lw (k eq "1" ? 3 : 1.8) pt 7 ps (k eq "1" ? 1.3 : 0.9)'

set multiplot
set label 1 "The nearest of n segments: mean time of a query, caches hot" at screen 0.075,0.965 font "Sans Bold,18"
do for [i=1:4] {
  set arrow 10 + i from screen 0.075 + 0.13*(i-1),0.925 to screen 0.095 + 0.13*(i-1),0.925 nohead lc rgb tints[i] lw (i == 1 ? 3 : 2)
  set label 10 + i names[i] at screen 0.101 + 0.13*(i-1),0.925 font "Sans,14"
}
array modes[3] = ["horizon", "warm", "incoherent"]
array says[3] = ["1 kHz path, within 40 mm", "1 kHz path, last answer known", "anywhere, nothing known"]
do for [r=0:1] {
  do for [c=0:2] {
    row = r; col = c; eval(place)
    scene = r ? "contour" : "random"; mode = modes[c + 1]
    if (r == 0) { set title says[c + 1] font "Sans,15" offset 0,-0.4; unset xlabel } else { unset title; set xlabel "segments" offset 0,0.3 }
    if (c == 0) { set ylabel (r ? "one wavy contour" : "random segments") font "Sans,15" offset 0.8; set ytics ("10 ns" 10, "100 ns" 100, "1 us" 1000, "10 us" 1e4, "100 us" 1e5, "1 ms" 1e6) } else { unset ylabel; set ytics ("" 10, "" 100, "" 1000, "" 1e4, "" 1e5, "" 1e6) }
    if (r == 1) { set xtics ("1" 1, "10" 10, "100" 100, "1k" 1000, "10k" 10000, "100k" 100000) } else { set xtics ("" 1, "" 10, "" 100, "" 1000, "" 10000, "" 100000) }
    eval(panel)
    unset label; unset arrow
  }
}
unset multiplot
