# SPDX-License-Identifier: Apache-2.0
# Sourced by app/run.sh and tests/run.sh: the Debian packages that Boresight is built from.

boresight_packages=(
  build-essential cmake ninja-build ccache
  libeigen3-dev libopencv-dev libassimp-dev nlohmann-json3-dev libsqlite3-dev libcli11-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  qtbase5-dev libvtk9-dev libvtk9-qt-dev libqwt-qt5-dev xvfb xauth libgl1-mesa-dri
)

# Installs what is missing; asks the package manager for nothing when all is there.
installPackages() {
  local missing=() package
  for package in "${boresight_packages[@]}"; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      missing+=("$package")
    fi
  done
  [ "${#missing[@]}" -eq 0 ] && return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
      echo "missing packages: ${missing[*]}; install them as root, or install sudo" >&2
      return 1
    }
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}" >&2
  "${as_root[@]}" apt-get update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
    "${missing[@]}"
}

# configureAndBuild PRESET [TARGET]: configures once, builds what has changed.
configureAndBuild() {
  cmake --preset "$1" --log-level=WARNING
  cmake --build --preset "$1" --target "${2:-all}" --parallel "$(nproc)"
}
