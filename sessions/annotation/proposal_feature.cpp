// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/proposal_feature.h"

#include <algorithm>

#include "sessions/annotation/snap_choice.h"

namespace boresight::sessions {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kLeastRadius_px = 2.0;
constexpr double kMostRadius_px = 8.0;

}  // namespace

std::optional<Eigen::Vector2d> featureOf(const Proposal& proposal, const ImageView& image) {
  const double radius_px = std::clamp(kSigmas * proposal.sigma_px, kLeastRadius_px, kMostRadius_px);
  for (const ImageSnap& snap : imageSnaps(image, proposal.pixel, radius_px, 4.0 * radius_px))
    if (snap.kind != ImageSnapKind::kEdge) return snap.pixel;
  return std::nullopt;
}

}  // namespace boresight::sessions
