// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/status.h"
#include "core/edges/canny.h"
#include "core/edges/edge_options.h"
#include "core/edges/equalize.h"
#include "core/edges/gaussian.h"
#include "core/edges/gradient.h"
#include "core/edges/hysteresis.h"

namespace boresight {

/// Longest side of an image, so that every count and offset of this stage fits 32 bits.
inline constexpr int kMaxImageSide = 16384;

/// Pixels in one bounded slice of the stage.
inline constexpr std::int32_t kEdgeSlice = 1 << 19;

inline constexpr int kPyramidLevels = 4;  ///< full, half, quarter, eighth resolution

/// Edges of the test image: Canny at full resolution and, per further level, the OR over 2x2 pixels
/// of the level before. Pooling keeps edges that Canny at the coarse level loses.
struct EdgeMap {
  std::array<BitImage, kPyramidLevels> level;  ///< by pyramid level, 0 full resolution
  double low_threshold = 0.0;                  ///< as used, in the units of cv::Canny
  double high_threshold = 0.0;                 ///< as used
  std::int32_t edge_count = 0;                 ///< set pixels at full resolution
};

/// Equalization, Gaussian, Canny, ignore mask and pooling in bounded slices. Needs, in addition to
/// the output, scratch from the arena that is rewound when done. The equalized and smoothed images
/// are never held whole: rows pass through a small ring, twice when the thresholds are quantiles
/// (once to count the gradients, once to use them).
///
/// Ignored pixels count neither in the histogram of the equalization nor in that of the gradient,
/// and pixels within kIgnoreMargin_px of them (Chebyshev distance) are removed before hysteresis:
/// they are not edges and do not support weak neighbours.
class EdgeDetector {
 public:
  /// The lower threshold as a share of the upper one (quantile thresholds): Canny recommends
  /// between 1/3 and 1/2.
  static constexpr double kLowRatio = 0.4;
  /// Covers the pixels that the Sobel kernel and most of the default Gaussian mix with ignored
  /// ones.
  static constexpr int kIgnoreMargin_px = 3;

  /// `image` and `ignore` (may be nullptr; set bits are ignored; same size) must outlive the steps.
  /// Output and scratch are taken from `arena`, which must not be used otherwise until the map is
  /// complete; with a counting arena only sizes are counted (the image needs no pixels then).
  /// kInvalidOption for an option out of range; kInvalidImage for an empty or too large image,
  /// overlapping rows, or an ignore mask of another size; kArenaTooSmall. All leave the arena as it
  /// was.
  Status begin(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
               Arena& arena, EdgeMap& output) {
    return begin(image, ignore, options, arena, arena, {}, output);
  }
  /// Levels to keep.
  struct KeptLevels {
    int finest = 0;                     ///< finest level kept
    int coarsest = kPyramidLevels - 1;  ///< coarsest level kept
    /// Whether a level is kept.
    bool hold(int level) const { return level >= finest && level <= coarsest; }
  };
  /// As above, but levels outside `levels` come from `scratch`, before the detector's own scratch:
  /// they are valid until that memory is reused.
  Status begin(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
               Arena& kept, Arena& scratch, const KeptLevels& levels, EdgeMap& output);
  /// One bounded slice (about a million pixel operations); true when the map is complete.
  [[nodiscard]] bool step();

 private:
  enum class Stage : std::uint8_t {
    kEqualize,
    kCountGradients,
    kSuppress,
    kGrow,
    kPool,
    kDone,
  };

  void allocateScratch(const ImageView& image, Arena& arena);
  bool countGradients();
  bool suppress();
  bool pool();
  void chooseThresholds();
  void finish();

  Stage stage_ = Stage::kDone;
  EdgeOptions options_;
  const BitImage* ignore_ = nullptr;
  Arena* scratch_ = nullptr;
  std::size_t mark_ = 0;  ///< where the scratch begins
  EdgeMap* output_ = nullptr;
  int row_ = 0;         ///< next row of the stage
  int pool_level_ = 0;  ///< being written
  CannyLimits limits_;
  Equalizer equalizer_;
  SmoothedRows smoothed_;
  GradientRows gradient_;
  GradientHistogram histogram_;
  Hysteresis hysteresis_;
  BitImage candidates_;
  std::span<std::uint64_t> near_ignored_;  ///< one row of the ignore mask, widened
};

/// Runs the whole stage.
Status detectEdges(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                   Arena& arena, EdgeMap& output);

}  // namespace boresight
