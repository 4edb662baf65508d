// SPDX-License-Identifier: Apache-2.0
#include "tests/core/pnp/heap_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<int> allocations{0};

}  // namespace

// The replacements of the whole program; in a file of their own, so that no inlining shows a
// compiler one half of a pair.
void* operator new(std::size_t size) {
  ++allocations;
  void* block = std::malloc(size > 0 ? size : 1);
  if (block == nullptr) std::abort();
  return block;
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace boresight::test {

int heapAllocations() { return allocations; }

}  // namespace boresight::test
