#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# core_example.sh BUILD SOURCE CMAKE GENERATOR COMPILER FLAGS: installs the core of a build, moves
# what was installed elsewhere, and builds and runs resources/core_example with it alone.
set -euo pipefail
build=$1 source=$2 cmake=$3 generator=$4 compiler=$5 flags=$6

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# quietly COMMAND...: its output only when it fails.
quietly() {
  "$@" >"$folder/log" 2>&1 || {
    cat "$folder/log" >&2
    echo "failed: $*" >&2
    exit 1
  }
}

quietly "$cmake" --install "$build" --component core --prefix "$folder/first"
mv "$folder/first" "$folder/moved"
cp -r "$source/resources/core_example" "$folder/project"

if grep -rlF -e "$source" -e "$folder/first" "$folder/moved" --include='*.cmake' --include='*.h'; then
  echo "these installed files name the tree that they were made from" >&2
  exit 1
fi
installed=$(cd "$folder/moved" && find . -type f | grep -vE '/include/boresight/core/.*\.h$|/cmake/Boresight/|/libboresight_core\.a$|/doc/libboresight-core-dev/(copyright|changelog\.gz)$' || true)
if [ -n "$installed" ]; then
  echo "installed with the core, and no part of it: $installed" >&2
  exit 1
fi

configure() {
  "$cmake" -S "$folder/project" -B "$folder/build" -G "$generator" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$folder/moved" \
    -DCMAKE_CXX_FLAGS="$flags -Wall -Wextra -Wshadow -Wconversion -Werror"
}
quietly configure
quietly "$cmake" --build "$folder/build"
"$folder/build/localize_boxes"

# Another minor version is another interface.
sed -i 's/find_package(Boresight 1.1/find_package(Boresight 1.0/' "$folder/project/CMakeLists.txt"
rm -rf "$folder/build"
if configure >"$folder/log" 2>&1; then
  echo "version 1.0 was asked for, and 1.1 accepted" >&2
  exit 1
fi
grep -q "compatible with requested version" "$folder/log" || {
  cat "$folder/log" >&2
  exit 1
}
