// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/accept/contour_evidence.h"
#include "core/accept/edge_support.h"
#include "core/accept/region_evidence.h"

namespace boresight {

/// Number of views in which a pose's contours are measured, and the object's size in each, px.
inline constexpr int kEvidenceViews = 2;
inline constexpr std::array<double, kEvidenceViews> kEvidenceSpan_px = {256.0, 420.0};

/// The image's evidence for a pose: contours in two small views, regions and edge support in the
/// image itself.
struct PoseEvidence {
  std::array<ContourEvidence, kEvidenceViews> contours;  ///< by view, the larger one last
  RegionEvidence region;                                 ///< of the outline's two sides
  double edge_support = 0.0;                             ///< EdgeSupport::share()

  /// Contours in the larger view.
  const ContourEvidence& finest() const { return contours.back(); }
  /// Mean over the views of the strongest kind of edges.
  double strongest_nats() const;
  /// Mean over the views of the weakest quadrant.
  double weakest_nats() const;
  /// Total evidence of the contours, nats: edge pixels of the larger view that share errors count
  /// once.
  double total_nats() const { return finest().total_nats() / kAlongEdge_px; }
  /// Score to compare poses of one image: scoreOf() its total evidence and edge support.
  double score() const;
  /// Probability that the pose is correct: logistic in the contours' share of their expectation, in
  /// the regions, and in the edge support over the expected evidence; fitted to correct and wrong
  /// poses (resources/evidence/trust.md).
  double probability() const;
};

/// Score to compare poses of the same images: asinh(T / 10) + log(max(s, 0.05)) / 2, with T the
/// total evidence, nats, and s the edge support, of one view or the sum and the mean of several.
/// Differences of scores are ratios of evidence, whatever the number of pixels; asinh, since a
/// half hidden pose may have no evidence in sum (resources/evidence/trust.md).
double scoreOf(double total_nats, double edge_support);

}  // namespace boresight
