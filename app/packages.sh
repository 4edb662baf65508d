# SPDX-License-Identifier: Apache-2.0
# Sourced by app/run.sh and tests/run.sh: the Debian packages that Boresight is built from.

boresight_packages=(
  build-essential cmake ninja-build ccache
  libeigen3-dev libopencv-dev libassimp-dev libgdal-dev nlohmann-json3-dev libsqlite3-dev libceres-dev libcli11-dev
  libspdlog-dev libavutil-dev libminizip-dev zlib1g-dev pkg-config libcairo2-dev libpango1.0-dev fonts-dejavu-core
  libgtest-dev libgmock-dev libbenchmark-dev
  qtbase5-dev libvtk9-dev libvtk9-qt-dev libqwt-qt5-dev xvfb xauth libgl1-mesa-dri
  help2man pybind11-dev python3-dev python3-numpy
)

# Another compiler, and an emulator for what it makes: the tests that need them are skipped, visibly,
# where they are not.
boresight_optional_packages=(g++-powerpc-linux-gnu qemu-user poppler-utils doxygen
  openssh-client python3-matplotlib)

# missingPackages PACKAGE...: those that are not installed, one a line.
missingPackages() {
  local package
  for package in "$@"; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      echo "$package"
    fi
  done
}

# installMissing PACKAGE...: asks the package manager for nothing when all is there.
installMissing() {
  local missing
  mapfile -t missing < <(missingPackages "$@")
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

installPackages() {
  installMissing "${boresight_packages[@]}"
}

# What tests need beyond the build, where it can be had.
installOptionalPackages() {
  installMissing "${boresight_optional_packages[@]}" ||
    echo "going on without; the tests that need these packages will be skipped" >&2
}

# configureAndBuild PRESET [TARGET]: configures once, builds what has changed of the preset's targets.
configureAndBuild() {
  cmake --preset "$1" --log-level=WARNING
  cmake --build --preset "$1" ${2:+--target "$2"} --parallel "$(nproc)"
}
