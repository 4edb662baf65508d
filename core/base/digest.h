// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace boresight {

/// SHA-256 (FIPS 180-4), fed piece by piece.
class Sha256 {
 public:
  Sha256();
  void update(std::span<const std::uint8_t> bytes);
  /// The digest of all that was fed so far; the object may be fed further.
  std::array<std::uint8_t, 32> digest() const;

 private:
  void compress(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_{};
  std::array<std::uint8_t, 64> buffer_{};
  std::size_t buffered_ = 0;
  std::uint64_t length_bytes_ = 0;
};

/// Canonical big-endian serialization into a SHA-256: what the digest of a run is made of.
/// -0 counts as +0; a NaN is written as one fixed pattern.
class DigestWriter {
 public:
  void u8(std::uint8_t value);
  void u32(std::uint32_t value);
  void i32(std::int32_t value);
  void u64(std::uint64_t value);
  void f32(float value);
  void f64(double value);
  void bytes(std::span<const std::uint8_t> bytes);
  /// A section name, so that neighbouring fields cannot be confused: length, then the characters.
  void tag(const char* name);

  std::array<std::uint8_t, 32> digest() const { return sha_.digest(); }

 private:
  Sha256 sha_;
};

/// 64 lower-case hexadecimal digits and a terminating zero.
std::array<char, 65> hexText(const std::array<std::uint8_t, 32>& digest);

}  // namespace boresight
