#!/bin/sh
# The models of what threads and processes share, checked exhaustively by Spin: each holds, and each with its seeded
# bug doesn't. Every line of the sources that a model names must still stand there. ETHD_MODELS=large: larger ones.
. tests/begin.sh
command -v spin >/dev/null || { echo 'SKIP: spin isn'\''t there'; exit 77; }
models=$(pwd)/tests/models

# names MODEL: the lines of the sources that it models
names() {
  grep '^   = ' "$models/$1.pml" | sed 's/^   = //' >"$folder/lines"
  [ -s "$folder/lines" ] || fail "$1: it names no line"
  while IFS= read -r line; do
    grep -qF -- "${line#*: }" "${line%%: *}" || fail "$1: no longer in ${line%%: *}: ${line#*: }"
  done <"$folder/lines"
}

# run MODEL FLAG...: prints errors and states; what fails to run has no errors at all
run() {
  model=$1
  shift
  (
    cd "$folder" && spin -a "$@" "$models/$model.pml" >spin.out 2>&1 && cc -O0 -w -DVECTORSZ=2048 -o pan pan.c &&
      ./pan -noclaim -m5000000 >safe.out 2>&1
    : >live.out
    if grep -q '^ltl' "$models/$model.pml"; then ./pan -a -f -m5000000 >live.out 2>&1; fi
    cat safe.out live.out
  ) >"$folder/out" 2>&1
  if grep -q 'max search depth too small\|out of memory\|hash' "$folder/out" && grep -q 'truncated\|too small' "$folder/out"; then echo "incomplete 0"; return; fi
  awk '/errors: / { seen = 1; errors += $NF } /states, stored/ { states += $1 } END { print seen ? errors + 0 : "none", states + 0 }' "$folder/out"
}

# holds MODEL FLAG...
holds() {
  set -- "$@"
  found=$(run "$@")
  [ "${found% *}" = 0 ] || { fail "$*: ${found% *} errors"; grep -h '^pan:\|rror' "$folder/out"; }
  echo "$*: holds in all of its ${found#* } states"
}

# breaks MODEL FLAG...: the seeded bug is found
breaks() {
  found=$(run "$@")
  case ${found% *} in 0 | none | incomplete) fail "$*: not found" ;; *) echo "$*: found" ;; esac
}

for model in post ring cell loop hang servo; do
  names $model
  holds $model
  breaks $model -DBUG
done
breaks post -DEAGER
holds servo -DQUIET
breaks servo -DQUIET -DBUG
if [ "${ETHD_MODELS:-}" = large ]; then
  holds post -DPOSTS=12
  holds ring -DSIZE=4 -DCOUNT=40
  holds cell -DPUTS=60
  holds loop -DENABLES=60
  holds hang -DTURNS=60
  holds servo -DQUESTIONS=30
  holds servo -DQUIET -DQUESTIONS=30
fi
exit $failed
