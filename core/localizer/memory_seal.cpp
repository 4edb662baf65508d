// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/memory_seal.h"

#include "core/base/crc32.h"
#include "core/base/nth.h"
#include "core/localizer/run_digest.h"

namespace boresight {

bool MemorySeal::holdsInputs(const LocalizerOptions& options,
                             const LocalizationProblem& problem) const {
  return inputDigest(options, problem) == inputs_;
}

std::uint32_t MemorySeal::checksumOf(std::span<const std::byte> memory) {
  return crc32({reinterpret_cast<const std::uint8_t*>(memory.data()), memory.size()});
}

/// Other levels do not outlive the first render.
std::uint32_t MemorySeal::checksumOf(const EdgeMap& edges, RunLevels levels) {
  const std::array<std::uint32_t, 2> sums = {
      checksumOf(std::as_bytes(nth(edges.level, levels.fine).words)),
      checksumOf(std::as_bytes(nth(edges.level, levels.coarse).words))};
  return checksumOf(std::as_bytes(std::span(sums)));
}

}  // namespace boresight
