#!/bin/sh
# A simulation on all cores of this machine: GNU parallel, or xargs -P where it is absent.
#   sh parallel.sh STUDY N DIR [WORKERS]
# STUDY: a study file; N participants at every point of its grid; the rows come to DIR/taps.csv. Ended before its
# time, the same command goes on. ETHD_STUDY names the program, if it isn't in the path.
set -eu
[ $# -ge 3 ] || { sed -n '3,5s/^# *//p' "$0" >&2; exit 2; }
study=$1 participants=$2 out=$3 workers=${4:-$(nproc)}
program=${ETHD_STUDY:-ethd-study}

if parallel --version 2>/dev/null | grep -q GNU; then
  seq "$workers" | parallel --will-cite --halt now,fail=1 -j "$workers" \
    "$program" "$study" --simulate "$participants" --shard "{}/$workers" --out "$out"
else
  seq "$workers" | xargs -P "$workers" -I{} \
    "$program" "$study" --simulate "$participants" --shard "{}/$workers" --out "$out"
fi
"$program" --merge "$out"
