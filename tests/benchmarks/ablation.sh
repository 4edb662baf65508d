#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: ablation.sh WHS DATASET FOLDER [OPTION OF whs evaluate ...]
# From profile `paper` to profile `default`: every row adds one departure to those above it, on the
# same cases and seeds. Results go to FOLDER/NN_NAME.sqlite; an interrupted run continues. A table
# follows of all rows; FOLDER/cpu_seconds.txt has each row's processor time. SINGLE=1: each
# departure alone, added to profile `paper`.
set -euo pipefail
[ $# -ge 3 ] || {
  sed -n '3,7s/^# //p' "${BASH_SOURCE[0]}"
  exit 2
}
whs="$1" dataset="$2" folder="$3"
shift 3
mkdir -p "$folder"

# NAME OPTION=VALUE ...: values of profile `default`. The last row is that profile itself, whose
# other options (limits of memory) change no pose.
departures=(
  "correction_at_station loop.correction_point=station loop.converged_image_px=0.25"
  "larger_templates templates.size_factor=2"
  "guided_samples pnp.sampler=guided pnp.max_samples=500"
  "subpixel_peaks loop.subpixel_matches=true"
  "coarse_start loop.coarse_size_px=640 loop.halved_size_px=512"
  "rolled_renders loop.max_rolled_hypotheses=9 loop.enough_inliers=0.5"
  "pose_prior loop.anchored=true loop.leave_factor=1.5"
  "refinement refinement.enabled=true loop.match_iterations=2 loop.render_again_px=0.25"
  "acceptance support.gate=true"
  "three_attempts loop.max_attempts=3"
  "search search.enabled=true"
)

evaluate() { # NAME SETTING...
  local name="$1"
  shift
  local TIMEFORMAT="$name %U"
  {
    time "$whs" evaluate --dataset "$dataset" --out "$folder/$name.sqlite" "${options[@]}" "$@" \
      >"$folder/$name.txt" 2>&1
  } 2>>"$folder/cpu_seconds.txt"
}

options=("$@")
evaluate 00_paper --profile paper
settings=()
number=0
for departure in "${departures[@]}"; do
  read -r name values <<<"$departure"
  [ "${SINGLE:-0}" = 1 ] && settings=()
  for value in $values; do settings+=(--set "$value"); done
  number=$((number + 1))
  evaluate "$(printf '%02d_%s' "$number" "$name")" --profile paper "${settings[@]}"
done
evaluate "$(printf '%02d_default' $((number + 1)))" --profile default
"$whs" tables "$folder"/[0-9]*.sqlite --table errors --table times
