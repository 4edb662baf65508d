#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: instructions.sh BUILD DATASET CASE...   (OPTIONS="--set NAME=VALUE" changes options)
# Counts the instructions of localizations stage by stage, under callgrind: the flight driver as a
# release build for any x86-64 processor, portable kernels, no SHA instructions. The counts are the
# same on every machine with the same compiler. BUILD is a build folder with whs; the driver is
# built in BUILD/instructions with an arena for any case. Minutes are those of a processor of
# 200 MHz that does one instruction a cycle, as in the paper's table.
set -euo pipefail
[ $# -ge 3 ] || {
  sed -n '3,9s/^# //p' "${BASH_SOURCE[0]}"
  exit 2
}
build="$(cd "$1" && pwd)" dataset="$2"
shift 2
source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
command -v valgrind >/dev/null || {
  echo "SKIPPED: valgrind is not installed"
  exit 77
}

folder="$build/instructions"
mkdir -p "$folder"
cmake -S "$source_dir" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DBORESIGHT_BUILD_SESSIONS=OFF -DBORESIGHT_BUILD_UI=OFF -DBORESIGHT_BUILD_TESTS=OFF \
  -DBORESIGHT_FLIGHT_ARENA_BYTES=400000000 >"$folder.log" 2>&1 &&
  cmake --build "$folder" --target flight_driver --parallel 2 >>"$folder.log" 2>&1 || {
  cat "$folder.log"
  exit 1
}

# inclusive FILE FUNCTION: instructions of a function and all it calls.
inclusive() {
  awk -v name="boresight::$2(" \
    'index($0, name) { gsub(",", "", $1); sum = $1; exit } END { printf "%.0f\n", sum }' "$1"
}

printf '%-14s %14s %14s %14s %14s %14s %14s %14s\n' case initialization search rendering matching \
  pose refinement total
for name in "$@"; do
  "$build/app/whs" problem --dataset "$dataset" --case "$name" --out "$folder/problem.bin" \
    --image-out "$folder/image.pgm" ${OPTIONS:-} >/dev/null
  valgrind --tool=callgrind --callgrind-out-file="$folder/callgrind.out" \
    "$folder/app/flight/flight_driver" "$folder/problem.bin" "$folder/image.pgm" \
    >"$folder/$name.txt" 2>"$folder/valgrind.log" || {
    cat "$folder/$name.txt" "$folder/valgrind.log"
    exit 1
  }
  callgrind_annotate --inclusive=yes --threshold=100 "$folder/callgrind.out" >"$folder/list" 2>&1
  step=$(inclusive "$folder/list" Localizer::step)
  begin=$(inclusive "$folder/list" Localizer::begin)
  search=$(inclusive "$folder/list" PoseSearch::step)
  render=$(inclusive "$folder/list" Pass::stepRender)
  match=$(($(inclusive "$folder/list" Pass::stepMatch) + $(inclusive "$folder/list" Pass::stepTemplates)))
  pose=$(inclusive "$folder/list" PnpRansac::step)
  # The acceptance of the pose is part of the refinement.
  refine=$(($(inclusive "$folder/list" Pass::stepRefine) + $(inclusive "$folder/list" Pass::stepSupport) +
    $(inclusive "$folder/list" CompetingPoseTest::step)))
  # The rest of a step is the computation of the image's edges.
  first=$((begin + step - search - render - match - pose - refine))
  echo "$name $first $search $render $match $pose $refine $((begin + step))"
done | awk '
  { printf "%-14s", $1; for (i = 2; i <= 8; ++i) { printf " %14.0f", $i; sum[i] += $i } printf "\n" }
  END {
    printf "%-14s", "sum"; for (i = 2; i <= 8; ++i) printf " %14.0f", sum[i]; printf "\n"
    printf "%-14s", "minutes"; for (i = 2; i <= 8; ++i) printf " %14.3f", sum[i] / 200e6 / 60
    printf "\n"
  }'
