#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: instructions.sh BUILD DATASET CASE...   (OPTIONS="--set NAME=VALUE" changes options)
# Counts the instructions of localizations stage by stage, under callgrind: the flight driver as a
# release build for any x86-64 processor, portable kernels, no SHA instructions. The counts are the
# same on every machine with the same compiler. BUILD is a build folder with whs; the driver is
# built in BUILD/instructions with an arena for any case. Minutes are those of a processor of
# 200 MHz that does one instruction a cycle, as in the paper's table.
# METHODS="ncc orb" counts runs of `whs evaluate` with these methods instead: OpenCV without vector
# instructions beyond SSE3. JSON=FILE writes the counts for `whs tables --instructions FILE`; NAME
# follows the method in its name, e.g. the profile.
set -euo pipefail
[ $# -ge 3 ] || {
  sed -n '3,12s/^# //p' "${BASH_SOURCE[0]}"
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
if [ -z "${METHODS:-}" ]; then
  cmake -S "$source_dir" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DBORESIGHT_BUILD_SESSIONS=OFF -DBORESIGHT_BUILD_UI=OFF -DBORESIGHT_BUILD_TESTS=OFF -DBORESIGHT_UNITY=ON \
    -DBORESIGHT_FLIGHT_ARENA_BYTES=400000000 >"$folder.log" 2>&1 &&
    cmake --build "$folder" --target flight_driver --parallel 2 >>"$folder.log" 2>&1 || {
    cat "$folder.log"
    exit 1
  }
fi

# inclusive FUNCTION: instructions of a function and all it calls, from $folder/list.
inclusive() {
  awk -v name="boresight::$1(" \
    'index($0, name) { gsub(",", "", $1); sum = $1; exit } END { printf "%.0f\n", sum }' \
    "$folder/list"
}

count_flight_driver() { # CASE
  "$build/app/whs" problem --dataset "$dataset" --case "$1" --out "$folder/problem.bin" \
    --image-out "$folder/image.pgm" ${OPTIONS:-} >/dev/null
  valgrind --tool=callgrind --callgrind-out-file="$folder/callgrind.out" \
    "$folder/app/flight/flight_driver" "$folder/problem.bin" "$folder/image.pgm"
}

count_method() { # METHOD CASE
  rm -f "$folder"/run.sqlite*
  OPENCV_CPU_DISABLE=SSSE3,SSE4.1,SSE4.2,AVX,FP16,FMA3,AVX2,AVX512F \
    valgrind --tool=callgrind --callgrind-out-file="$folder/callgrind.out" \
    "$build/app/whs" evaluate --dataset "$dataset" --case "$2" --method "$1" --threads 1 \
    --kernels portable --out "$folder/run.sqlite" ${OPTIONS:-}
}

# stages METHOD CASE: method, case and the instructions of the stages and their sum.
stages() {
  local run="count_method $1"
  [ -n "${METHODS:-}" ] || run=count_flight_driver
  $run "$2" >"$folder/$1-$2.txt" 2>"$folder/valgrind.log" || {
    cat "$folder/$1-$2.txt" "$folder/valgrind.log" >&2
    exit 1
  }
  callgrind_annotate --inclusive=yes --threshold=100 "$folder/callgrind.out" >"$folder/list" 2>&1
  local step begin search render match pose refine first
  step=$(inclusive Localizer::step)
  # Construction: hashes the inputs. Localizer::begin is inlined.
  begin=$(inclusive Pass::create)
  search=$(inclusive PoseSearch::step)
  render=$(inclusive Pass::stepRender)
  match=$(($(inclusive Pass::stepMatch) + $(inclusive Pass::stepTemplates)))
  pose=$(inclusive PnpRansac::step)
  # The acceptance of the pose is part of the refinement.
  refine=$(($(inclusive Pass::stepRefine) + $(inclusive Pass::stepSupport) +
    $(inclusive CompetingPoseTest::step)))
  # The rest of a step is the computation of the image's edges.
  first=$((begin + step - search - render - match - pose - refine))
  # Other methods match outside of the core's steps.
  match=$((match + $(inclusive sessions::OutsideMatching::serve)))
  echo "$1 $2 $first $search $render $match $pose $refine \
$((first + search + render + match + pose + refine))"
}

for method in ${METHODS:-whs}; do
  for name in "$@"; do stages "$method" "$name"; done
done >"$folder/counts"

awk '
  BEGIN {
    printf "%-8s %-14s %14s %14s %14s %14s %14s %14s %14s\n", "method", "case", "initialization",
      "search", "rendering", "matching", "pose", "refinement", "total"
  }
  { printf "%-8s %-14s", $1, $2
    for (i = 3; i <= 9; ++i) { printf " %14.0f", $i; sum[$1, i] += $i }
    printf "\n"; methods[$1] }
  END {
    for (method in methods) {
      printf "%-8s %-14s", method, "minutes"
      for (i = 3; i <= 9; ++i) printf " %14.3f", sum[method, i] / 200e6 / 60
      printf "\n"
    }
  }' "$folder/counts"
[ -z "${JSON:-}" ] || awk -v suffix="${NAME:+ $NAME}" '
  BEGIN { printf "{\"format\": \"boresight-instructions\", \"version\": 1, \"runs\": [" }
  { station = $2; sub(/-.*/, "", station)
    printf "%s\n  {\"method\": \"%s%s\", \"station\": \"%s\", \"case\": \"%s\", \"initialization\": %s, \
\"search\": %s, \"rendering\": %s, \"matching\": %s, \"pose\": %s, \"refinement\": %s}",
      (NR > 1 ? "," : ""), $1, suffix, station, $2, $3, $4, $5, $6, $7, $8 }
  END { print "\n]}" }' "$folder/counts" >"$JSON"
