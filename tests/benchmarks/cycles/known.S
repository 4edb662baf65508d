# SPDX-License-Identifier: Apache-2.0
# Loops whose cycles an instruction the user's manual of the PowerPC 750 gives. `cycles.sh --check`
# runs them: 100 times 60 instructions each.
.macro kernel name, first, second
  .globl \name
\name:
  li 5, 100
  mtctr 5
1:
  .rept 30
  \first
  \second
  .endr
  bdnz 1b
  blr
.endm

.text
# Latency 1 cycle; two units.
kernel dependent_additions, "add 3, 3, 4", "add 3, 3, 4"
kernel independent_additions, "add 3, 6, 4", "add 7, 6, 4"
# 19 cycles.
kernel divisions, "divw 3, 6, 4", "divw 7, 6, 4"
# Latency 4 cycles; every 2 cycles.
kernel dependent_float_products, "fmul 1, 1, 2", "fmul 1, 1, 2"
kernel independent_float_products, "fmul 1, 3, 2", "fmul 4, 3, 2"
# Latency 3 cycles.
kernel dependent_float_sums, "fadd 1, 1, 2", "fadd 1, 1, 2"
# 31 cycles.
kernel float_divisions, "fdiv 1, 3, 2", "fdiv 4, 3, 2"
# Latency 2 cycles: the word at `self` is its own address; one load a cycle.
kernel dependent_loads, "lwz 8, 0(8)", "lwz 8, 0(8)"
kernel independent_loads, "lwz 3, 0(8)", "lwz 6, 0(8)"
# The load waits until the store has left its queue.
kernel stored_loads, "stw 3, 0(8)", "lwz 3, 0(8)"
# Each load reads another line of memory: 6000 misses.
kernel missing_loads, "lwzu 3, 32(9)", "lwzu 6, 32(9)"

.globl _start
_start:
  li 4, 3
  lis 8, self@ha
  addi 8, 8, self@l
  lis 9, block@ha
  addi 9, 9, block@l
  bl dependent_additions
  bl independent_additions
  bl divisions
  bl dependent_float_products
  bl independent_float_products
  bl dependent_float_sums
  bl float_divisions
  bl dependent_loads
  bl independent_loads
  bl missing_loads
  bl stored_loads
  li 0, 1
  li 3, 0
  sc

.data
.balign 32
self: .long self
.bss
.balign 32
block: .skip 6001 * 32
