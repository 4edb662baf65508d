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

/// The names of FIPS 180-4, Sec. 4.1.2. Sums of rotations are nested: the inner sum
/// is rotated again, to the same bits.
std::uint32_t bigSigma0(std::uint32_t x) {
  return std::rotr(x ^ std::rotr(x ^ std::rotr(x, 9), 11), 2);
}
std::uint32_t bigSigma1(std::uint32_t x) {
  return std::rotr(x ^ std::rotr(x ^ std::rotr(x, 14), 5), 6);
}
std::uint32_t smallSigma0(std::uint32_t x) { return std::rotr(x, 7) ^ std::rotr(x, 18) ^ (x >> 3); }
std::uint32_t smallSigma1(std::uint32_t x) {
  return std::rotr(x ^ std::rotr(x, 2), 17) ^ (x >> 10);
}

/// Saves an operation over the standard's own form and is equal to it bit by bit.
std::uint32_t choose(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return z ^ (x & (y ^ z));
}

/// A round whose new values replace d and h; `term` is the round's constant plus its word. The
/// majority of a, b and c is b unless b differs from both. `bc_differ` holds the bits in which b
/// and c differ; afterwards those in which a and b do, the next round's b and c.
inline void mix(std::uint32_t a, std::uint32_t b, std::uint32_t& d, std::uint32_t e,
                std::uint32_t f, std::uint32_t g, std::uint32_t& h, std::uint32_t& bc_differ,
                std::uint32_t term) {
  h += bigSigma1(e) + choose(e, f, g) + term;
  d += h;
  const std::uint32_t ab_differ = a ^ b;
  h += bigSigma0(a) + (b ^ (ab_differ & bc_differ));
  bc_differ = ab_differ;
}

/// The part of words 16 .. 31 that depends on words 0 .. 16 only, several at a time. Inlined, the
/// promise that the rows do not overlap gets lost, and with it the vector code.
[[gnu::noinline]] void addSigma0(const std::uint32_t* __restrict w, std::uint32_t* __restrict sum) {
  for (std::size_t i = 0; i < 16; ++i) sum[i] = w[i] + smallSigma0(w[i + 1]);
}

/// Words 16 .. 31 from words 0 .. 15.
void expand(std::uint32_t* w) {
  std::uint32_t old[16];
  addSigma0(w, old);
  for (std::size_t i = 0; i < 15; ++i) w[i + 16] = old[i] + w[i + 9] + smallSigma1(w[i + 14]);
  // Only the last word depends on the first new one.
  w[31] = w[15] + smallSigma0(w[16]) + w[24] + smallSigma1(w[29]);
}

}  // namespace

void sha256Plain(Sha256State& state, const std::uint8_t* blocks, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint8_t* block = blocks + 64 * n;
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 16; ++i) w[i] = bigEndian32(block + 4 * i);
    for (std::size_t i = 0; i < 48; i += 16) expand(&w[i]);
    for (std::size_t i = 0; i < 64; ++i) w[i] += kSha256Constants[i];
    // Eight rounds at a time: the names rotate instead of the values.
    Sha256State change = state;
    auto& [a, b, c, d, e, f, g, h] = change;
    std::uint32_t bc_differ = b ^ c;
    for (std::size_t i = 0; i < 64; i += 8) {
      const std::uint32_t* term = &w[i];
      mix(a, b, d, e, f, g, h, bc_differ, term[0]);
      mix(h, a, c, d, e, f, g, bc_differ, term[1]);
      mix(g, h, b, c, d, e, f, bc_differ, term[2]);
      mix(f, g, a, b, c, d, e, bc_differ, term[3]);
      mix(e, f, h, a, b, c, d, bc_differ, term[4]);
      mix(d, e, g, h, a, b, c, bc_differ, term[5]);
      mix(c, d, f, g, h, a, b, bc_differ, term[6]);
      mix(b, c, e, f, g, h, a, bc_differ, term[7]);
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
