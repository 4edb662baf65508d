#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The share of changes of the code that some test notices, by folder: mutate.py has the options.
set -euo pipefail
exec python3 "$(dirname "${BASH_SOURCE[0]}")/mutate.py" "$@"
