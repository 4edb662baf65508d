// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/accept/contour_evidence.h"
#include "core/base/arena.h"
#include "core/render/edge_render.h"
#include "core/search/view_edges.h"

namespace boresight {

/// Size of the object in the views in which evidence is measured: the same for all poses.
inline constexpr double kEvidenceSpan_px = 256.0;
/// Request for the view in which a pose's evidence is measured.
ViewSize evidenceViewSize();

/// Adds evenly spaced places of a render in the view itself to the meter.
void addPlaces(const EdgeRender& render, ContourEvidenceMeter& meter);

/// Measures the evidence for a pose that was rendered for the real camera, in bounded slices.
class PoseEvidence {
 public:
  /// Takes the memory from `arena`, for images of up to `channels` channels. kArenaTooSmall.
  Status create(int channels, Arena& arena);
  /// The problem and the render must outlive the steps. False when the scene is outside the image.
  [[nodiscard]] bool begin(const SearchProblem& problem, const EdgeRender& render);
  /// One slice; true when evidence() is complete.
  [[nodiscard]] bool step();
  /// The measured evidence.
  const ContourEvidence& evidence() const { return evidence_; }

 private:
  void addPlacesOfRender();

  const EdgeRender* render_ = nullptr;
  ViewEdges view_edges_;
  ContourEvidenceMeter meter_;
  ContourEvidence evidence_;
};

}  // namespace boresight
