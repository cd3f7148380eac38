#!/bin/sh
# The same seed gives the same bytes: on every compiler, at -O0 and -O2, and whatever variants libm picks.
# `tests/golden.sh renew` writes the hashes anew: after a change that is meant to change numbers. `tests/golden.sh once`
# leaves the variants of libm out.
set -eu
bin=${BUILD:-build}/bin
. tests/begin.sh

# A finger that shakes within the ring, a frame every 3 ticks, a ray lost now and then: sums, products and
# quotients only, which every awk works out alike.
frames() {
  awk 'BEGIN {
    printf "t_s,q1_rad,q2_rad,t_ring_s"; for (k = 0; k < 16; k++) printf ",r%d_m", k; print ""
    for (i = 0; i < 600; i++) {
      s = (i % 120 - 60) / 60; wave = s * (1 - (s < 0 ? -s : s))
      printf "%.17g,%.17g,%.17g", i / 1000, 1.6 + wave / 5, -0.03 + wave / 9
      if (i % 3) { printf ","; for (k = 0; k < 16; k++) printf ","; print ""; continue }
      printf ",%.17g", i / 1000 - 0.002
      for (k = 0; k < 16; k++)
        if ((i + 7 * k) % 41 == 0) printf ",nan"
        else printf ",%.17g", 0.0045 + 0.002 * wave * (k < 8 ? 1 : -1) * (8 - (k % 8)) / 8 + ((i * 7 + k * 13) % 17 - 8) / 1e5
      print ""
    }
  }'
}

# Every velocity, fit and filter in turn, with every transition.
replays() { # FOLDER
  set -- "$1" kasa vertex-mean centroid robust
  for velocity in lowpass difference lsq foaw kalman; do
    for filter in ca hold alpha-beta cv; do
      law=$(echo "abrupt smooth offset" | cut -d' ' -f$((${#velocity} % 3 + 1)))
      printf '[velocity]\nmethod = %s\n[finger_fit]\nmethod = %s\n[finger_filter]\nmethod = %s\n[transition]\nlaw = %s\n[scene]\nfile = %s\n' \
        $velocity "$2" $filter $law "$bin/../share/ethd/room.scene" >"$folder/replay.ini"
      "$bin/ethd-replay" --config "$folder/replay.ini" --in "$folder/frames.csv" --out "$1/$velocity-$filter-$2.csv" >/dev/null
      first=$1 fit=$2
      shift 2
      set -- "$first" "$@" "$fit"
    done
  done
}

# Columns added later (finger_noise, learnt, commanded, age) are removed before hashing, so that older hashes stay valid.
without() { # FILE COLUMN...
  "${PYTHON:-python3}" - "$@" <<'END'
import ast, sys
path, *columns = sys.argv[1:]
raw = open(path, "rb").read()
data = 10 + int.from_bytes(raw[8:10], "little")
header = ast.literal_eval(raw[10:data].decode())
spans, kept, at = [], [], 0
for field in header["descr"]:
    size = 8 * (field[2][0] if len(field) > 2 else 1)
    if field[0] not in columns:
        spans.append((at, at + size))
        kept.append(field)
    at += size
text = f"{{'descr': {kept}, 'fortran_order': False, 'shape': ("
total = (10 + len(text) + 20 + len(",), }\n") + 63) // 64 * 64
text = (text + f"{header['shape'][0]},), }}").ljust(total - 11) + "\n"
rows = (raw[i + a:i + b] for i in range(data, data + at * header["shape"][0], at) for a, b in spans)
open(path, "wb").write(raw[:8] + (total - 10).to_bytes(2, "little") + text.encode() + b"".join(rows))
END
}

run() { # FOLDER: every plant, law and speed; the paper's laws in the columns that they had without the other
  mkdir "$1"
  for plant in q n b p; do
    "$bin/ethd-tap" --plant $plant --taps 3 --seed 7 --transition abrupt,smooth,offset --csv "$1/$plant.csv" \
      --record "$1/$plant" >/dev/null
    for table in "$1/$plant.csv" "$1/$plant/taps.csv"; do
      cut -d, -f1-15 "$table" >"$folder/cut"
      mv "$folder/cut" "$table"
    done
    "$bin/ethd-tap" --plant $plant --taps 3 --seed 7 --transition offset,predictive --learn 2 \
      --set transition.learn=0.3 --validity finger --csv "$1/$plant-predictive.csv" \
      --record "$1/$plant-predictive" >/dev/null
    rm "$1/$plant/config.ini" "$1/$plant-predictive/config.ini" # name this machine's folders
    without "$1/$plant/tick.npy" learnt finger_noise commanded age
    without "$1/$plant-predictive/tick.npy" finger_noise commanded age
  done
  replays "$1"
  (cd "$1" && find . -type f | LC_ALL=C sort | xargs sha256sum)
}

frames >"$folder/frames.csv"
run "$folder/plain" >"$folder/plain.sums"
if [ "${1:-}" = renew ]; then
  cp "$folder/plain.sums" tests/golden.sums
  echo "tests/golden.sums is new"
  exit 0
fi
masks='-FMA,-AVX2_Usable,-FMA_Usable -FMA,-AVX2,-AVX512F,-FMA4,-AVX -SSE4_1,-FMA,-AVX2,-ERMS'
[ "${1:-}" = once ] && masks=
for mask in $masks; do
  GLIBC_TUNABLES=glibc.cpu.hwcaps=$mask run "$folder/masked" >"$folder/masked.sums"
  cmp "$folder/plain.sums" "$folder/masked.sums" || { echo "the bytes change with GLIBC_TUNABLES $mask"; exit 1; }
  rm -r "$folder/masked"
done
diff tests/golden.sums "$folder/plain.sums" || {
  echo "the bytes differ from tests/golden.sums; if numbers were meant to change: tests/golden.sh renew"
  exit 1
}
echo "$(wc -l <tests/golden.sums) files have their golden bytes${masks:+, under 3 masks of processor features}"
