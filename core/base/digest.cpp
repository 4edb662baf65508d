// SPDX-License-Identifier: Apache-2.0
#include "core/base/digest.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace boresight {
namespace {

constexpr std::array<std::uint32_t, 64> kRoundConstants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t bigEndian32(const std::uint8_t* bytes) {
  return (static_cast<std::uint32_t>(bytes[0]) << 24) |
         (static_cast<std::uint32_t>(bytes[1]) << 16) |
         (static_cast<std::uint32_t>(bytes[2]) << 8) | static_cast<std::uint32_t>(bytes[3]);
}

/// The `count` low bytes of a value, most significant first.
void putBigEndian(std::uint64_t value, std::size_t count, std::uint8_t* bytes) {
  for (std::size_t i = 0; i < count; ++i)
    bytes[i] = static_cast<std::uint8_t>(value >> (8 * (count - 1 - i)));
}

}  // namespace

Sha256::Sha256()
    : state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
             0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19} {}

void Sha256::compress(const std::uint8_t* block) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t i = 0; i < 16; ++i) w[i] = bigEndian32(block + 4 * i);
  for (std::size_t i = 16; i < 64; ++i) {
    const std::uint32_t s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ (w[i - 15] >> 3);
    const std::uint32_t s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ (w[i - 2] >> 10);
    w[i] = w[i - 16] + s0 + w[i - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + kRoundConstants[i] + w[i];
    const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const std::array<std::uint32_t, 8> change = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state_[i] += change[i];
}

void Sha256::update(std::span<const std::uint8_t> bytes) {
  length_bytes_ += bytes.size();
  while (!bytes.empty()) {
    if (buffered_ == 0 && bytes.size() >= buffer_.size()) {
      compress(bytes.data());
      bytes = bytes.subspan(buffer_.size());
      continue;
    }
    const std::size_t taken = std::min(buffer_.size() - buffered_, bytes.size());
    std::memcpy(buffer_.data() + buffered_, bytes.data(), taken);
    buffered_ += taken;
    bytes = bytes.subspan(taken);
    if (buffered_ == buffer_.size()) {
      compress(buffer_.data());
      buffered_ = 0;
    }
  }
}

std::array<std::uint8_t, 32> Sha256::digest() const {
  Sha256 last = *this;
  // A one bit, zeros up to 8 bytes before the end of a block, and the length in bits.
  std::array<std::uint8_t, 72> padding = {0x80};
  const std::size_t zeros_end = (buffered_ < 56 ? 56 : 120) - buffered_;
  putBigEndian(length_bytes_ * 8, 8, padding.data() + zeros_end);
  last.update(std::span<const std::uint8_t>(padding).first(zeros_end + 8));

  std::array<std::uint8_t, 32> result{};
  for (std::size_t i = 0; i < 8; ++i) putBigEndian(last.state_[i], 4, result.data() + 4 * i);
  return result;
}

void DigestWriter::u8(std::uint8_t value) { sha_.update({&value, 1}); }

void DigestWriter::u32(std::uint32_t value) {
  std::array<std::uint8_t, 4> buffer{};
  putBigEndian(value, buffer.size(), buffer.data());
  sha_.update(buffer);
}

void DigestWriter::i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }

void DigestWriter::u64(std::uint64_t value) {
  std::array<std::uint8_t, 8> buffer{};
  putBigEndian(value, buffer.size(), buffer.data());
  sha_.update(buffer);
}

void DigestWriter::f32(float value) {
  if (value != value) return u32(0x7fc00000u);
  u32(value == 0.0f ? 0u : std::bit_cast<std::uint32_t>(value));
}

void DigestWriter::f64(double value) {
  if (value != value) return u64(std::uint64_t{0x7ff80000u} << 32);
  u64(value == 0.0 ? 0u : std::bit_cast<std::uint64_t>(value));
}

void DigestWriter::bytes(std::span<const std::uint8_t> bytes) { sha_.update(bytes); }

void DigestWriter::tag(const char* name) {
  const std::size_t length = std::strlen(name);
  u32(static_cast<std::uint32_t>(length));
  sha_.update({reinterpret_cast<const std::uint8_t*>(name), length});
}

std::array<char, 65> hexText(const std::array<std::uint8_t, 32>& digest) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::array<char, 65> text{};
  for (std::size_t i = 0; i < digest.size(); ++i) {
    text[2 * i] = kDigits[digest[i] >> 4];
    text[2 * i + 1] = kDigits[digest[i] & 15];
  }
  return text;
}

}  // namespace boresight
