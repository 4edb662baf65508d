// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "core/match/bit_kernels.h"
#include "core/match/template_bits.h"
#include "core/match/whs.h"

namespace boresight {
namespace {

using kernels::Word1;
using BitCounters = kernels::Counters<Word1>;

constexpr int kBlockRows = 64;

/// Offset of the parabola's top through (-1, left), (0, middle), (1, right), within +-0.5; 0 where
/// it has none.
double parabolaTop(std::int64_t left, std::int64_t middle, std::int64_t right) {
  const std::int64_t curvature = left - 2 * middle + right;
  if (curvature >= 0) return 0.0;
  const double top = 0.5 * static_cast<double>(left - right) / static_cast<double>(curvature);
  return std::clamp(top, -0.5, 0.5);
}

/// The peak's place and its neighbours.
enum Place { kMiddle = 0, kLeft, kRight, kAbove, kBelow, kPlaces };

/// Rows of a block of the template, 64 columns wide, and of the test edges that it meets.
struct Block {
  int rows = 0;  ///< a multiple of four: empty rows are added
  Word1 edges[kBlockRows] = {}, mask[kBlockRows] = {};
  Word1 left[kBlockRows] = {}, right[kBlockRows] = {};
  Word1 here[kBlockRows + 2] = {};  ///< from one row above on

  const Word1* test(int place) const {
    switch (place) {
      case kLeft:
        return left;
      case kRight:
        return right;
      case kAbove:
        return here;
      case kBelow:
        return here + 2;
      default:
        return here + 1;
    }
  }
};

struct Intersection {
  const Word1* a;
  const Word1* b;
  Word1 operator()(int k) const { return a[k] & b[k]; }
};

void add(const Word1* a, const Word1* b, int rows, BitCounters& counters) {
  counters.addAll(Intersection{a, b}, rows);
}

std::int32_t sumOf(const BitCounters& counters, int plane_count) {
  std::int32_t sum = 0;
  counters.forEachPlane(plane_count,
                        [&sum](int k, const Word1& plane) { sum += countOnes(plane) << k; });
  return sum;
}

/// Hits and covered test edges of the five places, counted together: one reading of the template.
class CrossCounts {
 public:
  CrossCounts(const TemplateView& view, const BitImage& test_edges, int x, int y, bool beside,
              bool across)
      : view_(view), test_edges_(test_edges), x_(x), y_(y), beside_(beside), across_(across) {
    for (int row = 0; row < view.side_px; row += kBlockRows) {
      for (int word = 0; 64 * word < view.side_px; ++word) addBlock(row, word);
    }
    norms_.edges = sumOf(edges_, kCountPlanes);
    norms_.empties = sumOf(mask_, kCountPlanes) - norms_.edges;
  }

  std::int64_t comparable(Place place) const {
    const std::int32_t hits = sumOf(hits_[place], kCountPlanes);
    const std::int32_t covered = sumOf(covered_[place], kCountPlanes);
    return whsComparable({hits, norms_.empties - covered + hits}, norms_);
  }

 private:
  static constexpr int kCountPlanes = 13;  ///< 512 rows of eight words

  void addBlock(int row, int word) {
    Block block;
    read(row, word, block);
    add(block.edges, block.edges, block.rows, edges_);
    add(block.mask, block.mask, block.rows, mask_);
    for (int place = kMiddle; place < kPlaces; ++place) {
      add(block.edges, block.test(place), block.rows, hits_[place]);
      add(block.mask, block.test(place), block.rows, covered_[place]);
    }
  }
  void read(int row, int word, Block& block) const {
    const int rows = std::min(kBlockRows, view_.side_px - row);
    const int half = view_.side_px / 2;
    const int x = x_ - half + 64 * word, y = y_ - half + row;
    block.rows = (rows + 3) / 4 * 4;
    for (int k = 0; k < rows; ++k) {
      block.mask[k] = maskWord(view_, row + k, word);
      block.edges[k] = block.mask[k] & pixelsAt(*view_.edges, view_.center_x - half + 64 * word,
                                                view_.center_y - half + row + k);
      block.here[k + 1] = pixelsAt(test_edges_, x, y + k);
      if (!beside_) continue;
      block.left[k] = pixelsAt(test_edges_, x - 1, y + k);
      block.right[k] = pixelsAt(test_edges_, x + 1, y + k);
    }
    if (!across_) return;
    block.here[0] = pixelsAt(test_edges_, x, y - 1);
    block.here[rows + 1] = pixelsAt(test_edges_, x, y + rows);
  }

  const TemplateView& view_;
  const BitImage& test_edges_;
  int x_, y_;
  bool beside_, across_;
  WhsNorms norms_;
  BitCounters edges_{kCountPlanes}, mask_{kCountPlanes};
  BitCounters hits_[kPlaces] = {BitCounters(kCountPlanes), BitCounters(kCountPlanes),
                                BitCounters(kCountPlanes), BitCounters(kCountPlanes),
                                BitCounters(kCountPlanes)};
  BitCounters covered_[kPlaces] = {BitCounters(kCountPlanes), BitCounters(kCountPlanes),
                                   BitCounters(kCountPlanes), BitCounters(kCountPlanes),
                                   BitCounters(kCountPlanes)};
};

}  // namespace

void subpixelPeak(const TemplateView& view, const BitImage& test_edges, const WhsPeak& peak,
                  double& x, double& y) {
  x = peak.x;
  y = peak.y;
  if (!isValidTemplate(view) || !templateFits(view, test_edges, peak.x, peak.y)) return;
  const bool beside = templateFits(view, test_edges, peak.x - 1, peak.y) &&
                      templateFits(view, test_edges, peak.x + 1, peak.y);
  const bool across = templateFits(view, test_edges, peak.x, peak.y - 1) &&
                      templateFits(view, test_edges, peak.x, peak.y + 1);
  const CrossCounts counts(view, test_edges, peak.x, peak.y, beside, across);
  const std::int64_t middle = counts.comparable(kMiddle);
  if (beside) x += parabolaTop(counts.comparable(kLeft), middle, counts.comparable(kRight));
  if (across) y += parabolaTop(counts.comparable(kAbove), middle, counts.comparable(kBelow));
}

}  // namespace boresight
