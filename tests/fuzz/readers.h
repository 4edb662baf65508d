// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace boresight::test {

/// A reader of files from outside, and the name under which it is given one (readers go by
/// extensions). What it reads is thrown away.
struct FuzzedReader {
  std::string_view name;  ///< also of its folder of the corpus
  const char* file_name;
  void (*read)(const std::filesystem::path& file);
  void (*seal)(std::vector<std::uint8_t>& bytes) = nullptr;  ///< makes checksums right again
};

std::span<const FuzzedReader> fuzzedReaders();
/// nullptr where there is none of the name.
const FuzzedReader* fuzzedReader(std::string_view name);

/// Writes the bytes to a file in `folder` and has it read; with checksums made right once more. An
/// InputError is what a reader may say
/// to bad bytes; everything else goes through to the caller.
void feed(const FuzzedReader& reader, std::span<const std::uint8_t> bytes,
          const std::filesystem::path& folder);

}  // namespace boresight::test
