#!/bin/sh
# ethd-study --simulate: 1, 2, 3, 4 and 7 workers, GNU parallel, mpirun and a worker that was killed: equal bytes.
. tests/begin.sh
study=$BUILD/bin/ethd-study
export ETHD_STUDY="$study"

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
head -n 1 "$folder/one/taps.csv" | grep -q '^study,point,participant,.*,commanded_mps,.*,utc,by_ring,by_finger,checked,contact.k_e,transition.b_d$' || fail "the header"

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

for workers in 3 7; do
  for i in $(seq $workers); do simulate --shard $i/$workers --out "$folder/s$workers" >"$folder/out" 2>&1 || fail "shard $i/$workers: $(cat "$folder/out")"; done
  "$study" --merge "$folder/s$workers" >/dev/null || fail "merging $workers shards"
  same s$workers
done
# A merged folder is a study: its tables come from its store, and again where they are lost.
rm "$folder/s7/taps.csv"
"$study" --export "$folder/s7" >"$folder/out" 2>&1 || fail "--export: $(cat "$folder/out")"
same s7
"$study" --verify "$folder/s7" >"$folder/out" 2>&1 || fail "sums: $(cat "$folder/out")"

# Killed and gone on: a unit's taps are there, all or none.
python3=${PYTHON:-python3}
for i in 1 2 3 4 5 6 7 8; do
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

# Every tick, if asked.
simulate --ticks --shard 7/7 --out "$folder/ticks" >/dev/null || fail "--ticks"
tap=$(ls "$folder/ticks/taps-7-of-7" | tail -n 1)
"$BUILD/bin/ethd-replay" --verify "$folder/ticks/taps-7-of-7/$tap" >"$folder/out" 2>&1 || fail "$tap: $(cat "$folder/out")"

try=yes
rm "$folder/killed/shard-1-of-2.sqlite"
refuse 1 'killed/shard-1-of-2.sqlite: missing' "$study" --merge "$folder/killed"
refuse 1 'shards of ' sh -c "cp '$folder/one/shard-1-of-1.sqlite' '$folder/killed' && '$study' --merge '$folder/killed'"
rm "$folder/ticks/shard-7-of-7.sqlite"
refuse 1 'no shard-i-of-n.sqlite' "$study" --merge "$folder/ticks"
cp "$folder/slurm/shard-1-of-3.sqlite" "$folder/first"
cp "$folder/first" "$folder/slurm/shard-2-of-3.sqlite"
refuse 1 'shard-2-of-3.sqlite: has rows of another shard' "$study" --merge "$folder/slurm"
cp "$folder/first" "$folder/slurm/shard-1-of-3.sqlite"
"$python3" -c 'import sqlite3, sys; db = sqlite3.connect(sys.argv[1]); db.execute("DELETE FROM tap WHERE point = 3 AND participant > 4"); db.commit()' "$folder/slurm/shard-1-of-3.sqlite"
refuse 1 'shard-1-of-3.sqlite: has [0-9]* of its 10 participants' "$study" --merge "$folder/slurm"
printf '[study]\nseed = 2\n' >"$folder/other.study"
"$study" "$folder/other.study" --simulate 3 --out "$folder/other" >"$folder/out" 2>&1 || fail "another study: $(cat "$folder/out")"
cp "$folder/other/shard-1-of-1.sqlite" "$folder/one/shard-1-of-3.sqlite"
refuse 1 'begun with other files' simulate --shard 1/3 --out "$folder/one"
refuse 2 'holds study.ini, of another study' "$study" "$folder/other.study" --simulate 3 --out "$folder/one"
refuse 2 'holds a simulation' "$study" --resume "$folder/one"
refuse 2 'holds a simulation' "$study" --resume "$folder/one" --exclude 1 --reason x
refuse 2 'shard: found "3"' simulate --shard 3/2 --out "$folder/x"
refuse 2 'shard: found "2"' simulate --shard 2 --out "$folder/x"
refuse 2 'need --simulate' "$study" --shard 1/2 --out "$folder/x"

# ---- mpirun last: it may be absent ----
if command -v mpirun >/dev/null; then
  sh apps/cluster/mpi.sh "$folder/grid.study" $people "$folder/mpi" -np 2 --oversubscribe >"$folder/out" 2>&1 || fail "mpirun: $(cat "$folder/out")"
  same mpi
fi
[ $failed = 0 ] || exit 1
command -v mpirun >/dev/null || { echo "SKIP: mpirun (Debian: openmpi-bin); all else passed"; exit 77; }
command -v parallel >/dev/null || { echo "SKIP: GNU parallel; xargs and all else passed"; exit 77; }
echo "$(($(wc -l <"$folder/one/taps.csv") - 1)) taps, equal bytes from 1, 2, 3, 4, 7 workers, mpirun and a killed one"
