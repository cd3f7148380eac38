#!/bin/sh
#SBATCH --job-name=ethd-study
#SBATCH --array=1-64
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --requeue
# A simulation as an array of jobs; DIR lies on a file system that all nodes see.
#   sbatch slurm.sh STUDY N DIR
#   srun --ntasks=1 ethd-study --merge DIR         when all have ended
# A job that was requeued goes on where it was. Another number of shards: sbatch --array=1-200 slurm.sh ...
set -eu
[ $# -eq 3 ] || { sed -n '8,11s/^# *//p' "$0" >&2; exit 2; }
: "${SLURM_ARRAY_TASK_ID:?is set by sbatch --array}" "${SLURM_ARRAY_TASK_COUNT:?is set by sbatch --array}"
exec "${ETHD_STUDY:-ethd-study}" "$1" --simulate "$2" \
  --shard "$((SLURM_ARRAY_TASK_ID - ${SLURM_ARRAY_TASK_MIN:-1} + 1))/$SLURM_ARRAY_TASK_COUNT" --out "$3"
