// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace boresight {

/// CRC-32 of ISO/IEC 15948 (PNG), zip and many others: detects damage, not tampering. `before` is
/// that of the bytes before these.
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace boresight
