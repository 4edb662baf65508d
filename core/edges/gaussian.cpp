// SPDX-License-Identifier: Apache-2.0
#include "core/edges/gaussian.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/edges/border.h"

namespace boresight {
namespace {

constexpr int kMargin = 32;  ///< columns on both sides of a row that the widest kernel may read
static_assert(kMargin >= kMaxGaussianRadius + 1);

/// Nearest integer of a non-negative value, halves to even.
int roundHalfEven(double value) {
  const int below = static_cast<int>(value);
  const double fraction = value - below;
  if (fraction > 0.5 || (fraction == 0.5 && (below & 1) != 0)) return below + 1;
  return below;
}

/// Column sums of one block, at most 256 * 255, split into bytes: rows above[k] and below[k] are k
/// rows from the centre. Taps go in pairs; the one past the radius has no weight.
void sumBlock(const GaussianKernel& kernel, const std::uint8_t* const* above,
              const std::uint8_t* const* below, int x, std::uint16_t* __restrict high,
              std::uint16_t* __restrict low) {
  std::uint16_t sum[kRowBlock];
  {
    const std::uint8_t* centre = above[0] + x;
    const std::uint8_t* a = above[1] + x;
    const std::uint8_t* b = below[1] + x;
    const std::uint16_t w0 = kernel.weight[0];
    const std::uint16_t w1 = kernel.weight[1];
    for (int i = 0; i < kRowBlock; ++i)
      sum[i] = static_cast<std::uint16_t>(w0 * centre[i] + w1 * (a[i] + b[i]));
  }
  for (int tap = 2; tap <= kernel.radius; tap += 2) {
    const std::uint8_t* a = above[tap] + x;
    const std::uint8_t* b = below[tap] + x;
    const std::uint8_t* c = above[tap + 1] + x;
    const std::uint8_t* d = below[tap + 1] + x;
    const std::uint16_t w0 = nth(kernel.weight, tap);
    const std::uint16_t w1 = kernel.weight[static_cast<std::size_t>(tap) + 1];
    for (int i = 0; i < kRowBlock; ++i)
      sum[i] = static_cast<std::uint16_t>(sum[i] + w0 * (a[i] + b[i]) + w1 * (c[i] + d[i]));
  }
  for (int i = 0; i < kRowBlock; ++i) {
    high[i] = static_cast<std::uint16_t>(sum[i] >> 8);
    low[i] = static_cast<std::uint16_t>(sum[i] & 0xFF);
  }
}

/// Radius of the default sigma. With a fixed number of taps, sums stay in registers.
constexpr int kUsualRadius = 5;

/// sumBlock() for this radius.
[[gnu::noinline]] void sumUsualBlock(const GaussianKernel& kernel, const std::uint8_t* const* above,
                                     const std::uint8_t* const* below, int x,
                                     std::uint16_t* __restrict high,
                                     std::uint16_t* __restrict low) {
  const std::uint8_t* a[kUsualRadius + 1];
  const std::uint8_t* b[kUsualRadius + 1];
  std::uint16_t weight[kUsualRadius + 1];
  for (int k = 0; k <= kUsualRadius; ++k) {
    a[k] = above[k] + x;
    b[k] = below[k] + x;
    weight[k] = nth(kernel.weight, k);
  }
  for (int i = 0; i < kRowBlock; ++i) {
    auto sum = static_cast<std::uint16_t>(weight[0] * a[0][i]);
    for (int k = 1; k <= kUsualRadius; ++k)
      sum = static_cast<std::uint16_t>(sum + weight[k] * (a[k][i] + b[k][i]));
    high[i] = static_cast<std::uint16_t>(sum >> 8);
    low[i] = static_cast<std::uint16_t>(sum & 0xFF);
  }
}

/// sumAlongRow() for this radius.
[[gnu::noinline]] void sumAlongUsualRow(const GaussianKernel& kernel, const std::uint16_t* row,
                                        std::uint16_t* __restrict sum) {
  std::uint16_t weight[kUsualRadius + 1];
  for (int k = 0; k <= kUsualRadius; ++k) weight[k] = nth(kernel.weight, k);
  for (int i = 0; i < kRowBlock; ++i) {
    auto at = static_cast<std::uint16_t>(weight[0] * row[i]);
    for (int k = 1; k <= kUsualRadius; ++k)
      at = static_cast<std::uint16_t>(at + weight[k] * (row[i - k] + row[i + k]));
    sum[i] = at;
  }
}

/// The same along a row of 16-bit values in [0, 255], `row` at the first centre.
void sumAlongRow(const GaussianKernel& kernel, const std::uint16_t* row,
                 std::uint16_t* __restrict sum) {
  {
    const std::uint16_t* a = row - 1;
    const std::uint16_t* b = row + 1;
    const std::uint16_t w0 = kernel.weight[0];
    const std::uint16_t w1 = kernel.weight[1];
    for (int i = 0; i < kRowBlock; ++i)
      sum[i] = static_cast<std::uint16_t>(w0 * row[i] + w1 * (a[i] + b[i]));
  }
  for (int tap = 2; tap <= kernel.radius; tap += 2) {
    const std::uint16_t* a = row - tap;
    const std::uint16_t* b = row + tap;
    const std::uint16_t* c = a - 1;
    const std::uint16_t* d = b + 1;
    const std::uint16_t w0 = nth(kernel.weight, tap);
    const std::uint16_t w1 = kernel.weight[static_cast<std::size_t>(tap) + 1];
    for (int i = 0; i < kRowBlock; ++i)
      sum[i] = static_cast<std::uint16_t>(sum[i] + w0 * (a[i] + b[i]) + w1 * (c[i] + d[i]));
  }
}

/// (256 * high + low + 2^15) / 2^16 without leaving 16 bits: the whole is at most 255 * 2^16, so
/// high + 1 stays below 2^16.
void roundBlock(const std::uint16_t* high, const std::uint16_t* low, std::uint8_t* __restrict out) {
  for (int i = 0; i < kRowBlock; ++i) {
    const std::uint16_t carry = static_cast<std::uint16_t>(((low[i] >> 1) + 0x4000) >> 7);
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(high[i] + carry) >> 8);
  }
}

}  // namespace

GaussianKernel gaussianKernel(double sigma_px) {
  GaussianKernel kernel;
  kernel.weight[0] = 256;
  if (!(sigma_px > 0.0)) return kernel;
  kernel.radius = std::min(roundHalfEven(sigma_px * 6.0 + 1.0) / 2, kMaxGaussianRadius);
  std::array<double, kMaxGaussianRadius + 1> value{};
  double sum = 0.0;
  for (int i = kernel.radius; i > 0; --i) {
    nth(value, i) = exp(-0.5 * static_cast<double>(i * i) / (sigma_px * sigma_px));
    sum += nth(value, i);
  }
  sum = 2.0 * sum + 1.0;
  double error = 0.0;
  int outside = 0;
  for (int i = kernel.radius; i > 0; --i) {
    const double wanted = nth(value, i) / sum * 256.0 + error;
    const int weight = roundHalfEven(std::max(wanted, 0.0));
    error = wanted - weight;
    nth(kernel.weight, i) = static_cast<std::uint16_t>(weight);
    outside += weight;
  }
  kernel.weight[0] = static_cast<std::uint16_t>(256 - 2 * outside);
  return kernel;
}

void SmoothedRows::begin(int width, int height, double sigma_px, Arena& arena) {
  *this = SmoothedRows();
  kernel_ = gaussianKernel(sigma_px);
  width_ = width;
  height_ = height;
  if (kernel_.radius == 0) return;
  const std::size_t columns = static_cast<std::size_t>(roundUpToBlock(width));
  ring_rows_ = 2 * kernel_.radius + 1;
  ring_stride_ = static_cast<std::ptrdiff_t>(columns);
  ring_ = arena.allocate<std::uint8_t>(columns * static_cast<std::size_t>(ring_rows_));
  high_ = arena.allocate<std::uint16_t>(columns + 2 * std::size_t{kMargin});
  low_ = arena.allocate<std::uint16_t>(columns + 2 * std::size_t{kMargin});
}

void SmoothedRows::row(int y, const Equalizer& source, std::uint8_t* out) {
  if (kernel_.radius == 0) {
    source.row(y, out);
    return;
  }
  for (; loaded_ <= std::min(y + kernel_.radius, height_ - 1); ++loaded_)
    source.row(loaded_, slot(loaded_));
  sumColumns(y);
  mirrorSides();
  const auto sum = kernel_.radius == kUsualRadius ? sumAlongUsualRow : sumAlongRow;
  for (int x = 0; x < width_; x += kRowBlock) {
    std::uint16_t high[kRowBlock];
    std::uint16_t low[kRowBlock];
    sum(kernel_, high_.data() + kMargin + x, high);
    sum(kernel_, low_.data() + kMargin + x, low);
    roundBlock(high, low, out + x);
  }
}

void SmoothedRows::sumColumns(int y) {
  std::array<const std::uint8_t*, kMaxGaussianRadius + 2> above{};
  std::array<const std::uint8_t*, kMaxGaussianRadius + 2> below{};
  for (int k = 0; k <= kernel_.radius + 1; ++k) {
    const int distance = std::min(k, kernel_.radius);
    nth(above, k) = slot(reflect101(y - distance, height_));
    nth(below, k) = slot(reflect101(y + distance, height_));
  }
  const auto sum = kernel_.radius == kUsualRadius ? sumUsualBlock : sumBlock;
  for (int x = 0; x < width_; x += kRowBlock)
    sum(kernel_, above.data(), below.data(), x, high_.data() + kMargin + x,
        low_.data() + kMargin + x);
}

/// All columns are summed in the same way, so mirroring the sums equals mirroring the pixels.
void SmoothedRows::mirrorSides() {
  std::uint16_t* high = high_.data() + kMargin;
  std::uint16_t* low = low_.data() + kMargin;
  for (int k = 1; k <= kernel_.radius; ++k) {
    const int left = reflect101(-k, width_);
    const int right = reflect101(width_ - 1 + k, width_);
    high[-k] = high[left];
    low[-k] = low[left];
    high[width_ - 1 + k] = high[right];
    low[width_ - 1 + k] = low[right];
  }
}

}  // namespace boresight
