// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/localizer/localizer_options.h"
#include "core/record/problem_bytes.h"

namespace boresight {

/// The options of a run as a table for uplink, big-endian:
///
///     "BORSPARM"  u32 version  u32 size of the whole in bytes
///     options, as in an encoded problem (writeOptions)
///     u32 CRC-32 of all before
inline constexpr std::uint32_t kParameterVersion = 1;

/// Whether the bytes begin with the magic of a table.
bool isParameterTable(std::span<const std::uint8_t> bytes);

/// Writes the table to `out` and returns the number of bytes needed. `out` may be empty; when it is
/// smaller than needed, its content is not valid.
std::size_t encodeParameters(const LocalizerOptions& options, std::span<std::uint8_t> out);

/// Reads the output of encodeParameters. Any bytes are allowed; after a fault `options` is as
/// before. kNotAProblem: no table; kVersion, kSize, kChecksum, kOption (of another program, or out
/// of range), kContent (bytes left over).
ProblemCheck decodeParameters(std::span<const std::uint8_t> bytes, LocalizerOptions& options);

}  // namespace boresight
