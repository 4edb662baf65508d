// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "sessions/annotation/geometry_meter.h"
#include "sessions/annotation/solve_annotations.h"

namespace boresight::sessions {

/// Writes the result of solving annotations for other programs: a JSON file, `format`
/// "boresight-solution", version 1.
///
///     {"format": "boresight-solution", "version": 1,
///      "solved": true, "robust": false, (without a pose: "reason" instead of the rest)
///      "rms_px": 0.2, "noise_factor": 0.9, "degrees_of_freedom": 14,
///      "rig_from_station": [[4x4]], "covariance": [[6x6]],
///      "views": [{"name": "left", "camera_from_rig": [[4x4]], "camera_from_station": [[4x4]],
///                 "covariance": [[6x6]], "sigma_mm": [x, y, z], "sigma_mrad": [x, y, z]}],
///      "annotations": [{"view": "left", "id": "p1", "kind": "point", "projected": true,
///                 "residual_px": [x, y], "residual_mm": [x, y], "normalized": 0.8, "weight": 1,
///                 "without": {"determined": true, "translation_mm": 0.1, "rotation_mrad": 0.2}}],
///      "ambiguous": {"rig_from_station": [[4x4]], "rms_px": 0.4},
///      "warnings": [{"kind": "coplanar", "prevents": false, "text": "..."}]}
///
/// Poses map metres, row by row. Covariances are of xi = (rotation rad, translation m), the left
/// perturbation in the frame of the rig or of the camera; sigmas are the roots of their diagonals.
/// Residuals are observed minus predicted; for a line, of both ends across the edge. `ambiguous` is
/// present only for an ambiguous plane. Kinds of warnings: too_few, few, collinear, coplanar,
/// clustered, one_depth, imprecise. Numbers read back as the same bits. OutputError.
void writeSolution(const std::filesystem::path& file, std::span<const AnnotatedView> views,
                   const AnnotationsResult& result, std::span<const LeftOut> left_out,
                   std::span<const GeometryWarning> warnings, bool robust);

/// A solution as text: one line per annotation (residuals in px and mm, how far the pose moves
/// without it), the warnings, the pose with one sigma (of several views the rig's and each
/// camera's), and the other pose of an ambiguous plane. `left_out`: one per annotation, from
/// leaveOneOut().
std::string solutionText(std::span<const AnnotatedView> views, const AnnotationsSolution& solution,
                         std::span<const LeftOut> left_out,
                         std::span<const GeometryWarning> warnings);

}  // namespace boresight::sessions
