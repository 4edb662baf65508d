// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight::test {

/// What the operating system says that this process holds; -1 where it does not say.
struct ProcessFigures {
  std::int64_t resident_bytes = -1;
  std::int64_t open_files = -1;
  std::int64_t threads = -1;
  /// Handed out by the allocator and not given back; 0 under a sanitizer, which brings its own.
  std::int64_t heap_bytes = -1;
};

/// Of the process that calls, now.
ProcessFigures processFigures();

}  // namespace boresight::test
