// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/process_figures.h"

#include <malloc.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace boresight::test {
namespace {

std::int64_t entriesOf(const char* folder) {
  std::error_code error;
  const auto entries = std::filesystem::directory_iterator(folder, error);
  return error ? -1 : std::distance(begin(entries), end(entries));
}

std::int64_t residentBytes() {
  std::ifstream statistics("/proc/self/statm");
  std::int64_t whole_pages = 0;
  std::int64_t resident_pages = 0;
  if (!(statistics >> whole_pages >> resident_pages)) return -1;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

}  // namespace

ProcessFigures processFigures() {
  const struct mallinfo2 heap = mallinfo2();
  return {.resident_bytes = residentBytes(),
          .open_files = entriesOf("/proc/self/fd"),
          .threads = entriesOf("/proc/self/task"),
          .heap_bytes = static_cast<std::int64_t>(heap.uordblks + heap.hblkhd)};
}

}  // namespace boresight::test
