#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs `whs evaluate` as a Slurm job array, one shard a task, and merges what comes out of it.
# See README.md in this folder.
set -euo pipefail

usage() {
  cat >&2 <<'TEXT'
usage: evaluate.sh --out RESULTS.sqlite --shards N [--jobs N] [--whs PROGRAM] [--sbatch OPTION ...]
                   -- --dataset DATASET.json [options of whs evaluate but --out, --shard, --jobs]
TEXT
  exit 2
}

# Restarts of a task whose program was killed; Slurm's own requeues (preemption, a lost node) are
# not limited here.
max_restarts=5

# task WHS FOLDER SHARDS JOBS ARGUMENT...: one shard, gone on with where it was left.
runTask() {
  local whs=$1 folder=$2 shards=$3 jobs=$4
  shift 4
  local results="$folder/shard-$SLURM_ARRAY_TASK_ID.sqlite"
  # Slurm runs one instance of a task at a time: a lock that is here is of one that was killed,
  # perhaps on another node, of which this one cannot know.
  rm -f "$results.lock"
  local status=0
  "$whs" evaluate "$@" --shard "$SLURM_ARRAY_TASK_ID/$shards" --jobs "$jobs" --out "$results" ||
    status=$?
  if [ "$status" -gt 128 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt "$max_restarts" ]; then
    echo "the program was killed (status $status): this task is queued again" >&2
    exec scontrol requeue "$SLURM_JOB_ID"
  fi
  exit "$status"
}

# merge WHS FOLDER SHARDS JOBS OUT ARGUMENT...: joins the shards, runs what is missing (nothing,
# unless a task was cancelled), and prints the summary.
runMerge() {
  local whs=$1 folder=$2 shards=$3 jobs=$4 out=$5
  shift 5
  local files=() shard
  for shard in $(seq "$shards"); do
    if [ -e "$folder/shard-$shard.sqlite" ]; then files+=("$folder/shard-$shard.sqlite"); fi
  done
  [ "${#files[@]}" -gt 0 ] || { echo "no shard has results; see $folder/*.log" >&2; exit 1; }
  "$whs" merge "$out" "${files[@]}"
  exec "$whs" evaluate "$@" --jobs "$jobs" --out "$out"
}

submit() {
  local out="" shards="" jobs=1 whs="whs" options=()
  while [ $# -gt 0 ]; do
    case "$1" in
      --out) out=${2-}; shift 2 || usage ;;
      --shards) shards=${2-}; shift 2 || usage ;;
      --jobs) jobs=${2-}; shift 2 || usage ;;
      --whs) whs=${2-}; shift 2 || usage ;;
      --sbatch) options+=("${2-}"); shift 2 || usage ;;
      --) shift; break ;;
      *) usage ;;
    esac
  done
  [[ "$shards" =~ ^[1-9][0-9]*$ && "$jobs" =~ ^[1-9][0-9]*$ && -n "$out" && $# -gt 0 ]] || usage
  whs=$(command -v "$whs") || { echo "there is no program $whs: name it with --whs" >&2; exit 2; }
  whs=$(realpath "$whs")
  out=$(realpath -m "$out")
  local folder="$out.shards" array merge
  mkdir -p "$folder"
  array=$(sbatch --parsable --job-name=whs-evaluate --array="1-$shards" --requeue \
    --cpus-per-task="$jobs" --open-mode=append --output="$folder/shard-%a.log" \
    "${options[@]}" "$0" task "$whs" "$folder" "$shards" "$jobs" "$@")
  merge=$(sbatch --parsable --job-name=whs-merge --dependency="afterany:${array%%;*}" \
    --cpus-per-task="$jobs" --open-mode=append --output="$folder/merge.log" \
    "${options[@]}" "$0" merge "$whs" "$folder" "$shards" "$jobs" "$out" "$@")
  echo "array ${array%%;*} merge ${merge%%;*}"
}

case "${1-}" in
  task) shift; runTask "$@" ;;
  merge) shift; runMerge "$@" ;;
  *) submit "$@" ;;
esac
