#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test; with --all also under the sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source app/packages.sh

case "${1:-}" in
  "") presets=(release) ;;
  --all) presets=(release asan) ;;
  *) echo "usage: bash tests/run.sh [--all]" >&2; exit 2 ;;
esac

installPackages
for preset in "${presets[@]}"; do
  configureAndBuild "$preset"
  ctest --preset "$preset" --output-on-failure -j2
done
