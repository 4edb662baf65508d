// SPDX-License-Identifier: Apache-2.0
#include "core/edges/edge_map.h"

#include <algorithm>

#include "core/base/nth.h"
#include "core/edges/bit_rows.h"

namespace boresight {
namespace {

/// `sizes_only` (a counting arena): the image may have no pixels yet.
Status checkInput(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                  bool sizes_only) {
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (image.width <= 0 || image.height <= 0 || image.width > kMaxImageSide ||
      image.height > kMaxImageSide)
    return Status::kInvalidImage;
  if (ignore != nullptr && (ignore->width != image.width || ignore->height != image.height))
    return Status::kInvalidImage;
  if (sizes_only) return Status::kOk;
  const bool overlap =
      image.height > 1 && image.stride < image.width && -image.stride < image.width;
  return image.data == nullptr || overlap ? Status::kInvalidImage : Status::kOk;
}

}  // namespace

Status EdgeDetector::begin(const ImageView& image, const BitImage* ignore,
                           const EdgeOptions& options, Arena& kept, Arena& scratch,
                           const KeptLevels& levels, EdgeMap& output) {
  *this = EdgeDetector();
  output = EdgeMap();
  if (const Status status = checkInput(image, ignore, options, kept.countsOnly());
      status != Status::kOk)
    return status;
  options_ = options;
  ignore_ = ignore;
  scratch_ = &scratch;
  output_ = &output;

  const std::size_t kept_start = kept.mark();
  const std::size_t scratch_start = scratch.mark();
  int width = image.width;
  int height = image.height;
  for (int level = 0; level < kPyramidLevels; ++level) {
    nth(output.level, level) = BitImage::create(levels.hold(level) ? kept : scratch, width, height);
    width = (width + 1) / 2;
    height = (height + 1) / 2;
  }
  mark_ = scratch.mark();
  equalizer_.begin(image, ignore, options, scratch);
  allocateScratch(image, scratch);
  if (kept.exhausted() || scratch.exhausted()) {
    kept.rewind(kept_start);
    scratch.rewind(scratch_start);
    output = EdgeMap();
    return Status::kArenaTooSmall;
  }
  if (kept.countsOnly()) {
    scratch.rewind(mark_);
  } else {
    stage_ = Stage::kEqualize;
  }
  return Status::kOk;
}

/// Depends only on the size and the options, so that counting needs neither image nor mask.
void EdgeDetector::allocateScratch(const ImageView& image, Arena& arena) {
  smoothed_.begin(image.width, image.height, options_.gaussian_sigma_px, arena);
  gradient_.begin(image.width, image.height, arena);
  if (options_.thresholds == CannyThresholds::kQuantile) histogram_.begin(arena);
  hysteresis_.begin(image.width, image.height, arena);
  candidates_ = BitImage::create(arena, image.width, image.height);
  near_ignored_ = arena.allocate<std::uint64_t>(BitImage::wordsPerRow(image.width));
}

bool EdgeDetector::step() {
  switch (stage_) {
    case Stage::kEqualize:
      if (!equalizer_.step(kEdgeSlice)) return false;
      stage_ = Stage::kCountGradients;
      if (options_.thresholds == CannyThresholds::kQuantile) return false;
      chooseThresholds();
      return false;
    case Stage::kCountGradients:
      if (countGradients()) chooseThresholds();
      return false;
    case Stage::kSuppress:
      if (suppress()) stage_ = Stage::kGrow;
      return false;
    case Stage::kGrow:
      if (hysteresis_.step(kEdgeSlice / 4, candidates_, output_->level[0])) stage_ = Stage::kPool;
      return false;
    case Stage::kPool:
      if (!pool()) return false;
      finish();
      return true;
    case Stage::kDone:
      return true;
  }
  return true;
}

bool EdgeDetector::countGradients() {
  const int width = equalizer_.width();
  const int height = equalizer_.height();
  for (std::int32_t budget = kEdgeSlice; row_ < height && budget > 0; ++row_, budget -= width) {
    gradient_.advance(equalizer_, smoothed_);
    histogram_.addRow(gradient_.magnitude(row_), ignore_ != nullptr ? ignore_->row(row_) : nullptr,
                      width);
  }
  return row_ == height;
}

void EdgeDetector::chooseThresholds() {
  double low = std::min(options_.low_threshold, options_.high_threshold);
  double high = std::max(options_.low_threshold, options_.high_threshold);
  if (options_.thresholds == CannyThresholds::kQuantile) {
    high = histogram_.quantile(options_.high_quantile);
    low = kLowRatio * high;
  }
  output_->low_threshold = low;
  output_->high_threshold = high;
  limits_ = cannyLimits(low, high);
  smoothed_.restart();
  gradient_.restart();
  row_ = 0;
  stage_ = Stage::kSuppress;
}

bool EdgeDetector::suppress() {
  const int width = equalizer_.width();
  const int height = equalizer_.height();
  BitImage& strong = output_->level[0];
  for (std::int32_t budget = kEdgeSlice; row_ < height && budget > 0; ++row_, budget -= width) {
    while (gradient_.rowsDone() < std::min(row_ + 2, height))
      gradient_.advance(equalizer_, smoothed_);
    suppressRow(gradient_, row_, width, limits_, candidates_.row(row_), strong.row(row_));
    if (ignore_ == nullptr) continue;
    dilateRow(*ignore_, row_, kIgnoreMargin_px, near_ignored_.data());
    for (std::size_t w = 0; w < near_ignored_.size(); ++w) {
      candidates_.row(row_)[w] &= ~near_ignored_[w];
      strong.row(row_)[w] &= ~near_ignored_[w];
    }
  }
  return row_ == height;
}

bool EdgeDetector::pool() {
  if (pool_level_ == 0) {
    pool_level_ = 1;
    row_ = 0;
  }
  const std::size_t index = static_cast<std::size_t>(pool_level_);
  const BitImage& fine = output_->level[index - 1];
  BitImage& coarse = output_->level[index];
  const int rows = kEdgeSlice / (8 * coarse.words_per_row);
  const int last_row = std::min(row_ + rows, coarse.height);
  poolRows(fine, row_, last_row, coarse);
  row_ = last_row;
  if (row_ < coarse.height) return false;
  row_ = 0;
  return ++pool_level_ == kPyramidLevels;
}

void EdgeDetector::finish() {
  output_->edge_count = countBits(output_->level[0]);
  scratch_->rewind(mark_);
  stage_ = Stage::kDone;
}

Status detectEdges(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                   Arena& arena, EdgeMap& output) {
  EdgeDetector detector;
  const Status status = detector.begin(image, ignore, options, arena, output);
  if (status != Status::kOk || arena.countsOnly()) return status;
  while (!detector.step()) {
  }
  return Status::kOk;
}

}  // namespace boresight
