#!/bin/sh
# The figures and pictures of `predictive`: felt offset against speed with the reactive bound, and what wrong facts and
# sensors do. Everything is simulated.
#   apps/ahead.sh [FOLDER [TAPS [SEED]]]      build/ahead, 200 taps a point, seed 20140101
set -eu
export LC_ALL=C # awk's numbers have a point
bin=${BUILD:-build}/bin
share=$bin/../share/ethd
folder=${1:-build/ahead} taps=${2:-200} seed=${3:-20140101}
mkdir -p "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Mean of a column over the valid taps of a law at a speed, mm.
mean() { # CSV LAW SPEED [COLUMN], default: eps_felt_m
  awk -F, -v law="$2" -v speed="$3" -v name="${4:-eps_felt_m}" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i }
    $2 == law && $3 == speed && $5 == 1 && $c != "" { s += $c; n++ }
    END { if (n) printf "%.4f", 1e3 * s / n }' "$1"
}

tap() { # CSV ARGUMENTS
  csv=$1
  shift
  "$bin/ethd-tap" --taps "$taps" --seed "$seed" --validity finger --csv "$csv" "$@" >/dev/null
}

speeds=0.1,0.15,0.2,0.25,0.3,0.35,0.4,0.45,0.5,0.6,0.7
for plant in n p; do
  tap "$work/taps.csv" --plant $plant --speed $speeds
  echo speed_mps,abrupt_mm,smooth_mm,offset_mm,predictive_mm,abrupt_rebound_mm,smooth_rebound_mm,offset_rebound_mm,predictive_rebound_mm \
    >"$folder/felt-$plant.csv"
  for speed in $(echo $speeds | tr , ' '); do
    line=$speed
    for column in eps_felt_m d_max_m; do
      for law in abrupt smooth offset predictive; do line="$line,$(mean "$work/taps.csv" $law "$speed" $column)"; done
    done
    echo "$line" >>"$folder/felt-$plant.csv"
  done
done

# The law is told wrong facts, off by a factor; the device itself is as it was.
off() { # WHAT VALUE [ARGUMENTS]
  what=$1 value=$2
  shift 2
  line=$what,$value
  for learn in 0 10; do
    tap "$work/taps.csv" --speed 0.2,0.4 --transition predictive --learn $learn --set transition.learn=0.3 "$@"
    line="$line,$(mean "$work/taps.csv" predictive 0.2),$(mean "$work/taps.csv" predictive 0.4)"
  done
  echo "$line" >>"$folder/off.csv"
}

# A plant with one line changed, beside its controller.
changed() { # KEY VALUE
  sed "s/^$1 = .*/$1 = $2/" "$share/n.plant" >"$work/changed.plant"
  cp "$share/n.ini" "$work/changed.ini"
  cp "$share/wall.scene" "$work"
}

: >"$folder/off.csv"
factors='0.7 0.85 1 1.15 1.3'
for k in $factors; do off mass $k --set arm.mass_x="$(awk "BEGIN { print 0.1173 * $k }")"; done
for k in $factors; do off friction $k --set arm.friction="$(awk "BEGIN { print 0.398 * $k }")"; done
for ms in 0 0.071 0.25 0.5 0.75 0.95; do
  changed delay ${ms}e-3
  off delay $ms --plant "$work/changed.plant" --set arm.delay=0.071e-3
done
for mm in 0 0.05 0.1 0.2 0.3; do
  changed noise ${mm}e-3
  off noise $mm --plant "$work/changed.plant"
done

# The typical tap of each law, as the paper's figures 11 and 12.
"$bin/ethd-tap" --taps "$taps" --seed "$seed" --validity finger --force --trace "$folder/traces" >/dev/null

command -v gnuplot >/dev/null || { echo "no gnuplot: no pictures; the tables are in $folder"; exit 0; }
plots=$share/plot
gnuplot -e "in='$folder/felt-n.csv'; out='$folder/felt-n.png'; plant='n'; a=49; gap=0.00311" "$plots/ahead.gp"
gnuplot -e "in='$folder/felt-p.csv'; out='$folder/felt-p.png'; plant='p'; a=29.7; gap=0.00549" "$plots/ahead.gp"
gnuplot -e "in='$folder/off.csv'; out='$folder/off.png'" "$plots/ahead-sensitivity.gp"
for speed in low high; do
  gnuplot -e "in='$folder/traces'; speed='$speed'; out='$folder/taps-$speed.png'" "$plots/taps.gp"
done
echo "$folder"
