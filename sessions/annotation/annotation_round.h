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
  std::string by;    ///< name of the annotator, not empty
  std::string time;  ///< UTC, end of the round
  Annotations annotations;

  bool operator==(const AnnotationRound&) const = default;
};
using AnnotationRounds = std::vector<AnnotationRound>;

/// Start of a blind round: the same ids and points of the station, without image positions.
Annotations blindAnnotations(const Annotations& annotations);

/// Whether a blind round is under way: a stored round has the image position of an annotation that
/// has none in `annotations`.
bool isBlind(const AnnotationRounds& rounds, const Annotations& annotations);

/// Adds these annotations as a separately named round, unless they have no image positions or equal
/// a stored round. Loading another round then loses nothing.
AnnotationRounds keepingAnnotations(AnnotationRounds rounds, const Annotations& annotations,
                                    const std::string& time);

/// Difference between two rounds of one image in one annotation.
struct AnnotationDifference {
  std::string id;
  Eigen::Vector2d difference_px = Eigen::Vector2d::Zero();  ///< second minus first; for a line, the
                                                            ///< distances of its ends across it
};

/// Differences between the annotations of two annotators.
struct Repeatability {
  std::vector<AnnotationDifference>
      annotations;  ///< of annotations that are complete in both, by id
  /// Standard deviation of a single annotation per axis: rms of all differences / sqrt(2).
  double sigma_px = 0.0;
};
Repeatability repeatability(const Annotations& first, const Annotations& second);

}  // namespace boresight::sessions
