#!/bin/sh
# Mutation: sh tests/mutation.sh FILE TEST...: changes one small thing of a source after the other, and prints the changes that
# none of these tests detects. It works in a copy of the last commit, $BUILD/mutation; run again, it continues.
#   make mutation FILE=lib/guard/heat.c TESTS='test_guard_limits golden'
# universalmutator, from PyPI, makes the changes and runs the tests. A change that doesn't compile, or not to another object, isn't
# tried.
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 1 ] || { echo "mutation: FILE and TESTS are needed: make mutation FILE=lib/guard/heat.c TESTS='test_guard_limits golden'"; exit 2; }
BUILD=${BUILD:-build} file=$1
export BUILD
shift
venv=$(sh .ci/venv mutation universalmutator==1.14.1) || { echo "SKIP: universalmutator can't be had"; exit 77; }
copy=$BUILD/mutation mutants=mutants/$(git rev-parse "HEAD:$file") object=build/obj/${file%.c}.o
[ -d "$copy/.git" ] || git clone -q --shared . "$copy"
git -C "$copy" checkout -q --force --detach "$(git rev-parse HEAD)"
cd "$copy"
unset BUILD
make="${MAKE:-make} --no-print-directory SETUP=no SAN="
$make TESTS="$*" check >log 2>&1 || { tail -n 20 log; exit 1; }
if [ ! -d "$mutants" ]; then
  mkdir -p "$mutants.new"
  cp "$object" original.o
  "$venv/bin/mutate" "$file" c --mutantDir "$mutants.new" --cmd "$make $object && ! cmp -s $object original.o" >log
  mv "$mutants.new" "$mutants"
fi
nice -n 15 "$venv/bin/analyze_mutants" "$file" "$make TESTS='$*' check" --mutantDir "$mutants" --prefix "$mutants/of" --resume \
  --seed 13 --timeout 300 >log
while read -r mutant; do diff -U 0 --label "$file" --label "$mutant" "$file" "$mutants/$mutant" || :; done <"$mutants/of.notkilled.txt"
echo "$(wc -l <"$mutants/of.killed.txt") changes detected, $(wc -l <"$mutants/of.notkilled.txt") not"
