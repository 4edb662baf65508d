#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# debian_package.sh BUILD SOURCE CPACK: makes the Debian packages of a build, and installs that of
# the programs with its dependencies in a new, otherwise empty Debian, where installed_programs.sh
# uses them. Some 160 MB are downloaded from where this machine has its packages from: only
# with BORESIGHT_ALL, and skipped (77) where it cannot be done.
set -euo pipefail
build=$1 source=$2 cpack=$3
release=bookworm

skip() {
  echo "skipped: $*" >&2
  exit 77
}
fail() {
  echo "failed: $*" >&2
  exit 1
}
[ -n "${BORESIGHT_ALL:-}" ] || skip "a new Debian is only made with tests/run.sh --all"
command -v dpkg-shlibdeps >/dev/null || skip "no dpkg-shlibdeps: apt-get install dpkg-dev"
command -v mmdebstrap >/dev/null || skip "no mmdebstrap: apt-get install mmdebstrap"
sources=
for file in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
  if grep -qs "$release" "$file"; then sources=$file; break; fi
done
[ -n "$sources" ] ||
  skip "this machine's apt has no sources of Debian $release in /etc/apt/sources.list.d/debian.sources or /etc/apt/sources.list"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$cpack" -G DEB --config "$build/CPackConfig.cmake" -B "$folder" >"$folder/log" 2>&1 || {
  cat "$folder/log" >&2
  fail "cpack"
}
programs=$(echo "$folder"/boresight_*.deb)
core=$(echo "$folder"/libboresight-core-dev_*.deb)

dpkg-deb -c "$core" | grep /cmake/Boresight/BoresightConfig.cmake >/dev/null ||
  fail "the core's package has no BoresightConfig.cmake"
dpkg-deb -f "$core" Depends | grep libeigen3-dev >/dev/null || fail "the core's package needs no Eigen"
for library in libvtk9 libqt5widgets5 libopencv-core libassimp libgdal libsqlite3-0; do
  dpkg-deb -f "$programs" Depends | grep "$library" >/dev/null || fail "the package does not need $library"
done
dpkg-deb -x "$programs" "$folder/files"
[ -e "$folder/files/usr/share/man/man1/whs-localize.1.gz" ] || fail "manual pages are not compressed"
# As Debian's own checker wants them: the licence, the changelog, permissions, and all else.
if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs \
    "$programs" "$core" || fail "lintian"
fi
for program in whs boresight; do
  if grep -qF "$source" "$folder/files/usr/bin/$program"; then
    fail "$program names the tree that it was built in"
  fi
  if readelf -d "$folder/files/usr/bin/$program" | grep -E 'RPATH|RUNPATH'; then
    fail "$program looks for libraries elsewhere than the system does"
  fi
done

cp "$programs" "$folder/boresight.deb"
if ! mmdebstrap --quiet --variant=apt --format=null \
  --customize-hook="copy-in '$folder/boresight.deb' '$source/tests/package/installed_programs.sh' /tmp" \
  --customize-hook='chroot "$1" bash /tmp/installed_programs.sh && touch "$1/tmp/passed"' \
  --customize-hook="copy-out /tmp/passed '$folder'" \
  "$release" - "$sources" >"$folder/log" 2>&1; then
  cat "$folder/log" >&2
  if grep -q '^used the installed programs' "$folder/log"; then fail "an installed program"; fi
  if grep -q '^installed the package' "$folder/log"; then fail "what is installed"; fi
  if grep -q '^installing the package' "$folder/log"; then fail "the package cannot be installed"; fi
  skip "no new Debian can be made here; mmdebstrap says why above"
fi
[ -e "$folder/passed" ] || fail "the installed programs were not used to the end"
grep -E '^(passed|FAILED|[0-9]+ passed|boresight [0-9]|whs [0-9])' "$folder/log"
