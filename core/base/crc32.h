// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace boresight {

/// CRC-32 of ISO/IEC 15948 (PNG), zip and many others: detects damage, not tampering. `before` is
/// the CRC of the preceding bytes.
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

/// Incremental CRC-32.
class Crc32 {
 public:
  /// Appends bytes.
  void update(std::span<const std::uint8_t> bytes) { sum_ = crc32(bytes, sum_); }
  /// As update() with the value's bytes, most significant first.
  ///@{
  void updateBigEndian(std::uint8_t value);
  void updateBigEndian(std::uint32_t value);
  void updateBigEndian(std::uint64_t value) {
    updateBigEndian(static_cast<std::uint32_t>(value >> 32));
    updateBigEndian(static_cast<std::uint32_t>(value));
  }
  ///@}
  /// CRC-32 of all bytes so far.
  std::uint32_t value() const { return sum_; }

 private:
  std::uint32_t sum_ = 0;
};

}  // namespace boresight
