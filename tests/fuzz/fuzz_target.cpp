// SPDX-License-Identifier: Apache-2.0
// One reader under libFuzzer: BORESIGHT_FUZZED names it.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/readers.h"
#include "tests/support/temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const boresight::test::FuzzedReader* reader =
      boresight::test::fuzzedReader(BORESIGHT_FUZZED);
  static const boresight::test::TemporaryFolder folder;
  if (reader == nullptr) {
    std::fprintf(stderr, "no reader of the name %s\n", BORESIGHT_FUZZED);
    std::abort();
  }
  boresight::test::feed(*reader, {data, size}, folder.path());
  return 0;
}
