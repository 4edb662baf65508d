// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/review/image_edges.h"
#include "sessions/review/predicted_edges.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {

/// How the image's edges are asked.
struct EvidenceSettings {
  double radius_px = 4.0;     ///< an edge is looked for so far along the normal
  double near_px = 1.5;       ///< and counts as the predicted one so near
  double least_slope = 1.5;   ///< gray/px
  double displaced_px = 4.0;  ///< of the fall-off, root of the mean square in the image
  std::size_t places = 6000;  ///< looked at, at most: they tell a share to a percent
};

/// Shares of what was asked, each with how much was asked.
struct Share {
  double part = 0.0;
  double whole = 0.0;

  double value() const { return whole > 0.0 ? part / whole : 0.0; }
};

/// A way in which the pose could be off, and how much less of the station is then seen.
struct FallOff {
  std::string direction;  ///< for people: "turned about the view axis"
  double coverage = 0.0;  ///< with the pose displaced this way, the mean of both senses
};

/// What the image's edges say of a pose, measured anew: with filters of their own, on the raw
/// image, from a render of the final pose.
struct EdgeEvidence {
  Share coverage;  ///< predicted length with the image's edge near, of what could be seen
  Share clutter;   ///< image edges on the station that no predicted edge explains
  std::vector<FallOff> fall_off;  ///< the six axes at the station, and the least determined way
};

/// One place and what was found there.
struct LookedPlace {
  EdgePlace place;
  std::optional<FoundEdge> found;
};

/// Places that can be looked at, in their order, with what the image shows across them.
std::vector<LookedPlace> lookAt(const ImageEdges& image, const std::vector<EdgePlace>& places,
                                const EvidenceSettings& settings);
Share coverageOf(const std::vector<LookedPlace>& looked, double near_px);

/// That of the station at a pose, rendered anew. Nothing where no edge can be looked at.
Share coverageOfPose(const LoadedCase& loaded, const Pose& camera_from_station,
                     const EvidenceSettings& settings = {});

/// Edges of the image inside the silhouette that are at least half as steep as the predicted ones
/// that were seen, and of these the ones with no predicted edge of their direction within 2 px.
Share clutterOf(const ImageEdges& image, const PredictedEdges& edges,
                const std::vector<LookedPlace>& looked, const EvidenceSettings& settings);

/// The region in which a pose's edges are looked for, displaced ones as well.
ImageRegion regionOf(const PredictedEdges& edges, const EvidenceSettings& settings);

std::vector<FallOff> fallOffOf(const ImageEdges& image, const std::vector<EdgePlace>& places,
                               const Camera& camera, const Pose& camera_from_station,
                               const EvidenceSettings& settings);

}  // namespace boresight::sessions
