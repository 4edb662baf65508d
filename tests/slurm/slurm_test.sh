#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: slurm_test.sh WHS DATASET: an evaluation as a job array on a real cluster of this machine,
# one task killed and queued again, gives bit for bit what one process gives.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/cluster.sh"
whs=$1
dataset=$2

skip() { echo "skipped: $1"; exit 77; }
[ -n "${BORESIGHT_ALL-}" ] || skip "only with BORESIGHT_ALL (bash tests/run.sh --all)"
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" >/dev/null || skip "there is no $program (packages slurm-wlm, munge)"
done
[ "$(id -u)" -eq 0 ] || skip "a cluster of one's own needs root"

folder=$(mktemp -d)
finish() {
  local status=$?
  if [ "$status" -ne 0 ]; then tail -n 20 "$folder"/*.log "$folder"/*.out "$folder"/*.shards/*.log || true; fi
  stopCluster
  rm -rf "$folder"
}
trap finish EXIT
startCluster "$folder"

arguments=(--dataset "$dataset" --reseed 7 --set loop.max_iterations=3)
"$whs" evaluate "${arguments[@]}" --out "$folder/one.sqlite" >/dev/null

submitted=$("$here/../../resources/slurm/evaluate.sh" --out "$folder/many.sqlite" --shards 2 \
  --whs "$whs" -- "${arguments[@]}")
merge=${submitted##* }

runsIn() { "$whs" tables "$1" --table times --format csv 2>/dev/null | sed -n 2p | cut -d, -f2; }
hasRuns() { [ "$(runsIn "$1")" -ge "$2" ] 2>/dev/null; }
processOf() { pgrep -f "evaluate .*--shard 1/2 .*--out $folder/many.sqlite.shards/"; }

waitFor "the first runs of shard 1" hasRuns "$folder/many.sqlite.shards/shard-1.sqlite" 2
held=$(runsIn "$folder/many.sqlite.shards/shard-1.sqlite")
for process in $(processOf); do
  if [ "$(readlink "/proc/$process/exe")" = "$(realpath "$whs")" ]; then kill -9 "$process"; fi
done

isOver() { [ -z "$(squeue --noheader --jobs "$merge" 2>/dev/null)" ]; }
waitFor "the merge" isOver
grep -q "queued again" "$folder/many.sqlite.shards/shard-1.log" ||
  { echo "the killed task was not queued again" >&2; exit 1; }
grep -Eq "resumed, [0-9]+ of 8 runs are done" "$folder/many.sqlite.shards/shard-1.log" ||
  { echo "the task did not go on with the $held runs that it had" >&2; exit 1; }

compared=$("$whs" tables "$folder/one.sqlite" --against "$folder/many.sqlite")
echo "$compared" | head -n 1
[[ "$compared" == "16 runs in both: 0 better, 0 worse, 16 the same (16 bit for bit)."* ]]
