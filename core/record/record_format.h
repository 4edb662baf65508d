// SPDX-License-Identifier: Apache-2.0
// The onboard record: the downlink record of a run. FORMAT.md describes it byte by byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight {

inline constexpr std::array<std::uint8_t, 8> kRecordMagic = {'B', 'O', 'R', 'S',
                                                             'R', 'C', 'R', 'D'};
inline constexpr std::uint32_t kRecordVersion = 2;
inline constexpr std::size_t kRecordHeaderBytes = kRecordMagic.size() + 4;

/// Block types as four ASCII letters, in the order of the file.
enum class RecordBlock : std::uint32_t {
  kInputs = 0x494e5054,     ///< "INPT"
  kOptions = 0x4f505453,    ///< "OPTS"
  kEdges = 0x45444745,      ///< "EDGE"
  kIteration = 0x49544552,  ///< "ITER"
  kTemplates = 0x544d504c,  ///< "TMPL"
  kSupport = 0x53555050,    ///< "SUPP"
  kEnd = 0x454e4421,        ///< "END!"
};

/// Around a block's content: type, number, length before it, CRC-32 after it.
inline constexpr std::size_t kBlockHeadBytes = 12;
inline constexpr std::size_t kBlockBytes = kBlockHeadBytes + 4;

inline constexpr std::size_t kTemplateBytes = 21;
inline constexpr std::size_t kEndBytes = 270;

/// Bits of a template's flags.
struct TemplateFlags {
  /// The template's window was searched.
  static constexpr std::uint8_t kSearched = 1;
  /// The peak lies on the window's border.
  static constexpr std::uint8_t kAtBorder = 2;
  /// The match has a second place.
  static constexpr std::uint8_t kHasSecond = 4;
  /// The match agrees with the pose.
  static constexpr std::uint8_t kInlier = 8;
};

}  // namespace boresight
