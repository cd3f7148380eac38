#!/bin/sh
# ethd-study --simulate: 1, 2 and 4 workers, GNU parallel, mpirun and a worker that was killed: equal bytes.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
study=$BUILD/bin/ethd-study
export ETHD_STUDY="$study"
failed=0
fail() { echo "FAILED $*"; failed=1; }

cat >"$folder/grid.study" <<'END'
[study]
training = 1
taps = 1
attempts = 6
[grid]
contact.k_e = 1000,2500
transition.b_d = 50,100
END
people=7
simulate() { "$study" "$folder/grid.study" --simulate $people "$@"; }

simulate --out "$folder/one" >"$folder/out" 2>&1 && "$study" --merge "$folder/one" >>"$folder/out" 2>&1 || fail "one worker: $(cat "$folder/out")"
same() { cmp "$folder/one/taps.csv" "$folder/$1/taps.csv" || fail "$1 has other bytes than one worker"; }
[ "$(cut -d, -f2,3 "$folder/one/taps.csv" | sort -u | wc -l)" = $((4 * people + 1)) ] || fail "not $people people at 4 points"
head -n 1 "$folder/one/taps.csv" | grep -q '^study,point,participant,.*,commanded_mps,.*,utc,by_ring,by_finger,contact.k_e,transition.b_d$' || fail "the header"

# Each row's gains are those that it names; a strategy without such a gain has none.
[ "$(awk -F, '$2 == 0 || $2 == 1 { print $3, $4, $6, $7, $8, $13 }' "$folder/one/taps.csv" | grep smooth | sort | uniq -c | awk '$1 != 2' | wc -l)" = 0 ] ||
  fail "b_d changes what smooth does"
[ "$(awk -F, '$2 == 0 || $2 == 2 { print $3, $4, $6, $7, $8, $22 }' "$folder/one/taps.csv" | grep smooth | sort | uniq -c | awk '$1 != 2' | wc -l)" != 0 ] ||
  fail "k_e changes nothing"

for workers in 2 4; do
  sh apps/cluster/parallel.sh "$folder/grid.study" $people "$folder/w$workers" $workers >"$folder/out" 2>&1 || fail "$workers workers: $(cat "$folder/out")"
  same w$workers
done
for i in 1 2 3; do # as Slurm's array does
  SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=1 sh apps/cluster/slurm.sh "$folder/grid.study" $people "$folder/slurm" >"$folder/out" 2>&1 ||
    fail "array job $i: $(cat "$folder/out")"
done
"$study" --merge "$folder/slurm" >/dev/null || fail "merging an array's shards"
same slurm

# Killed, cut in a line, gone on.
for i in 1 2 3 4 5; do
  "$study" "$folder/grid.study" --simulate $people --shard 1/2 --out "$folder/killed" >/dev/null 2>&1 &
  pid=$!
  sleep 0.0$i
  kill -KILL $pid 2>/dev/null
  wait $pid 2>/dev/null
done
simulate --shard 1/2 --out "$folder/killed" >/dev/null || fail "a killed shard"
simulate --shard 2/2 --out "$folder/killed" >/dev/null || fail "the other shard"
"$study" --merge "$folder/killed" >/dev/null || fail "merging a killed shard"
same killed
for bytes in 3 250 1000 5000 9999 20000; do
  rm -f "$folder/killed/shard-1-of-2.csv"
  head -c $bytes "$folder/one/shard-1-of-1.csv" >"$folder/cut"
  mkdir -p "$folder/torn"
  cp "$folder/cut" "$folder/torn/shard-1-of-1.part"
  simulate --out "$folder/torn" >"$folder/out" 2>&1 && "$study" --merge "$folder/torn" >/dev/null || fail "torn at $bytes: $(cat "$folder/out")"
  same torn
  rm -r "$folder/torn"
done

# Every tick, if asked.
simulate --ticks --shard 7/7 --out "$folder/ticks" >/dev/null || fail "--ticks"
tap=$(ls "$folder/ticks/taps-7-of-7" | tail -n 1)
"$BUILD/bin/ethd-replay" --verify "$folder/ticks/taps-7-of-7/$tap" >"$folder/out" 2>&1 || fail "$tap: $(cat "$folder/out")"

refuse() { # PATTERN COMMAND...
  pattern=$1
  shift
  "$@" >"$folder/out" 2>"$folder/err" </dev/null
  code=$?
  [ $code != 0 ] && [ "$(wc -l <"$folder/err")" -le 2 ] && grep -q -e "$pattern" "$folder/err" || fail "$pattern: exit $code: $(cat "$folder/err")"
}
refuse 'killed/shard-1-of-2.csv: missing' "$study" --merge "$folder/killed"
refuse 'shards of ' sh -c "cp '$folder/one/shard-1-of-1.csv' '$folder/killed' && '$study' --merge '$folder/killed'"
rm "$folder/ticks/shard-7-of-7.csv"
refuse 'no shard-i-of-n.csv' "$study" --merge "$folder/ticks"
rm "$folder"/slurm/shard-2-of-3.csv && cp "$folder"/slurm/shard-1-of-3.csv "$folder"/slurm/shard-2-of-3.csv
refuse "don't fit together\|no rows that begin with" "$study" --merge "$folder/slurm"
printf '[study]\nseed = 2\n' >"$folder/other.study"
head -c 5000 "$folder/one/shard-1-of-1.csv" >"$folder/one/shard-1-of-3.part"
refuse 'of another study' "$study" "$folder/other.study" --simulate 3 --shard 1/3 --out "$folder/one"
refuse 'shard: found "3"' simulate --shard 3/2 --out "$folder/x"
refuse 'shard: found "2"' simulate --shard 2 --out "$folder/x"
refuse 'need --simulate' "$study" --shard 1/2 --out "$folder/x"

# ---- mpirun last: it may be absent ----
if command -v mpirun >/dev/null; then
  sh apps/cluster/mpi.sh "$folder/grid.study" $people "$folder/mpi" -np 2 --oversubscribe >"$folder/out" 2>&1 || fail "mpirun: $(cat "$folder/out")"
  same mpi
fi
[ $failed = 0 ] || exit 1
command -v mpirun >/dev/null || { echo "SKIP: mpirun (Debian: openmpi-bin); all else passed"; exit 77; }
command -v parallel >/dev/null || { echo "SKIP: GNU parallel; xargs and all else passed"; exit 77; }
echo "$(($(wc -l <"$folder/one/taps.csv") - 1)) taps, equal bytes from 1, 2, 3, 4 workers, mpirun and a killed one"
