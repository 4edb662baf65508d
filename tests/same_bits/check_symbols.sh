#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: check_symbols.sh PREFIX LIBRARY
# What the core needs from outside, and what a flight computer may not have to provide: heap,
# exceptions, RTTI, the mathematical library beyond sqrt and floor, code before main. PREFIX is that
# of the binutils (e.g. powerpc-linux-gnu-, or empty). Exit status 77: nothing there to be checked.
set -euo pipefail
prefix="$1" library="$2"

for needed in "$(command -v "${prefix}nm" || true)" "$library"; do
  if [ ! -e "$needed" ]; then
    echo "SKIPPED: ${prefix}nm or $library is not there"
    exit 77
  fi
done

# Memory and strings that compilers call by themselves, and the two roundings-free functions.
allowed='memcpy|memmove|memset|memcmp|bcmp|strlen|sqrt|floor'
# Arithmetic that the processor does not have: 64-bit integers, their conversion, counting of bits.
allowed+='|__(u?divdi3|u?moddi3|u?divmoddi4|muldi3|ashldi3|ashrdi3|lshrdi3|cmpdi2|ucmpdi2)'
allowed+='|__(float(un)?di[sd]f|fix(uns)?[sd]fdi|(clz|ctz|popcount|ffs|bswap)[sd]i2)'
# Position-independent code; register saving of PowerPC when optimized for size.
allowed+='|_GLOBAL_OFFSET_TABLE_|_(save|rest)gpr_[0-9]+(_x)?'

symbols="$("${prefix}nm" --format=posix "$library" | awk 'NF >= 2 && $1 !~ /:$/ {print $2, $1}')"
defined="$(awk '$1 != "U" && $1 != "w" && $1 != "v" {print $2}' <<<"$symbols" | sort -u)"
undefined="$(awk '$1 == "U" || $1 == "w" || $1 == "v" {print $2}' <<<"$symbols" | sort -u)"
[ -n "$defined" ] || { echo "$library defines nothing"; exit 1; }

faults=0
# report WHAT LINES: counts and prints what was found, if anything.
report() {
  [ -n "$2" ] || return 0
  echo "$library $1:"
  sed 's/^/    /' <<<"$2"
  faults=$((faults + 1))
}

report "needs from outside" \
  "$(comm -13 <(echo "$defined") <(echo "$undefined") | grep -Evx "$allowed" || true)"
report "has type information, virtual tables, exceptions or a heap of its own" \
  "$(grep -E '^(_ZT[ISV]|_Unwind|__cxa|__gxx|_Zn[wa]|_Zd[la])' <<<"$defined" || true)"
report "has code that runs before main, tables of exceptions or thread-local data" \
  "$("${prefix}objdump" --section-headers "$library" |
    grep -oE '\.(preinit_array|init_array|ctors|gcc_except_table|tdata|tbss)[^ ]*' | sort -u || true)"

echo "$library: $(wc -l <<<"$defined") symbols, needs: $(
  comm -13 <(echo "$defined") <(echo "$undefined") | tr '\n' ' ')"
[ "$faults" -eq 0 ]
