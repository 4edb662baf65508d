#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: core_documentation.sh FOLDER
# Builds the reference of core by the Doxyfile in FOLDER. Every warning is an error: an undocumented
# public symbol, or a description of a missing one.
set -euo pipefail
command -v doxygen >/dev/null || { echo "SKIPPED: no doxygen (apt-get install doxygen)"; exit 77; }
cd "$1"
rm -rf html
doxygen Doxyfile
grep -q Localizer html/annotated.html || { echo "the reference lists no Localizer"; exit 1; }
