// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QString>

#include "sessions/io/dataset_file.h"
#include "ui/annotation/annotation_controller.h"

namespace boresight::ui {

/// A pose that the annotated one is compared with.
struct ComparedPose {
  QString name;
  Pose camera_from_station;
};

/// "Solved from 8 marks, 0.21 px rms.", or why there is no pose.
QString solutionHeadline(const AnnotationAnswer& answer, bool stale);

/// "Geometry: all in one plane, all at one depth.": what of the marks is weak, in a few words that
/// stand there before and after solving.
QString geometryMeterText(const AnnotationAnswer& answer);

/// Everything else that an annotator reads of a solution: what is weak in the marks, one sigma
/// against the requirement, the second pose of a plane beside the first, residuals per camera, and
/// how far the other poses (seed, run, truth) and rounds are. Colour never says anything alone.
QString solutionHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others);

}  // namespace boresight::ui
