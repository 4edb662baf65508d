// SPDX-License-Identifier: Apache-2.0
// Blind annotation rounds of several annotators over one image.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sessions/annotation/annotations.h"

namespace boresight::sessions {

/// Final annotations of one round; kept next to the current annotations.
struct AnnotationRound {
  std::string by;    ///< who, not empty
  std::string time;  ///< UTC, when it was put aside
  Annotations annotations;

  bool operator==(const AnnotationRound&) const = default;
};
using AnnotationRounds = std::vector<AnnotationRound>;

/// The annotations that the next person begins with: the same ids and places of the station,
/// nothing of the image.
Annotations blindAnnotations(const Annotations& annotations);

/// Whether a blind round is under way: a round has a place in the image of an annotation whose
/// place the annotations at work lack.
bool isBlind(const AnnotationRounds& rounds, const Annotations& annotations);

/// The rounds with these annotations put aside as well, under a name of their own, unless nothing
/// of them is on the image or a round has the same: what another round is taken up over is not
/// lost.
AnnotationRounds keepingAnnotations(AnnotationRounds rounds, const Annotations& annotations,
                                    const std::string& time);

/// How far two rounds over one image differ in one annotation.
struct AnnotationDifference {
  std::string id;
  Eigen::Vector2d difference_px = Eigen::Vector2d::Zero();  ///< second minus first; of a line the
                                                            ///< distances of the ends across it
};

/// Differences between the annotations of two annotators.
struct Repeatability {
  std::vector<AnnotationDifference>
      annotations;  ///< of annotations that both have with both sides, by id
  /// Standard deviation of one person's one annotation per axis: rms of all differences / sqrt(2).
  double sigma_px = 0.0;
};
Repeatability repeatability(const Annotations& first, const Annotations& second);

}  // namespace boresight::sessions
