// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/solution_text.h"

#include "sessions/run/run_text.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

TextTable markTable(std::span<const MarkedView> views, const MarksSolution& solution,
                    std::span<const LeftOut> left_out) {
  TextTable table({"view", "mark", "kind", "dx px", "dy px", "dx mm", "dy mm", "sigmas", "weight",
                   "without: mm", "mrad"});
  for (std::size_t i = 0; i < solution.marks.size(); ++i) {
    const SolvedMark& mark = solution.marks[i];
    const LeftOut& without = left_out[i];
    table.add({views[mark.address.view].name, markId(views, mark.address),
               mark.address.kind == MarkKind::kPoint ? "point" : "line",
               fixedText(mark.residual_px.x(), 3), fixedText(mark.residual_px.y(), 3),
               fixedText(mark.residual_mm.x(), 3), fixedText(mark.residual_mm.y(), 3),
               fixedText(mark.normalized, 1) + (mark.standsOut() ? " !" : ""),
               fixedText(mark.weight, 2),
               without.determined ? fixedText(without.translation_mm, 3) : "no pose",
               without.determined ? fixedText(without.rotation_mrad, 3) : "-"});
  }
  return table;
}

std::string summaryLine(const MarksSolution& solution) {
  std::string text = std::to_string(solution.marks.size()) + " marks, rms " +
                     fixedText(solution.rms_px, 3) + " px, ";
  if (solution.degrees_of_freedom == 0) return text + "none left over to check the pose";
  return text + "noise " + fixedText(solution.noise_factor, 2) + " times the stated sigma (" +
         std::to_string(solution.degrees_of_freedom) + " degrees of freedom)";
}

/// The poses that came out: the camera's, or of several views the rig's and then each camera's.
std::string posesText(std::span<const MarkedView> views, const MarksSolution& solution) {
  const auto ofView = [&](std::size_t i) {
    return poseText(solution.camera_from_station[i], cameraCovariance(solution, views[i]));
  };
  if (views.size() == 1) return ofView(0);
  std::string text = "the rig's pose:\n" +
                     poseText(solution.rig_from_station, solution.covariance, "rig_from_station");
  for (std::size_t i = 0; i < views.size(); ++i)
    text += "\n" + plainLine(views[i].name + ":") + ofView(i);
  return text;
}

}  // namespace

std::string solutionText(std::span<const MarkedView> views, const MarksSolution& solution,
                         std::span<const LeftOut> left_out,
                         std::span<const GeometryWarning> warnings) {
  std::string text = markTable(views, solution, left_out).text();
  text +=
      "(dx, dy: seen minus predicted; of a line, both ends across the edge; !: stands out;\n"
      "without: how far the middle of the marked places moves, and the pose turns)\n\n";
  text += summaryLine(solution) + "\n";
  for (const GeometryWarning& warning : warnings) text += plainLine("weak: " + warning.text);
  text += "\n" + posesText(views, solution);
  if (!solution.twin) return text;
  text += "\nanother pose explains these marks with rms " + fixedText(solution.twin->rms_px, 3) +
          " px:\n";
  const Pose twin = views.size() == 1 ? views[0].camera_from_rig * solution.twin->rig_from_station
                                      : solution.twin->rig_from_station;
  return text + poseText(twin, Matrix6d::Zero(),
                         views.size() == 1 ? "camera_from_station" : "rig_from_station");
}

}  // namespace boresight::sessions
