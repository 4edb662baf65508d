// SPDX-License-Identifier: Apache-2.0
// What several people marked in the same image without seeing each other's marks.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sessions/annotation/marks.h"

namespace boresight::sessions {

/// The marks that somebody ended with; kept beside the ones at work.
struct AnnotationRound {
  std::string by;    ///< who, not empty
  std::string time;  ///< UTC, when it was put aside
  Marks marks;

  bool operator==(const AnnotationRound&) const = default;
};
using AnnotationRounds = std::vector<AnnotationRound>;

/// The marks that the next person begins with: the same ids and places of the station, nothing of
/// the image.
Marks blindMarks(const Marks& marks);

/// The rounds with these marks put aside as well, under a name of their own, unless nothing of them
/// is on the image or a round has the same: what another round is taken up over is not lost.
AnnotationRounds keepingMarks(AnnotationRounds rounds, const Marks& marks, const std::string& time);

/// How far two rounds over one image differ in one mark.
struct MarkDifference {
  std::string id;
  Eigen::Vector2d difference_px = Eigen::Vector2d::Zero();  ///< second minus first; of a line the
                                                            ///< distances of the ends across it
};

/// Differences of two people's marks.
struct Repeatability {
  std::vector<MarkDifference> marks;  ///< of marks that both have with both sides, by id
  /// Standard deviation of one person's one mark per axis: rms of all differences / sqrt(2).
  double sigma_px = 0.0;
};
Repeatability repeatability(const Marks& first, const Marks& second);

}  // namespace boresight::sessions
