#!/bin/sh
# Bounded proofs by CBMC (Debian 13 has it): for every input within the bounds that each of tests/proofs/*.c says. Each
# proof fails where the code is broken as `seed` below breaks it.
set -u
command -v cbmc >/dev/null || { echo 'SKIP: cbmc isn'\''t there (Debian 13 has it)'; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0

# prove NAME UNWIND
prove() {
  start=$(date +%s)
  timeout "${ETHD_PROOF_TIME:-250}" cbmc "$work/tree/tests/proofs/$1.c" --unwind "$2" --unwinding-assertions --bounds-check --pointer-check \
    --signed-overflow-check --undefined-shift-check --div-by-zero-check --pointer-overflow-check \
    -D_GNU_SOURCE -I "$work/tree/include" -I "$work/tree/lib" -I "$work/tree/drivers" >"$work/out" 2>&1
  code=$?
  properties=$(sed -n 's/^\*\* \([0-9]* of [0-9]*\) failed.*/\1/p' "$work/out")
  echo "$1: exit $code, ${properties:-no result} failed, $(($(date +%s) - start)) s"
}

rm -rf "$work/tree"
mkdir "$work/tree" && cp -r include lib drivers "$work/tree" && mkdir "$work/tree/tests" && cp -r tests/proofs "$work/tree/tests"
cp -r "$work/tree" "$work/sound"

# one NAME UNWIND FILE SED: holds, and doesn't with the change
one() {
  prove "$1" "$2"
  [ $code = 0 ] || { failed=1; grep -E 'FAILURE|rror' "$work/out" | head -n 20; }
  sed -i "$4" "$work/tree/$3"
  cmp -s "$work/tree/$3" "$work/sound/$3" && { echo "FAILED $1: the seed changes nothing"; failed=1; }
  prove "$1" "$2"
  [ $code = 10 ] && echo "$1: the seeded bug is found" || { echo "FAILED $1: the seeded bug isn't found"; failed=1; }
  cp "$work/sound/$3" "$work/tree/$3"
}

one guard 34 lib/guard/guard.c 's/return bits | ETHD_GUARD_RATE | limit(heat.*/return bits | ETHD_GUARD_RATE;/; /^         limit(limits->torque, ETHD_GUARD_TORQUE, torque);/d'
one words 3 drivers/servo/words.c 's/raw = raw == raw ? fmin(fmax(raw, min), max) : 0;/;/'
one decoder 48 drivers/proximity_ring/decoder.c 's/while (at < CODED)/while (at <= CODED)/'
one npy_count 34 drivers/record/npy.c 's/end - p < 6/end - p < 0/'
one params 20 lib/param.c 's/if (!ethd__is_line(row->unit, ETHD_BRIEF_MAX).*/if (!row->brief) return false;/'
exit $failed
