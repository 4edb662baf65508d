#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and opens the example that ships with Boresight in the desktop
# program; without a display, or with --headless, it localizes the example instead.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source app/packages.sh

out=out/example
example=sessions/examples/stations

# The example as a session of its own, so that what is done to it leaves the one that ships alone.
openDesktop() {
  local session="$out/example.boresight.json"
  configureAndBuild release boresight
  [ -e "$session" ] || build/release/app/whs new --dataset "$example/dataset.json" --out "$session"
  echo "Opening $session"
  build/release/app/boresight "$session"
}

localizeExample() {
  local station=bc
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
  echo "Wrote $out/overlay.png (seed orange, result blue, truth white), $out/result.json, $out/trace.bin"
}

installPackages
configureAndBuild release whs
mkdir -p "$out"
if [ "${1:-}" != --headless ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  openDesktop && exit 0
  echo "The window could not be opened; going on without one." >&2
fi
localizeExample
