// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_text.h"

#include <algorithm>

#include "core/base/math.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

/// `place` has the origin and the axes.
std::string sigmaText(const Matrix6d& covariance, const std::string& place) {
  const Vector6d sigma = 1e3 * covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return formatText(
      "1 sigma at the %s, along and about its x y z: %.4f %.4f %.4f mm, %.4f %.4f %.4f mrad\n",
      place.c_str(), sigma(3), sigma(4), sigma(5), sigma(0), sigma(1), sigma(2));
}

}  // namespace

std::string iterationTable(const LocalizationTrace& trace) {
  int number = 0;
  bool refined = false;
  TextTable table({"iteration", "attempt", "kind", "level", "templates", "matches", "inliers",
                   "threshold px", "correction mm", "deg", "rms px"});
  for (const auto& iteration : trace.iterations) {
    const bool refines = iteration->kind == IterationKind::kRefine;
    const RefinementTrace& refinement = iteration->refinement;
    refined |= refines;
    table.add({std::to_string(++number), std::to_string(iteration->attempt + 1),
               refines ? "refine" : "match", std::to_string(iteration->level),
               std::to_string(refines ? refinement.sample_count : iteration->template_count),
               std::to_string(refines ? refinement.found_count : iteration->searched_count),
               std::to_string(iteration->support()), fixedText(iteration->threshold_px, 1),
               fixedText(kMillimetres * iteration->correction_translation_m, 3),
               fixedText(iteration->correction_rotation_rad / kDegree_rad, 3),
               fixedText(iteration->rms_px(), 2)});
  }
  return table.text() +
         (refined
              ? "(refine: points along rendered edges, points with an image edge, points used)\n"
              : "");
}

std::string poseText(const Pose& pose, const Matrix6d& covariance, const std::string& name,
                     const std::string& place) {
  const Eigen::Vector3d rotation_deg = rotationLog(pose.rotation) / kDegree_rad;
  Eigen::Quaterniond q = pose.rotation;
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const Eigen::Matrix3d matrix = pose.matrix();
  std::string text = plainLine(name);
  for (int row = 0; row < 3; ++row)
    text += formatText("  %12.9f %12.9f %12.9f %12.9f\n", matrix(row, 0), matrix(row, 1),
                       matrix(row, 2), pose.translation_m[row]);
  text +=
      formatText("rotation vector %.5f %.5f %.5f deg; quaternion wxyz %.9f %.9f %.9f %.9f\n",
                 rotation_deg.x(), rotation_deg.y(), rotation_deg.z(), q.w(), q.x(), q.y(), q.z());
  const std::string usual = name.starts_with("rig") ? "rig's origin" : "camera";
  if (!covariance.isZero(0.0)) text += sigmaText(covariance, place.empty() ? usual : place);
  return text;
}

std::string memoryTable(const LocalizationTrace& trace) {
  const MemoryTrace& memory = trace.memory;
  TextTable table({"memory", "bytes", "high water"});
  const auto add = [&](const char* name, std::size_t bytes, std::size_t high_water) {
    table.add({name, std::to_string(bytes), std::to_string(high_water)});
  };
  const std::size_t lasting = memory.inputs + memory.use.kept;
  add("image, mask, mesh", memory.inputs, memory.inputs);
  add("kept throughout", memory.use.kept, lasting);
  add("construction", memory.use.construction, lasting + memory.use.construction);
  for (std::size_t i = 0; i < memory.use.stage.size(); ++i)
    add(stageText(static_cast<Stage>(i)), memory.use.stage[i], lasting + memory.use.stage[i]);
  return table.text() + "all: " + std::to_string(memory.total()) + " bytes" +
         (memory.limit > 0 ? " of " + std::to_string(memory.limit) : "") + "\n";
}

std::string iterationName(const LocalizationTrace& trace, int iteration) {
  const auto& all = trace.iterations;
  if (iteration < 0 || iteration >= static_cast<int>(all.size())) return "seed";
  const auto end = all.begin() + iteration + 1;
  const int attempt = (*(end - 1))->attempt;
  const auto number = std::count_if(
      all.begin(), end, [attempt](const auto& each) { return each->attempt == attempt; });
  return std::to_string(attempt + 1) + "." + std::to_string(number);
}

}  // namespace boresight::sessions
