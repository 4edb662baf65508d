#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and localizes the example that ships with Boresight.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source app/packages.sh

installPackages
configureAndBuild release whs

station=bc
example=sessions/examples/stations
out=out/example
mkdir -p "$out"
echo
echo "Localizing $example/$station/image.png"
echo
build/release/app/whs localize \
  --image "$example/$station/image.png" --camera "$example/$station/camera.json" \
  --mesh "$example/$station/model.ply" --mesh-unit m \
  --seed "$example/$station/seed.json" --truth "$example/$station/truth.json" \
  --feature-size 0.015 \
  --out "$out/result.json" --trace "$out/trace.bin" --overlay "$out/overlay.png"
echo
echo "Wrote $out/overlay.png (seed red, result green, truth blue), $out/result.json, $out/trace.bin"
