// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/accept/pose_evidence.h"
#include "core/base/arena.h"
#include "core/render/edge_render.h"
#include "core/search/view_edges.h"

namespace boresight {

/// Request for a view in which a pose's contours are measured: the object has the same size for all
/// poses.
ViewSize evidenceViewSize(int view);

/// Replaces the meter's places by evenly spaced ones of a render in the view itself.
void takePlaces(const EdgeRender& render, ContourEvidenceMeter& meter);

/// Measures the contours of a pose that was rendered for the real camera, view by view, in bounded
/// slices.
class PoseEvidenceMeter {
 public:
  /// Takes the memory from `arena`, for images of up to `channels` channels. kArenaTooSmall.
  Status create(int channels, Arena& arena);
  /// The problem and the render must outlive the steps. False when the scene is outside the image.
  [[nodiscard]] bool begin(const SearchProblem& problem, const EdgeRender& render);
  /// One slice; true when contours() is complete.
  [[nodiscard]] bool step();
  /// The measured evidence, by view.
  const std::array<ContourEvidence, kEvidenceViews>& contours() const { return contours_; }

 private:
  bool beginView();
  void takePlacesOfRender();

  const SearchProblem* problem_ = nullptr;
  const EdgeRender* render_ = nullptr;
  ViewEdges view_edges_;
  ContourEvidenceMeter meter_;
  std::array<ContourEvidence, kEvidenceViews> contours_;
  int view_ = 0;
};

}  // namespace boresight
