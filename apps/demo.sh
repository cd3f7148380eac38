#!/bin/sh
# make demo: the tap study on the simulated device, its table beside the paper's, pictures, and the paper's own
# study with its report.
# TAPS and PLANT may be set: TAPS=1000 PLANT=b make demo
set -eu
here=$(cd "$(dirname "$0")" && pwd)
BUILD=${BUILD:-build} TAPS=${TAPS:-400} PLANT=${PLANT:-q}
out=$BUILD/demo
mkdir -p "$out/traces"

"$BUILD/bin/ethd-tap" --plant "$PLANT" --taps "$TAPS" --csv "$out/taps.csv" --trace "$out/traces" --force >"$out/table.txt"
cat "$out/table.txt"
echo

# None of the words that gnuplot gets is a path, because a quote in one would end its string.
plant=$(basename "$PLANT" .plant | tr -cd '[:alnum:]_.-')
plot() { (cd "$out" && gnuplot -e "$1" "$here/plot/$2"); }
for speed in low high; do
  for law in abrupt smooth offset predictive; do
    plot "in='traces/$law-$speed.csv'; out='$law-$speed.png'; title='$law, $speed speed'; plant='$plant'" tap.gp
  done
  plot "in='traces'; speed='$speed'; out='beside-$speed.png'; plant='$plant'" taps.gp
done

# An arm in space, and what its taps depend on.
"$BUILD/bin/ethd-tap" --arm ur5e --taps 40 --transition smooth,approach --trace "$out/arm" --force --plot "$out/sensitivity.png" >"$out/arm.txt"
cat "$out/arm.txt"
plot "in='arm/approach-0.4.csv'; out='arm.png'" arm.gp

# The paper's study as it was done, with three people; and a crowd of 400 beside it.
rm -rf "$out/study" "$out/crowd"
"$BUILD/bin/ethd-study" --quiet --out "$out/study" >/dev/null
"$BUILD/bin/ethd-study" "$BUILD/share/ethd/crowd.study" --simulate 400 --out "$out/crowd" >/dev/null
"$BUILD/bin/ethd-study" --merge "$out/crowd" >/dev/null
"$BUILD/bin/ethd-report" "$out/study" --beside "$out/crowd" >/dev/null

echo "pictures, in the manner of the paper's figures:"
echo "  $out/smooth-low.png, offset-low.png, smooth-high.png, offset-high.png: figures 9 to 12, and abrupt-, predictive-"
echo "  $out/beside-low.png, beside-high.png: smooth, offset and predictive beside each other"
echo "  $out/arm.png, sensitivity.png: a plate on a simulated UR5e, and early touches against delay, gap and bias"
echo "  $out/study/report/boxes.png, beside-boxes.png: figures 14 to 17, of 3 people and of 400; encounter.png: figure 6"
echo "and the figures behind them: $out/taps.csv, $out/traces/"
echo
echo "the paper's study, 3 simulated people, 3 valid taps in each of 4 cells, every tick of it: $out/study"
echo "its report, to be opened in a browser: $out/study/report/report.html"
