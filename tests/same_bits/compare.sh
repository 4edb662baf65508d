#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: compare.sh COLUMN CASES BUILD
# Computes every case in the folder CASES (see cases.cpp) in another way than it was, and says which
# digest or exit status differs. COLUMN is one of
#   release                      the flight driver of the build folder BUILD
#   debug native clang powerpc   a flight driver of its own, built in BUILD/same_bits: not
#                                optimized, for this very processor, by another compiler, for a
#                                32-bit big-endian processor that is emulated
#   whs ARGUMENT...              whs of BUILD itself with further arguments
#   whs_all ARGUMENT...          the same
# debug, native, clang and whs_all run only with BORESIGHT_ALL set. With it, powerpc computes every
# case, not two.
# Exit status 77: a compiler or the emulator is not installed, and nothing was compared.
set -euo pipefail
cases="$2" build="$3"
source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

skip() {
  echo "SKIPPED: $1"
  exit 77
}

requireAll() {
  [ -n "${BORESIGHT_ALL:-}" ] || skip "$1 only with BORESIGHT_ALL (bash tests/run.sh --all)"
}

requireProgram() {
  command -v "$1" >/dev/null || skip "$1 is not installed (Debian package $2)"
}

# buildDriver NAME ARGUMENT...: the core and the driver alone, with arguments for cmake.
buildDriver() {
  local folder="$build/same_bits/$1"
  shift
  cmake -S "$source_dir" -B "$folder" -G Ninja -DBORESIGHT_BUILD_SESSIONS=OFF \
    -DBORESIGHT_BUILD_UI=OFF -DBORESIGHT_BUILD_TESTS=OFF -DBORESIGHT_UNITY=ON "$@" >"$folder.log" 2>&1 &&
    cmake --build "$folder" --target flight_driver --parallel 2 >>"$folder.log" 2>&1 || {
    cat "$folder.log"
    exit 1
  }
  command_line=("$folder/app/flight/flight_driver")
}

mkdir -p "$build/same_bits"
driver=true
left_out=""
case "$1" in
  release) command_line=("$build/app/flight/flight_driver") ;;
  debug)
    requireAll debug
    buildDriver debug -DCMAKE_BUILD_TYPE=Debug
    ;;
  native)
    requireAll native
    buildDriver native -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-march=native
    ;;
  clang)
    requireAll clang
    requireProgram clang++ clang
    buildDriver clang -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=clang \
      -DCMAKE_CXX_COMPILER=clang++
    ;;
  powerpc)
    requireProgram powerpc-linux-gnu-g++ g++-powerpc-linux-gnu
    requireProgram qemu-ppc qemu-user
    buildDriver powerpc -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_TOOLCHAIN_FILE="$source_dir/cmake/powerpc-750.cmake"
    command_line=(qemu-ppc -cpu 750 "${command_line[@]}")
    [ -n "${BORESIGHT_ALL:-}" ] || left_out=" bc_brown_conrady bc_pinhole os_fisheye os_not_converged os_rational "
    ;;
  whs | whs_all)
    [ "$1" = whs ] || requireAll "whs ${*:4}"
    driver=false
    whs_arguments=("${@:4}")
    ;;
  *)
    echo "compare.sh: there is no column $1" >&2
    exit 2
    ;;
esac

# run CASE: output to stdout, messages to stderr.
run() {
  if "$driver"; then
    "${command_line[@]}" "$1/problem.bin" "$1/image.pgm"
  else
    local arguments
    mapfile -t arguments <"$1/arguments"
    "$build/app/whs" localize "${arguments[@]}" "${whs_arguments[@]}"
  fi
}

# compareCase CASE: 0 when exit status and digest are the expected ones.
compareCase() {
  local name output status=0 digest
  name="$(basename "$1")"
  output="$(run "$1" 2>&1)" || status=$?
  digest="$(sed -n 's/^digest //p' <<<"$output")"
  # What this processor lacks is a matter of usage.
  if [ "$status" = 2 ] && grep -q "this machine has" <<<"$output"; then skip "$output"; fi
  if [ "$status" = "$(cat "$1/exit_code")" ] && [ "$digest" = "$(cat "$1/digest")" ]; then
    echo "same bits: $name $digest"
  else
    echo "DIFFERENT: $name: exit status $status, digest ${digest:-none}; expected" \
      "$(cat "$1/exit_code"), $(cat "$1/digest")"
    sed 's/^/    /' <<<"$output"
    return 1
  fi
}

different=0 compared=0
for folder in "$cases"/*/; do
  [ -f "$folder/digest" ] || continue
  [[ "$left_out" != *" $(basename "$folder") "* ]] || continue
  compareCase "${folder%/}" || different=$((different + 1))
  compared=$((compared + 1))
done
echo "$1: $compared cases, $different different"
[ "$compared" -ge 2 ] && [ "$different" -eq 0 ]
