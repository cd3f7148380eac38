#!/bin/sh
# A simulation on all cores of this machine: GNU parallel, or xargs -P where it is absent.
#   sh parallel.sh STUDY N DIR [WORKERS]
# STUDY: a study file; N participants at every point of its grid; the rows come to DIR/taps.csv. Ended before its
# time, the same command goes on. ETHD_STUDY names the program, if it isn't in the path.
set -eu
[ $# -ge 3 ] || { sed -n '3,5s/^# *//p' "$0" >&2; exit 2; }
study=$1 participants=$2 out=$3 workers=${4:-$(nproc)}
program=${ETHD_STUDY:-ethd-study}

case $workers in '' | *[!0-9]*) echo "parallel.sh: \"$workers\": a number of workers is needed" >&2; exit 2 ;; esac

# The command that runs for each number. Names are passed in the environment, because GNU parallel makes a shell command of
# its words, and both it and xargs replace {} in them.
export ETHD_PROGRAM="$program" ETHD_FILE="$study" ETHD_PEOPLE="$participants" ETHD_WORKERS="$workers" ETHD_OUT="$out"
export ETHD_SHARD='exec "$ETHD_PROGRAM" "$ETHD_FILE" --simulate "$ETHD_PEOPLE" --shard "$1/$ETHD_WORKERS" --out "$ETHD_OUT"'
if parallel --version 2>/dev/null | grep -q GNU; then
  seq "$workers" | parallel --will-cite --halt now,fail=1 -j "$workers" 'sh -c "$ETHD_SHARD" shard {}'
else
  seq "$workers" | xargs -P "$workers" -n 1 sh -c "$ETHD_SHARD" shard
fi
"$program" --merge "$out"
