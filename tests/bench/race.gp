# Run time against error: a panel for each word of the first column, a line through the settings of each method.
set terminal pngcairo size 1500,900 font "Sans,14"
set output out
array panels[12]
array methods[16]
array tints[16] = [0xc0392b, 0xe59866, 0x1f5fa8, 0x7fb0e0, 0x2e8b57, 0x8fcfa8, 0x7d3c98, 0xb7950b, 0x117a8b, 0x707070, \
  0xcfcfcf, 0x303030, 0xd98a00, 0x8e44ad, 0x2e7d4f, 0xa8a8a8]
p = 0
m = 0
panel(s) = p == 0 ? 0 : sum [k = 1:p] (panels[k] eq s)
method(s) = m == 0 ? 0 : sum [k = 1:m] (methods[k] eq s)
stats in using (panel(strcol(1)) ? 0 : (p = p + 1, panels[p] = strcol(1)), 0) nooutput
stats in using (method(strcol(2)) ? 0 : (m = m + 1, methods[m] = strcol(2)), 0) nooutput

set logscale xy
set format "10^{%T}"
set xlabel "run time, ns"
set ylabel "error"
set key top right samplen 1 noenhanced font "Sans,11"
if (p == 1) { set key tmargin center horizontal }
rows = p > 3 ? 2 : 1
set multiplot layout rows,(p + rows - 1)/rows
do for [k = 1:p] {
  set title panels[k] noenhanced
  plot for [i = 1:m] in using (strcol(1) eq panels[k] && strcol(2) eq methods[i] ? $3 : NaN):4 with linespoints pt 7 \
    ps (i == 1 ? 1.6 : 1.1) lw (i == 1 ? 3 : 1.5) lc rgb tints[i] title methods[i]
  unset key
}
unset multiplot
