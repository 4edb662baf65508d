#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# missing_dependency.sh SOURCE CMAKE GENERATOR: what configuring says where something is missing.
set -euo pipefail
source=$1 cmake=$2 generator=$3

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

if "$cmake" -S "$source" -B "$folder" -G "$generator" -DBORESIGHT_BUILD_UI=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON \
  >"$folder/out" 2>"$folder/err"; then
  echo "configured without nlohmann_json and CLI11" >&2
  exit 1
fi
expected='Missing: nlohmann_json, CLI11; on Debian: apt-get install nlohmann-json3-dev libcli11-dev'
grep -qF "$expected" "$folder/err" || {
  cat "$folder/err" >&2
  echo "no line says: $expected" >&2
  exit 1
}
