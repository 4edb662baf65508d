// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/edges/edge_map.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"
#include "core/localizer/schedule.h"

namespace boresight {

/// Checksums of the memory that does not change during a run: inputs, options, tables derived from
/// them, edges of the image. A bit that flips there may move the pose while the image still
/// supports it; the checksums are compared before a pose is accepted.
class MemorySeal {
 public:
  /// `inputs` is the inputDigest().
  void sealInputs(const std::array<std::uint8_t, 32>& inputs) { inputs_ = inputs; }
  /// Seals the tables laid out at construction.
  void sealTables(std::span<const std::byte> tables) { tables_ = checksumOf(tables); }
  /// Seals the edges of the matched levels.
  void sealEdges(const EdgeMap& edges, RunLevels levels) { edges_ = checksumOf(edges, levels); }

  /// Whether options and problem (withoutUnusedInputs) are those that were sealed.
  bool holdsInputs(const LocalizerOptions& options, const LocalizationProblem& problem) const;
  /// Whether the tables are those that were sealed.
  bool holdsTables(std::span<const std::byte> tables) const {
    return checksumOf(tables) == tables_;
  }
  /// Whether the edges are those that were sealed.
  bool holdsEdges(const EdgeMap& edges, RunLevels levels) const {
    return checksumOf(edges, levels) == edges_;
  }

 private:
  static std::uint32_t checksumOf(std::span<const std::byte> memory);
  static std::uint32_t checksumOf(const EdgeMap& edges, RunLevels levels);

  std::array<std::uint8_t, 32> inputs_{};
  std::uint32_t tables_ = 0;
  std::uint32_t edges_ = 0;
};

}  // namespace boresight
