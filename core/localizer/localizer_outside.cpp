// SPDX-License-Identifier: Apache-2.0
// Matches that come from outside, in place of WHS.
#include <algorithm>
#include <cmath>

#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

/// A score as the counts of which whsScore makes it again: records, traces and views keep counts.
constexpr std::int32_t kScoreNorm = 1000000;

WhsCounts countsOf(double score) {
  const double clamped = score > 0.0 ? std::min(score, 2.0) : 0.0;  // NaN is 0
  return {static_cast<std::int32_t>(std::floor(clamped * kScoreNorm + 0.5)), 0};
}

bool isUsable(const SuppliedMatch& supplied, const Camera& camera) {
  return supplied.found && supplied.item.point_in_station_m.allFinite() && supplied.x >= -0.5 &&
         supplied.x <= camera.width - 0.5 && supplied.y >= -0.5 &&
         supplied.y <= camera.height - 0.5;
}

/// A place that views may look up in the render.
Template insideOf(const Camera& camera, Template item) {
  item.center_x = std::clamp(item.center_x, 0, camera.width - 1);
  item.center_y = std::clamp(item.center_y, 0, camera.height - 1);
  return item;
}

int nearestPixel(double place) { return static_cast<int>(std::floor(place + 0.5)); }

Match matchOf(const SuppliedMatch& supplied, const Camera& camera) {
  Match match;
  match.window = supplied.window;
  if (!isUsable(supplied, camera)) return match;
  match.norms = {kScoreNorm, 0};
  match.x = supplied.x;
  match.y = supplied.y;
  match.peak.x = nearestPixel(supplied.x);
  match.peak.y = nearestPixel(supplied.y);
  match.peak.counts = countsOf(supplied.score);
  match.peak.has_second = supplied.has_second;
  if (supplied.has_second) match.peak.second_counts = countsOf(supplied.second_score);
  match.searched = true;
  match.at_border = match.peak.x <= match.window.x_min || match.peak.x >= match.window.x_max ||
                    match.peak.y <= match.window.y_min || match.peak.y >= match.window.y_max;
  return match;
}

}  // namespace

void Localizer::matchOutside(const SurfaceRender& surfaces) {
  match_outside_ = true;
  surfaces_ = surfaces;
  digest_.tag("matches from outside");
}

bool Localizer::awaitsMatches() const {
  return match_outside_ && !supplied_ && status_ == Status::kOk && stage_ == Stage::kMatch &&
         !iteration_pending_ && !hypothesis_pending_;
}

Status Localizer::supplyMatches(std::span<const SuppliedMatch> supplied) {
  if (!awaitsMatches()) return Status::kInvalidOption;
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  if (supplied.size() > now.matches.matches.size()) return Status::kCapacityExceeded;
  for (std::size_t i = 0; i < supplied.size(); ++i) {
    now.templates.templates[i] = insideOf(now.render.camera, supplied[i].item);
    now.matches.matches[i] = matchOf(supplied[i], now.render.camera);
  }
  now.templates.count = static_cast<std::int32_t>(supplied.size());
  now.matches.count = now.templates.count;
  digestTemplates(now.templates, digest_);
  supplied_ = true;
  return Status::kOk;
}

}  // namespace boresight
