# The whole tick: how many take longer than a time.
set terminal pngcairo size 1000,760 font "Sans,15"
set output out

here(what, scene, finger) = strcol("what") eq what && strcol("law") eq "offset" && strcol("scene") eq scene && strcol("finger") eq finger
tail(what, scene, finger) = here(what, scene, finger) && strcol("name") eq "tail" ? column("time_ns") : NaN

set tmargin at screen 0.79
set bmargin at screen 0.12
set label 1 "The whole tick of the controller, recording included" at screen 0.07,0.957 font "Sans Bold,18"
set label 2 "simulated taps on an outline of 1000 segments, law offset, finger from 16 rays. Cold: 32 MB written before. Live: a loop at 1 kHz" \
  at screen 0.07,0.915 font "Sans,13" textcolor rgb grey

set title "share of ticks that take longer" font "Sans,15" offset 0,-0.5
set logscale xy
set xrange [40:100000]
set yrange [1e-4:1]
set format y "10^{%L}"
set xlabel "run time of a tick, ns" offset 0,0.3
do for [k = 1:5] {
  set label 10 + k word("'hot, known finger' hot cold live 'live, early'", k) at graph 0.75,graph 0.99 - 0.055*k font "Sans,14" \
    textcolor rgb word("#9a9a9a #c0392b #1f5fa8 #d98a00 #2e7d4f", k)
}
plot in using (tail("hot", "1000", "known")):"share_longer" with lines lw 2.4 lc rgb "#9a9a9a", \
     in using (tail("hot", "1000", "rays")):"share_longer" with lines lw 2.4 lc rgb "#c0392b", \
     in using (tail("cold", "1000", "rays")):"share_longer" with lines lw 2.4 lc rgb "#1f5fa8", \
     in using (tail("live", "1000", "rays")):"share_longer" with lines lw 2.4 lc rgb "#d98a00", \
     in using (tail("live early", "1000", "rays")):"share_longer" with lines lw 2.4 lc rgb "#2e7d4f"
