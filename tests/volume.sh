#!/bin/sh
# Volume: sh tests/volume.sh [INPUTS [MINUTES]]: INPUTS (1e9) inputs over all readers of strangers' bytes, in equal shares,
# for MINUTES at most; run again, it goes on where it was. One line a reader; what is left is said in hours. The state,
# $BUILD/volume/READER (or in VOLUME_STATE), holds the next input, how many were taken, and the seconds so far. SAN=address,undefined looks closer.
set -u
BUILD=${BUILD:-build} inputs=${1:-1000000000} minutes=${2:-1000000}
state=${VOLUME_STATE:-$BUILD/volume}
mkdir -p "$state" || exit 1
inputs=$(awk -v n="$inputs" 'BEGIN { printf "%.0f", n }')
readers=$("$BUILD/tests/volume") || { echo "volume: build it: make $BUILD/tests/volume"; exit 1; }
share=$((inputs / $(echo "$readers" | wc -l)))
end=$(awk -v now="$(date +%s)" -v m="$minutes" 'BEGIN { printf "%.0f", now + 60 * m }')

# slice READER COUNT: runs COUNT more inputs of a reader, then replaces its state
slice() {
  next=0 taken=0 spent=0
  [ ! -f "$state/$1" ] || read -r next taken spent <"$state/$1"
  todo=$((share - next))
  [ "$todo" -gt 0 ] || return 0
  [ "$todo" -lt "$2" ] || todo=$2
  got=$("$BUILD/tests/volume" "$1" "$next" "$todo" "$((end - $(date +%s)))") || exit 1
  echo "$got $taken $spent" | awk '{ printf "%d %d %.1f\n", $1, $2 + $4, $3 + $5 }' >"$state/$1.new" && mv "$state/$1.new" "$state/$1"
}

left=1
while [ "$left" = 1 ] && [ "$(date +%s)" -lt "$end" ]; do
  left=0
  for reader in $readers; do
    [ "$(date +%s)" -lt "$end" ] || break
    slice "$reader" 5000000
    [ "$next" -ge "$share" ] || left=1
  done
done

for reader in $readers; do [ ! -f "$state/$reader" ] || sed "s/^/$reader $share /" "$state/$reader"; done |
  awk '{ printf "%-7s %d of %d inputs, %d taken, %.0f s\n", $1, $3, $2, $4, $5; all += $2; done += $3; spent += $5; rest += ($2 - $3) * $5 / $3 }
    END { printf "volume: %d of %d inputs, none wrongly refused, %.2f h; %.2f h are left\n", done, all, spent / 3600, rest / 3600 }'
