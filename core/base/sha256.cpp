// SPDX-License-Identifier: Apache-2.0
#include "core/base/sha256.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/base/sha256_constants.h"

namespace boresight {
namespace {

std::uint32_t bigEndian32(const std::uint8_t* bytes) {
  return (static_cast<std::uint32_t>(bytes[0]) << 24) |
         (static_cast<std::uint32_t>(bytes[1]) << 16) |
         (static_cast<std::uint32_t>(bytes[2]) << 8) | static_cast<std::uint32_t>(bytes[3]);
}

/// The names of FIPS 180-4, Sec. 4.1.2.
std::uint32_t bigSigma0(std::uint32_t x) {
  return std::rotr(x, 2) ^ std::rotr(x, 13) ^ std::rotr(x, 22);
}
std::uint32_t bigSigma1(std::uint32_t x) {
  return std::rotr(x, 6) ^ std::rotr(x, 11) ^ std::rotr(x, 25);
}
std::uint32_t smallSigma0(std::uint32_t x) { return std::rotr(x, 7) ^ std::rotr(x, 18) ^ (x >> 3); }
std::uint32_t smallSigma1(std::uint32_t x) {
  return std::rotr(x, 17) ^ std::rotr(x, 19) ^ (x >> 10);
}

/// Both save an operation over the standard's own form and are equal to it bit by bit.
std::uint32_t choose(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return z ^ (x & (y ^ z));
}
std::uint32_t majority(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return (x & y) | (z & (x | y));
}

/// A round whose new values replace d and h; `term` is the round's constant plus its word.
inline void mix(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t& d,
                std::uint32_t e, std::uint32_t f, std::uint32_t g, std::uint32_t& h,
                std::uint32_t term) {
  h += bigSigma1(e) + choose(e, f, g) + term;
  d += h;
  h += bigSigma0(a) + majority(a, b, c);
}

}  // namespace

void sha256Plain(Sha256State& state, const std::uint8_t* blocks, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint8_t* block = blocks + 64 * n;
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 16; ++i) w[i] = bigEndian32(block + 4 * i);
    for (std::size_t i = 16; i < 64; ++i) {
      w[i] = w[i - 16] + smallSigma0(w[i - 15]) + w[i - 7] + smallSigma1(w[i - 2]);
    }
    // Eight rounds at a time: the names rotate instead of the values.
    Sha256State change = state;
    auto& [a, b, c, d, e, f, g, h] = change;
    for (std::size_t i = 0; i < 64; i += 8) {
      const std::uint32_t* k = &kSha256Constants[i];
      const std::uint32_t* word = &w[i];
      mix(a, b, c, d, e, f, g, h, k[0] + word[0]);
      mix(h, a, b, c, d, e, f, g, k[1] + word[1]);
      mix(g, h, a, b, c, d, e, f, k[2] + word[2]);
      mix(f, g, h, a, b, c, d, e, k[3] + word[3]);
      mix(e, f, g, h, a, b, c, d, k[4] + word[4]);
      mix(d, e, f, g, h, a, b, c, k[5] + word[5]);
      mix(c, d, e, f, g, h, a, b, k[6] + word[6]);
      mix(b, c, d, e, f, g, h, a, k[7] + word[7]);
    }
    for (std::size_t i = 0; i < 8; ++i) state[i] += change[i];
  }
}

Sha256Kernel fastestSha256() {
  const Sha256Kernel instructions = sha256Instructions();
  return instructions != nullptr ? instructions : sha256Plain;
}

Sha256::Sha256(Sha256Kernel kernel)
    : kernel_(kernel), state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                              0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19} {}

/// Compresses the whole blocks of the buffer into the state.
void Sha256::flush() {
  const std::size_t whole = buffered_ / kBlock * kBlock;
  kernel_(state_, buffer_.data(), whole / kBlock);
  std::memmove(buffer_.data(), buffer_.data() + whole, buffered_ - whole);
  buffered_ -= whole;
  compressed_bytes_ += whole;
}

void Sha256::update(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (buffered_ == 0 && bytes.size() >= buffer_.size()) {
      const std::size_t blocks = bytes.size() / kBlock;
      kernel_(state_, bytes.data(), blocks);
      compressed_bytes_ += blocks * kBlock;
      bytes = bytes.subspan(blocks * kBlock);
      continue;
    }
    const std::size_t taken = std::min(buffer_.size() - buffered_, bytes.size());
    std::memcpy(buffer_.data() + buffered_, bytes.data(), taken);
    buffered_ += taken;
    bytes = bytes.subspan(taken);
    if (buffered_ == buffer_.size()) flush();
  }
}

std::array<std::uint8_t, 32> Sha256::digest() const {
  Sha256 last = *this;
  const std::uint64_t length_bits = (compressed_bytes_ + buffered_) * 8;
  // A one bit, zeros up to 8 bytes before the end of a block, and the length in bits.
  constexpr std::array<std::uint8_t, kBlock> kPadding = {0x80};
  const std::size_t over = buffered_ % kBlock;
  last.update(std::span(kPadding).first((over < 56 ? 56 : 56 + kBlock) - over));
  last.updateBigEndian(length_bits);
  last.flush();

  std::array<std::uint8_t, 32> result{};
  for (std::size_t i = 0; i < 32; ++i)
    result[i] = static_cast<std::uint8_t>(last.state_[i / 4] >> (8 * (3 - i % 4)));
  return result;
}

}  // namespace boresight
