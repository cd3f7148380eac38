#!/bin/sh
# Every stress test with fewer points.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
stress=$BUILD/tests/stress
mkdir "$folder/data"
fail() { echo "$*"; exit 1; }

"$stress" all --quick --csv "$folder/results.csv" --out "$folder/data" >"$folder/out" || {
  grep -e FAILED -e '^[a-z]*:' "$folder/out"
  fail "a figure is off its formula"
}
[ "$(head -n 1 "$folder/results.csv")" = test,what,measured,relation,analytic,unit,allowed,pass ] || fail "the header"
awk -F, 'NR > 1 && $NF != 1' "$folder/results.csv" | grep . && fail "a row failed, the program didn't"
[ "$(cut -d, -f1 "$folder/results.csv" | sort -u | wc -l)" = $(($("$stress" --list | wc -l) + 1)) ] ||
  fail "not every test has results"
for name in boundary hold map map_curve; do
  [ "$(wc -l <"$folder/data/$name.csv")" -gt 50 ] || fail "no $name.csv"
done

code=0
"$stress" no-such-test >"$folder/out" 2>"$folder/err" || code=$?
[ $code = 2 ] && [ "$(wc -l <"$folder/err")" = 1 ] || fail "an unknown test: exit $code: $(cat "$folder/err")"
