#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: core_documentation.sh FOLDER
# Makes the core's reference by the Doxyfile in FOLDER. Every warning is an error: a public symbol
# that nobody has described, or a description of what is not there.
set -euo pipefail
command -v doxygen >/dev/null || { echo "SKIPPED: no doxygen (apt-get install doxygen)"; exit 77; }
cd "$1"
rm -rf html
doxygen Doxyfile
grep -q Localizer html/annotated.html || { echo "the reference lists no Localizer"; exit 1; }
