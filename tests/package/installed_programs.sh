#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Run inside a new Debian by debian_package.sh: installs /tmp/boresight.deb and uses what it brings,
# as a user without write access to the installation.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
examples=/usr/share/boresight/examples

fail() {
  echo "failed: $*" >&2
  exit 1
}

apt-get update
echo "installing the package"
apt-get install -y --no-install-recommends \
  /tmp/boresight.deb desktop-file-utils shared-mime-info libglib2.0-bin man-db poppler-utils
echo "installed the package"
dpkg --verify boresight

user=$(mktemp -d)
chown nobody "$user"
cd "$user"
# as COMMAND...: without a display, without anything of the environment.
as() {
  setpriv --reuid nobody --clear-groups env -i HOME="$user" PATH=/usr/bin:/bin LC_ALL=C.UTF-8 "$@"
}

as boresight --version
as whs --version
as boresight --self-test
as whs localize --image $examples/stations/os/image.png --camera $examples/stations/os/camera.json \
  --mesh $examples/stations/os/model.ply --mesh-unit m --seed $examples/stations/os/seed.json \
  --truth $examples/stations/os/truth.json --feature-size 0.018 --record run.whsr --trace run.trace
as whs bench --quick --case bc-000028 >bench.txt || { cat bench.txt; fail "whs bench finds no examples"; }
as whs new --dataset $examples/stations/dataset.json --out sol12.boresight.json
as whs run sol12.boresight.json
as whs report sol12.boresight.json --case bc-000028 --out report.pdf
as pdffonts report.pdf | grep DejaVu >/dev/null || fail "the report is written in no letters of ours"
as boresight --screenshot window.png $examples/example.boresight.json
[ -s window.png ] || fail "no picture of the window"

for page in index start options whs keys cameras; do
  [ -s /usr/share/boresight/manual/$page.md ] || fail "the manual has no page $page"
done
[ -s /usr/share/boresight/manual/pictures/window.png ] || fail "the manual has no pictures"

desktop-file-validate /usr/share/applications/boresight.desktop
# typeIs FILE TYPE: as a file manager sees it.
typeIs() {
  local type
  type=$(as gio info -a standard::content-type "$1" | sed -n 's/.*standard::content-type: //p')
  [ "$type" = "$2" ] || fail "$1 is taken for $type, not for $2"
}
typeIs sol12.boresight.json application/vnd.boresight.session+json
typeIs run.whsr application/vnd.boresight.record
typeIs run.trace application/vnd.boresight.trace
typeIs $examples/stations/os/camera.json application/json
as gio mime application/vnd.boresight.session+json | grep boresight.desktop >/dev/null ||
  fail "a session is not opened with the desktop program"
[ -e /usr/share/icons/hicolor/scalable/apps/boresight.svg ] || fail "no icon"

for page in boresight whs whs-localize whs-evaluate; do
  as man --warnings -E UTF-8 "$page" >page.txt 2>warnings.txt || fail "no manual page of $page"
  [ ! -s warnings.txt ] || { cat warnings.txt; fail "the manual page of $page"; }
done
as bash -c 'source /usr/share/bash-completion/completions/whs
  COMP_WORDS=(whs loc) COMP_CWORD=1; _whs; [ "${COMPREPLY[*]}" = localize ]' ||
  fail "bash does not complete whs"

apt-get purge -y boresight
for left in /usr/bin/whs /usr/share/boresight /usr/share/doc/boresight; do
  [ ! -e "$left" ] || fail "$left is left behind"
done
echo "used the installed programs"
