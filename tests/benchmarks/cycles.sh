#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: cycles.sh BUILD DATASET CASE...   (OPTIONS="--set NAME=VALUE" changes options)
#        cycles.sh --check
# Estimates the cycles of localizations stage by stage on a PowerPC 750: the flight driver, built
# for that processor, runs in QEMU with the plugin of the folder cycles, a model of the processor's
# units, caches and branch prediction. Low, mid, high, cached: assumptions in cycles/plugin.cpp;
# resources/evidence/speed_and_memory.md explains them. BUILD is a build folder with whs; the driver
# and the plugin are built in BUILD/cycles. A case takes three minutes; PERIOD=0 measures all
# instructions, not half a million of each 10 million, and takes ten. A stage without a measured
# instruction has 0 cycles.
# --check runs loops whose cycles the processor's manual gives, and fails where the model differs.
set -euo pipefail
source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
here="$source_dir/tests/benchmarks/cycles"
cross=powerpc-linux-gnu
for program in qemu-ppc $cross-g++; do
  command -v "$program" >/dev/null || {
    echo "SKIPPED: $program is not installed"
    exit 77
  }
done

buildPlugin() { # FOLDER
  g++ -std=c++20 -O3 -fPIC -shared -fvisibility=hidden -fno-exceptions -fno-rtti \
    -Wall -Wextra -Wshadow -Wconversion -Werror "$here"/*.cpp -o "$1/cycles.so"
}

# Cycles an instruction of loops in cycles/known.S, by the manual, without a miss of the caches.
known="dependent_additions 1
independent_additions 0.5
divisions 19
dependent_float_products 4
independent_float_products 2
dependent_float_sums 3
float_divisions 31
dependent_loads 2
independent_loads 1"

check() {
  local folder entries
  folder="$(mktemp -d)"
  # shellcheck disable=SC2064  # the folder of now
  trap "rm -rf '$folder'" EXIT
  buildPlugin "$folder"
  $cross-gcc -mcpu=750 -nostdlib -static "$here/known.S" -o "$folder/known"
  entries="$($cross-nm "$folder/known" |
    awk 'tolower($2) == "t" { printf ",entry=%s:%s", $1, $3 }')"
  qemu-ppc -cpu 750 -plugin "$folder/cycles.so$entries" "$folder/known" 2>"$folder/counts"
  # The low estimate has the fastest memory: least is added by the misses of the first round.
  awk 'NR == FNR { expected[$1] = $2 * 6000; next }
    FNR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i }
    $1 in expected {
      cycles = $column["cycles_low"]
      good = cycles >= expected[$1] - 50 && cycles <= expected[$1] + 250
      printf "%-28s %8d cycles, %8d by the manual%s\n", $1, cycles, expected[$1],
        good ? "" : ": DIFFERENT"
      found += good
    }
    $1 == "missing_loads" {
      misses = $column["load_misses"]
      printf "%-28s %8d misses, %8d lines\n", $1, misses, 6000
      found += misses == 6000
    }
    END { exit found != 10 }' <(echo "$known") "$folder/counts"
}

if [ "${1:-}" = --check ]; then
  check
  exit
fi
[ $# -ge 3 ] || {
  sed -n '3,13s/^# //p' "${BASH_SOURCE[0]}"
  exit 2
}
build="$(cd "$1" && pwd)" dataset="$2"
shift 2
folder="$build/cycles"
mkdir -p "$folder"
buildPlugin "$folder"
cmake -S "$source_dir" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_TOOLCHAIN_FILE="$source_dir/cmake/powerpc-750.cmake" \
  -DBORESIGHT_BUILD_SESSIONS=OFF -DBORESIGHT_BUILD_UI=OFF -DBORESIGHT_BUILD_TESTS=OFF \
  -DBORESIGHT_FLIGHT_ARENA_BYTES=400000000 >"$folder.log" 2>&1 &&
  cmake --build "$folder" --target flight_driver --parallel 2 >>"$folder.log" 2>&1 || {
  cat "$folder.log"
  exit 1
}
driver="$folder/app/flight/flight_driver"

# The functions that a stage consists of, as in instructions.sh.
stages="initialization Localizer::step Pass::create
search PoseSearch::step
rendering Pass::stepRender
matching Pass::stepMatch Pass::stepTemplates
pose PnpRansac::step
refinement Pass::stepRefine Pass::stepSupport CompetingPoseTest::step"

# Arguments of the plugin: addresses of the functions; fails if one is not in the driver.
entries() {
  $cross-nm -C "$driver" | awk -v stages="$stages" '
    BEGIN {
      count = split(stages, lines, "\n")
      for (i = 1; i <= count; ++i) {
        fields = split(lines[i], words, " ")
        for (j = 2; j <= fields; ++j) stage["boresight::" words[j]] = words[1]
      }
    }
    tolower($2) == "t" {
      name = $3
      sub(/\(.*/, "", name)
      if (name in stage) { printf ",entry=%s:%s", $1, stage[name]; found[name] }
    }
    END {
      for (name in stage)
        if (!(name in found)) { print name " is not a function" >"/dev/stderr"; exit 1 }
    }'
}

run() { # CASE
  "$build/app/whs" problem --dataset "$dataset" --case "$1" --out "$folder/$1.bin" \
    --image-out "$folder/$1.pgm" ${OPTIONS:-} >/dev/null
  qemu-ppc -cpu 750 -plugin "$folder/cycles.so$entries,period=${PERIOD:-10000000}" \
    "$driver" "$folder/$1.bin" "$folder/$1.pgm" >"$folder/$1.txt" 2>"$folder/$1.counts"
}

entries="$(entries)"
for name in "$@"; do
  run "$name" || {
    cat "$folder/$name.txt" "$folder/$name.counts" >&2
    exit 1
  }
done

# Counts of the cases, a line a stage, then their sums.
for name in "$@"; do sed "s/^/$name /" "$folder/$name.counts"; done | awk '
  function addLine(name, stage, i) {
    for (i = 3; i <= NF; ++i) sum[name, stage, column[i]] += $i
  }
  function value(name) { return sum[case_name, stage, name] }
  function printTimes() {
    printf "%-10s %-14s %12.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f\n", case_name, stage,
      value("instructions") / 1e9, value("cycles_low") / 1e9, value("cycles_mid") / 1e9,
      value("cycles_high") / 1e9, value("cycles_cached") / 1e9, value("cycles_low") / 12e9,
      value("cycles_mid") / 12e9, value("cycles_high") / 12e9
  }
  function printMix(   i) {
    if (value("instructions") == 0) return
    printf "%-10s %-14s", case_name, stage
    for (i = 8; i <= NF; ++i)
      printf " %*.2f", length(column[i]) < 6 ? 6 : length(column[i]),
        1000 * value(column[i]) / value("instructions")
    printf "\n"
  }
  function forAll(printer,   c, s) {
    for (c = 1; c <= cases; ++c)
      for (s = 1; s <= stages; ++s) {
        case_name = names[c]
        stage = order[s]
        if (printer == "times") printTimes(); else printMix()
      }
  }
  BEGIN {
    stages = split("initialization search rendering matching pose refinement total", order, " ")
  }
  $2 == "stage" {
    for (i = 3; i <= NF; ++i) column[i] = $i
    names[++cases] = $1
    next
  }
  { addLine($1, $2); addLine($1, "total"); addLine("all", $2); addLine("all", "total") }
  END {
    if (cases > 1) names[++cases] = "all"
    print "Instructions and cycles in 1e9, minutes at 200 MHz:"
    printf "%-10s %-14s %12s %8s %8s %8s %8s %8s %8s %8s\n", "case", "stage", "instructions",
      "low", "mid", "high", "cached", "min_low", "min_mid", "min_high"
    forAll("times")
    print "\nOf 1000 instructions:"
    printf "%-10s %-14s", "case", "stage"
    for (i = 8; i <= NF; ++i) printf " %6s", column[i]
    printf "\n"
    forAll("mix")
  }'
