#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# manual_pages.sh FOLDER PROGRAM: manual pages of section 1 of the program and of each of its
# commands, by help2man from what --help prints; the same program makes the same bytes.
set -euo pipefail
folder=$1 program=$2
name=$(basename "$program")
version=$("$program" --version | grep -o '[0-9][0-9.]*')
mkdir -p "$folder"

# page TITLE COMMAND SENTENCE
page() {
  help2man --no-info --section 1 --version-string "$version" --name "$3" "$2" |
    sed -e "s/^\.TH [^\"]*\"1\" \"[^\"]*\"/.TH ${1^^} \"1\" \"\"/" \
      -e "/^\.SH NAME/{n;s/^.* \\\\- /${1//-/\\\\-} \\\\- /}" >"$folder/$1.1"
}

page "$name" "$program" "localization of a camera relative to a known object"
[ "$name" = whs ] || exit 0
"$program" --complete "" | while read -r command; do
  page "$name-$command" "$program $command" "$("$program" "$command" --help | head -n 1)"
done
