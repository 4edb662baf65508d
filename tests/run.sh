#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test; with --all also under the sanitizers, and
# with the Debian package in a new Debian, and with BORESIGHT_DATA set also on images of full size.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source app/packages.sh

case "${1:-}" in
  "") presets=(release) ;;
  --all)
    presets=(release asan tsan)
    export BORESIGHT_ALL=1  # also cases of full size, where there is data
    boresight_optional_packages+=(clang)  # a third compiler, and the one of the sanitizers
    boresight_optional_packages+=(blender python3-numpy)  # renders what resources/synthetic makes
    boresight_optional_packages+=(slurm-wlm munge)  # a cluster of one machine, for resources/slurm
    boresight_optional_packages+=(dpkg-dev mmdebstrap lintian)  # a new Debian, for the packages that cpack makes
    boresight_optional_packages+=(zsh fish groff)  # what reads completions and manual pages
    ;;
  *) echo "usage: bash tests/run.sh [--all]" >&2; exit 2 ;;
esac

installPackages
installOptionalPackages
if [ -n "${BORESIGHT_ALL:-}" ]; then configureAndBuild release benchmarks; fi
for preset in "${presets[@]}"; do
  configureAndBuild "$preset"
  ctest --preset "$preset" --output-on-failure -j2
done
