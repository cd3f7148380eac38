#!/bin/sh
# A simulation on many machines: every rank does its shard; nothing is sent between them.
#   sh mpi.sh STUDY N DIR [mpirun's OPTIONS: -np 64 --hostfile hosts]
# DIR lies on a file system that all nodes see; the rows come to DIR/taps.csv.
set -eu
[ $# -ge 3 ] || { sed -n '3,4s/^# *//p' "$0" >&2; exit 2; }
study=$1 participants=$2 out=$3
shift 3
program=${ETHD_STUDY:-ethd-study}
root=
[ "$(id -u)" != 0 ] || root=--allow-run-as-root # Open MPI asks root twice

# OMPI_ of Open MPI, PMI_ of MPICH and Intel MPI
rank='r=${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}} n=${OMPI_COMM_WORLD_SIZE:-${PMI_SIZE:-1}}
exec "$0" "$1" --simulate "$2" --shard "$((r + 1))/$n" --out "$3"'
${MPIRUN:-mpirun} $root "$@" sh -c "$rank" "$program" "$study" "$participants" "$out"
"$program" --merge "$out"
