// SPDX-License-Identifier: Apache-2.0
#include "core/edges/canny.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "core/edges/border.h"

namespace boresight {
namespace {

constexpr int kTangentBits = 15;
constexpr std::int32_t kTangent22 = 13573;  ///< tan 22.5 deg * 2^15, rounded

/// One multiplication gathers eight bytes that are 0 or 1 into the uppermost byte, the first byte
/// in memory as the lowest bit; the factor depends on the order in which the machine reads bytes.
constexpr std::uint64_t kGatherLittleEndian = 0x0102040810204080U;
constexpr std::uint64_t kGatherBigEndian = 0x8040201008040201U;

constexpr bool gathers(std::uint64_t factor, bool first_byte_is_lowest) {
  for (std::uint64_t bits = 0; bits < 256; ++bits) {
    std::uint64_t bytes = 0;
    for (int i = 0; i < 8; ++i)
      bytes |= ((bits >> i) & 1U) << (first_byte_is_lowest ? 8 * i : 56 - 8 * i);
    if ((bytes * factor) >> 56 != bits) return false;
  }
  return true;
}
static_assert(gathers(kGatherLittleEndian, true) && gathers(kGatherBigEndian, false));

/// 64 bytes that are 0 or 1 to the bits of a word.
std::uint64_t packFlags(const std::uint8_t* flags) {
  constexpr std::uint64_t kGather =
      std::endian::native == std::endian::little ? kGatherLittleEndian : kGatherBigEndian;
  std::uint64_t word = 0;
  for (int i = 0; i < 64; i += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags + i, sizeof eight);
    word |= ((eight * kGather) >> 56) << i;
  }
  return word;
}

std::uint64_t exceeding(const std::int32_t* magnitude, std::int32_t limit) {
  std::uint8_t flags[kRowBlock];
  for (int i = 0; i < kRowBlock; ++i) flags[i] = magnitude[i] > limit ? 1 : 0;
  return packFlags(flags);
}

/// The rows around the one being suppressed.
struct Neighbourhood {
  const std::int32_t* above;
  const std::int32_t* at;
  const std::int32_t* below;
  const std::int16_t* dx;
  const std::int16_t* dy;
};

/// Written without branches: directions of edges in noise cannot be predicted.
bool isMaximum(const Neighbourhood& rows, int x) {
  const std::int32_t magnitude = rows.at[x];
  const std::int32_t absolute_x = std::abs(rows.dx[x]);
  const std::int32_t absolute_y = std::abs(rows.dy[x]) << kTangentBits;
  const std::int32_t tangent22 = absolute_x * kTangent22;
  const std::int32_t tangent67 = tangent22 + (absolute_x << (kTangentBits + 1));
  const bool along_x = absolute_y < tangent22;
  const bool along_y = absolute_y > tangent67;
  const bool diagonal = !along_x && !along_y;
  const int slope = (rows.dx[x] ^ rows.dy[x]) < 0 ? -1 : 1;
  const int offset = diagonal ? slope : static_cast<int>(along_x);
  const std::int32_t* before = along_x ? rows.at : rows.above;
  const std::int32_t* after = along_x ? rows.at : rows.below;
  return (magnitude > before[x - offset]) &
         (magnitude + static_cast<std::int32_t>(!diagonal) > after[x + offset]);
}

}  // namespace

CannyLimits cannyLimits(double low, double high) {
  low = std::min(low, 32767.0);
  high = std::min(high, 32767.0);
  return {static_cast<std::int32_t>(low * low), static_cast<std::int32_t>(high * high)};
}

void suppressRow(const GradientRows& gradient, int y, int width, const CannyLimits& limits,
                 std::uint64_t* candidates, std::uint64_t* strong) {
  const Neighbourhood rows = {gradient.magnitude(y - 1), gradient.magnitude(y),
                              gradient.magnitude(y + 1), gradient.dx(y), gradient.dy(y)};
  for (int first_x = 0; first_x < width; first_x += kRowBlock) {
    std::uint64_t kept = 0;
    for (std::uint64_t left = exceeding(rows.at + first_x, limits.low); left != 0;
         left &= left - 1) {
      const int bit = std::countr_zero(left);
      kept |= static_cast<std::uint64_t>(isMaximum(rows, first_x + bit)) << bit;
    }
    candidates[first_x >> 6] = kept;
    strong[first_x >> 6] = kept != 0 ? kept & exceeding(rows.at + first_x, limits.high) : 0;
  }
}

}  // namespace boresight
