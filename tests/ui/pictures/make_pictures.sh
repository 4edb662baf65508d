#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_pictures.sh BUILD [NAME ...]: renders the manual's pictures (resources/manual/pictures) again
# from the examples that ship, on a virtual display. Needs xvfb-run, and pngquant to keep them small.
set -euo pipefail
build=$(realpath "$1")
shift
source=$(realpath "$(dirname "$0")/../../..")
pictures=$source/resources/manual/pictures
for program in xvfb-run pngquant; do
  command -v "$program" >/dev/null || { echo "no $program: apt-get install xvfb pngquant" >&2; exit 1; }
done
cmake --build "$build" --target whs manual_pictures manual >/dev/null
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export HOME=$folder XDG_CONFIG_HOME=$folder/config XDG_RUNTIME_DIR=$folder
cp -r "$source/sessions/examples" "$folder/examples"
cd "$folder/examples"
whs=$build/app/whs
os=stations/os
$whs localize --image $os/image.png --camera $os/camera.json --mesh $os/model.ply --mesh-unit m \
  --seed $os/seed.json --feature-size 0.018 --record os.whsr >/dev/null
$whs new --dataset stations/dataset.json --case os-000038 --record os.whsr --out onboard.boresight.json >/dev/null
python3 - <<'EDIT'
import json
session = json.load(open("turned.boresight.json"))
session["cases"][0]["uncertainty"]["rotation_deg"] = [2.2, 2.2, 45]
json.dump(session, open("stated.boresight.json", "w"))
EDIT
$whs evaluate --dataset stations/dataset.json --reseed 5 --reseed-scale 1.5 --jobs 2 --out results.sqlite >/dev/null 2>&1
$whs new --results results.sqlite --out batch.boresight.json >/dev/null
$whs run batch.boresight.json >/dev/null || [ $? -eq 4 ]
mkdir -p "$folder/out" "$pictures"
xvfb-run -a -s "-screen 0 1600x1300x24" env QT_QPA_PLATFORM=xcb \
  "$build/tests/ui/pictures/manual_pictures" "$folder/examples" "$folder/out" "$@"
if [ $# -eq 0 ]; then
  $whs tables results.sqlite --figures figures --figure-format png >/dev/null
  cp figures/success_seed_error.png "$folder/out/evaluation.png"
fi
for file in "$folder/out"/*.png; do
  for colors in 256 64 40 28; do  # a picture stays below 260 kB
    pngquant --force --strip --nofs --speed 1 --output "$pictures/$(basename "$file")" $colors "$file"
    [ "$(stat -c %s "$pictures/$(basename "$file")")" -ge 255000 ] || break
  done
done
ls -l "$pictures"
