#!/bin/sh
# What the benchmarks say of errors, which no machine's speed changes, and that each CSV is enough for its picture.
set -eu
[ -z "${SAN:-}" ] || { echo "SKIP: benchmarks are measured without sanitizers"; exit 77; }
. tests/begin.sh
bench=$BUILD/tests/bench
fail() { echo "$*"; exit 1; }

# A table that can't be written whole says so and isn't there.
mkdir "$folder/full"
said=$( (ulimit -f 1; "$bench" estimators --quick --out "$folder/full" 2>&1 >/dev/null || echo "code $?") | cat)
[ "$said" = "bench: $folder/full/fits.csv: File too large
code 1" ] || fail "a table that is cut off: $said"
[ -z "$(ls "$folder/full")" ] || fail "it left $(ls "$folder/full")"

for what in estimators kinematics; do
  "$bench" $what --quick --out "$folder" --about "a test" >"$folder/$what.txt" || fail "$what failed"
done
for what in fits filters velocity kinematics; do
  head -n 1 "$folder/$what.csv" | grep -q '^# libethd .*compiler' || fail "$what.csv doesn't say what measured it"
  grep -q '^# a test$' "$folder/$what.csv" || fail "$what.csv doesn't hold what --about says"
  grep -v '^#' "$folder/$what.csv" | awk -F, 'NR == 1 { n = NF } NF != n { exit 1 } END { exit NR < 4 }' ||
    fail "$what.csv isn't a table"
  command -v gnuplot >/dev/null || continue
  gnuplot -e "in='$folder/$what.csv'; out='$folder/$what.png'" tests/picture.gp tests/bench/race.gp 2>"$folder/said" || fail "$what: $(cat "$folder/said")"
  [ "$(wc -c <"$folder/$what.png")" -gt 5000 ] || fail "$what.png is empty"
done

grep -h 'goal:.*\(the bound\|mm \|ca at least\|ca under cv\)' "$folder"/*.txt >"$folder/goals"
[ "$(wc -l <"$folder/goals")" = 10 ] || { cat "$folder/goals"; fail "ten goals are of errors"; }
if grep -v ', met$' "$folder/goals"; then fail "an error is larger than it may be"; fi
echo "ten errors within their goals"
