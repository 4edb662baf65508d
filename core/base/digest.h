// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "core/base/sha256.h"

namespace boresight {

/// Canonical big-endian serialization into a SHA-256: the digest of a run.
/// -0 counts as +0; a NaN is written as one fixed pattern.
class DigestWriter {
 public:
  /// Adds a value.
  ///@{
  void u8(std::uint8_t value) { sha_.updateBigEndian(value); }
  void u32(std::uint32_t value) { sha_.updateBigEndian(value); }
  void i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }
  void u64(std::uint64_t value) { sha_.updateBigEndian(value); }
  void f32(float value) {
    if (value != value) return u32(0x7fc00000u);
    u32(value == 0.0f ? 0u : std::bit_cast<std::uint32_t>(value));
  }
  void f64(double value) {
    if (value != value) return u64(std::uint64_t{0x7ff80000u} << 32);
    u64(value == 0.0 ? 0u : std::bit_cast<std::uint64_t>(value));
  }
  void bytes(std::span<const std::uint8_t> bytes) { sha_.update(bytes); }
  ///@}
  /// A section name, so that neighbouring fields cannot be confused: length, then the characters.
  void tag(const char* name);

  /// The SHA-256 of everything added so far.
  std::array<std::uint8_t, 32> digest() const { return sha_.digest(); }

 private:
  Sha256 sha_;
};

/// 64 lower-case hexadecimal digits and a terminating zero.
std::array<char, 65> hexText(const std::array<std::uint8_t, 32>& digest);

}  // namespace boresight
