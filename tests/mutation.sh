#!/bin/sh
# Mutation: sh tests/mutation.sh [COUNT [MINUTES]]: builds a tree of its own, then changes one small thing of lib or of the
# ring's decoder after the other and asks the unit tests, COUNT (2000) mutants or MINUTES long; run again, it goes on. With
# AGAIN=1 only the survivors, after tests were added. Results: $BUILD/mutation/results.jsonl, survivors.txt; a verdict holds
# until its source changes.
# Don't change the sources while it runs. Needs universalmutator from PyPI; skipped by name without.
set -u
cd "$(dirname "$0")/.." || exit 1
BUILD=${BUILD:-build}
export BUILD
venv=$(sh .ci/venv mutation universalmutator==1.14.1) || { echo 'SKIP: universalmutator can'\''t be had'; exit 77; }
# Nothing hidden, so that all of lib can be one shared library under the tests.
${MAKE:-make} --no-print-directory SETUP=no SAN= BUILD="$BUILD/mutation" PIC=-fPIC CFLAGS=-O1 tests >"$BUILD/mutation.log" 2>&1 ||
  { tail -n 20 "$BUILD/mutation.log"; exit 1; }
exec nice -n 15 "$venv/bin/python" tests/mutation.py --tree "$BUILD/mutation" --results "$BUILD/mutation/results.jsonl" \
  --count "${1:-2000}" --minutes "${2:-inf}" ${AGAIN:+--again}
