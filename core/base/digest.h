// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/base/crc32.h"
#include "core/base/sha256.h"

namespace boresight {

/// Canonical big-endian serialization into a hash (`Sum`). -0 counts as +0; a NaN is written as one
/// fixed pattern.
template <class Sum>
class ValueWriter {
 public:
  void u8(std::uint8_t value) { sum_.updateBigEndian(value); }    ///< Adds a value
  void u32(std::uint32_t value) { sum_.updateBigEndian(value); }  ///< Adds a value
  /// Adds a value.
  void i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }
  void u64(std::uint64_t value) { sum_.updateBigEndian(value); }  ///< Adds a value
  /// Adds a value.
  void f32(float value) {
    if (value != value) return u32(0x7fc00000u);
    u32(value == 0.0f ? 0u : std::bit_cast<std::uint32_t>(value));
  }
  /// Adds a value.
  void f64(double value) {
    if (value != value) return u64(std::uint64_t{0x7ff80000u} << 32);
    u64(value == 0.0 ? 0u : std::bit_cast<std::uint64_t>(value));
  }
  /// Adds bytes as they are.
  void bytes(std::span<const std::uint8_t> bytes) { sum_.update(bytes); }
  /// A section name, so that neighbouring fields cannot be confused: length, then the characters.
  void tag(const char* name) {
    const std::size_t length = std::strlen(name);
    u32(static_cast<std::uint32_t>(length));
    bytes({reinterpret_cast<const std::uint8_t*>(name), length});
  }

 protected:
  Sum sum_;  ///< of everything added so far
};

/// The SHA-256 of a run.
class DigestWriter : public ValueWriter<Sha256> {
 public:
  /// The SHA-256 of everything added so far.
  std::array<std::uint8_t, 32> digest() const { return sum_.digest(); }
};

/// The CRC-32 of large arrays, which enters a digest in their place: SHA-256 takes ten times as
/// long.
class ChecksumWriter : public ValueWriter<Crc32> {
 public:
  /// The CRC-32 of everything added so far.
  std::uint32_t checksum() const { return sum_.value(); }
};

/// 64 lower-case hexadecimal digits and a terminating zero.
std::array<char, 65> hexText(const std::array<std::uint8_t, 32>& digest);

}  // namespace boresight
