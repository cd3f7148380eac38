#!/bin/sh
# Bounded proofs by CBMC (Debian 13 has it), for every input within the bounds that each of tests/proofs/*.c states. Each
# proof fails once its seed below breaks the code. ETHD_PROOFS=all: the guard too, which takes minutes.
. tests/begin.sh
command -v cbmc >/dev/null || { echo 'SKIP: cbmc isn'\''t there (Debian 13 has it)'; exit 77; }

# prove NAME UNWIND CHECKS...
prove() {
  start=$(date +%s) name=$1 unwind=$2
  shift 2
  timeout "${ETHD_PROOF_TIME:-900}" cbmc "$folder/tree/tests/proofs/$name.c" --unwind "$unwind" --unwinding-assertions \
    --slice-formula "$@" -D_GNU_SOURCE -I "$folder/tree/include" -I "$folder/tree/lib" -I "$folder/tree/drivers" -I "$folder/tree/drivers/runtime" >"$folder/out" 2>&1
  code=$?
  echo "$name: exit $code, $(sed -n 's/^\*\* \([0-9]* of [0-9]*\) failed.*/\1 failed/p' "$folder/out"), $(($(date +%s) - start)) s"
}
memory='--bounds-check --pointer-check --signed-overflow-check --undefined-shift-check --div-by-zero-check --pointer-overflow-check'

rm -rf "$folder/tree"
mkdir "$folder/tree" && cp -r include lib drivers "$folder/tree" && mkdir "$folder/tree/tests" && cp -r tests/proofs "$folder/tree/tests"
cp -r "$folder/tree" "$folder/sound"

# one NAME UNWIND FILE SED CHECKS...: holds, and doesn't with the change
one() {
  name=$1 unwind=$2 file=$3 seed=$4
  shift 4
  prove "$name" "$unwind" "$@"
  [ $code = 0 ] || { failed=1; grep -E 'FAILURE|rror' "$folder/out" | head -n 20; }
  sed -i "$seed" "$folder/tree/$file"
  cmp -s "$folder/tree/$file" "$folder/sound/$file" && { echo "FAILED $name: the seed changes nothing"; failed=1; }
  prove "$name" "$unwind" "$@"
  if [ $code = 10 ]; then echo "$name: the seeded bug is found"; else echo "FAILED $name: the seeded bug isn't found"; failed=1; fi
  cp "$folder/sound/$file" "$folder/tree/$file"
}

one words 3 drivers/servo/words.c 's/raw = raw == raw ? fmin(fmax(raw, min), max) : 0;/;/' $memory
one npy_count 34 drivers/runtime/record/npy_header.c 's/if (!digits || end - p < 6 || /if (!digits || /' $memory
one decoder 48 drivers/proximity_ring/decoder.c 's/while (at < CODED)/while (at <= CODED)/' $memory
one param 40 lib/param.c 's/inside = isgreaterequal(v, row->min)/inside = !(v < row->min)/' $memory
# minutes
[ "${ETHD_PROOFS:-}" != all ] || one guard 34 lib/guard/guard.c '/bits |= ETHD_GUARD_RATE;/{n;d}' \
  --no-standard-checks --sat-solver cadical
exit $failed
