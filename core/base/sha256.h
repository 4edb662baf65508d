// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace boresight {

/// The eight words of the state.
using Sha256State = std::array<std::uint32_t, 8>;
/// Compresses `count` blocks of 64 bytes into the state (FIPS 180-4, Sec. 6.2.2).
using Sha256Kernel = void (*)(Sha256State& state, const std::uint8_t* blocks, std::size_t count);

/// Portable implementation as written in the standard; the reference for the other kernels.
void sha256Plain(Sha256State& state, const std::uint8_t* blocks, std::size_t count);
/// With the processor's own SHA instructions; nullptr where this processor has none.
Sha256Kernel sha256Instructions();
/// The fastest kernel that this processor can run.
Sha256Kernel fastestSha256();

/// Incremental SHA-256.
class Sha256 {
 public:
  /// The kernel changes the speed, not the result.
  explicit Sha256(Sha256Kernel kernel = fastestSha256());
  void update(std::span<const std::uint8_t> bytes);  ///< Appends bytes
  /// As update() with the value's bytes, most significant first.
  template <class Value>
  void updateBigEndian(Value value) {
    if (buffered_ + sizeof(Value) > buffer_.size()) flush();
    for (std::size_t i = 0; i < sizeof(Value); ++i) {
      buffer_[buffered_ + i] = static_cast<std::uint8_t>(value >> (8 * (sizeof(Value) - 1 - i)));
    }
    buffered_ += sizeof(Value);
  }
  /// The digest of all bytes so far; more bytes may follow.
  std::array<std::uint8_t, 32> digest() const;

 private:
  static constexpr std::size_t kBlock = 64;

  void flush();

  Sha256Kernel kernel_;
  Sha256State state_;
  std::array<std::uint8_t, 8 * kBlock> buffer_{};  ///< bytes not yet in the state
  std::size_t buffered_ = 0;
  std::uint64_t compressed_bytes_ = 0;
};

}  // namespace boresight
