// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/solution_file.h"

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/frame_tree.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

constexpr double kThousand = 1000.0;  ///< mm in a metre, mrad in a radian

/// By GeometryWeakness.
constexpr const char* kWeaknessNames[] = {"too_few",   "few",       "collinear", "coplanar",
                                          "clustered", "one_depth", "imprecise"};

ordered_json viewJson(const AnnotatedView& view, const Pose& camera_from_station,
                      const Matrix6d& covariance) {
  const Vector6d sigma = kThousand * sigmasOf(covariance);
  return {{"name", view.name},
          {"camera_from_rig", toJson(view.camera_from_rig)},
          {"camera_from_station", toJson(camera_from_station)},
          {"covariance", toJson(covariance)},
          {"sigma_mm", toJson(Eigen::Vector3d(sigma.tail<3>()))},
          {"sigma_mrad", toJson(Eigen::Vector3d(sigma.head<3>()))}};
}

ordered_json annotationJson(std::span<const AnnotatedView> views,
                            const SolvedAnnotation& annotation, const LeftOut* without) {
  ordered_json json = {
      {"view", views[annotation.address.view].name},
      {"id", annotationId(views, annotation.address)},
      {"kind", annotation.address.kind == AnnotationKind::kPoint ? "point" : "line"},
      {"projected", annotation.projected},
      {"residual_px", toJson(annotation.residual_px)},
      {"residual_mm", toJson(annotation.residual_mm)},
      {"normalized", annotation.normalized},
      {"weight", annotation.weight}};
  if (without != nullptr)
    json["without"] = {{"determined", without->determined},
                       {"translation_mm", without->translation_mm},
                       {"rotation_mrad", without->rotation_mrad}};
  return json;
}

void addSolution(std::span<const AnnotatedView> views, const AnnotationsSolution& solution,
                 std::span<const LeftOut> left_out, ordered_json& json) {
  json.update({{"rms_px", solution.rms_px},
               {"noise_factor", solution.noise_factor},
               {"degrees_of_freedom", solution.degrees_of_freedom},
               {"rig_from_station", toJson(solution.rig_from_station)},
               {"covariance", toJson(solution.covariance)}});
  for (std::size_t i = 0; i < views.size(); ++i)
    json["views"].push_back(
        viewJson(views[i], solution.camera_from_station[i], cameraCovariance(solution, views[i])));
  for (std::size_t i = 0; i < solution.annotations.size(); ++i)
    json["annotations"].push_back(annotationJson(views, solution.annotations[i],
                                                 i < left_out.size() ? &left_out[i] : nullptr));
  if (solution.ambiguous)
    json["ambiguous"] = {{"rig_from_station", toJson(solution.ambiguous->rig_from_station)},
                         {"rms_px", solution.ambiguous->rms_px}};
}

TextTable annotationTable(std::span<const AnnotatedView> views, const AnnotationsSolution& solution,
                          std::span<const LeftOut> left_out) {
  TextTable table({"view", "annotation", "kind", "dx px", "dy px", "dx mm", "dy mm", "sigmas",
                   "weight", "without: mm", "mrad"});
  for (std::size_t i = 0; i < solution.annotations.size(); ++i) {
    const SolvedAnnotation& annotation = solution.annotations[i];
    const LeftOut& without = left_out[i];
    table.add({views[annotation.address.view].name, annotationId(views, annotation.address),
               annotation.address.kind == AnnotationKind::kPoint ? "point" : "line",
               fixedText(annotation.residual_px.x(), 3), fixedText(annotation.residual_px.y(), 3),
               fixedText(annotation.residual_mm.x(), 3), fixedText(annotation.residual_mm.y(), 3),
               fixedText(annotation.normalized, 1) + (annotation.isOutlier() ? " !" : ""),
               fixedText(annotation.weight, 2),
               without.determined ? fixedText(without.translation_mm, 3) : "no pose",
               without.determined ? fixedText(without.rotation_mrad, 3) : "-"});
  }
  return table;
}

std::string summaryLine(const AnnotationsSolution& solution) {
  std::string text = std::to_string(solution.annotations.size()) + " annotations, rms " +
                     fixedText(solution.rms_px, 3) + " px, ";
  if (solution.degrees_of_freedom == 0) return text + "no redundancy to check the pose";
  text += "noise " + fixedText(solution.noise_factor, 2) + " times the stated sigma (" +
          std::to_string(solution.degrees_of_freedom) + " degrees of freedom)";
  if (solution.noise_factor > kMostNoise)
    text += "\n!: the residuals are far above their sigmas: check for swapped pairs";
  return text;
}

/// The poses that came out: the camera's, or of several views the rig's and then each camera's.
std::string posesText(std::span<const AnnotatedView> views, const AnnotationsSolution& solution) {
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

void writeSolution(const std::filesystem::path& file, std::span<const AnnotatedView> views,
                   const AnnotationsResult& result, std::span<const LeftOut> left_out,
                   std::span<const GeometryWarning> warnings, bool robust) {
  ordered_json json = {{"format", "boresight-solution"},
                       {"version", 1},
                       {"solved", result.solution.has_value()},
                       {"robust", robust}};
  if (result.solution)
    addSolution(views, *result.solution, left_out, json);
  else
    json["reason"] = result.reason;
  json["warnings"] = ordered_json::array();
  for (const GeometryWarning& warning : warnings)
    json["warnings"].push_back({{"kind", kWeaknessNames[static_cast<int>(warning.weakness)]},
                                {"prevents", warning.prevents},
                                {"text", warning.text}});
  writeJsonFile(file, json);
}

std::string solutionText(std::span<const AnnotatedView> views, const AnnotationsSolution& solution,
                         std::span<const LeftOut> left_out,
                         std::span<const GeometryWarning> warnings) {
  std::string text = annotationTable(views, solution, left_out).text();
  text +=
      "(dx, dy: seen minus predicted; of a line, both ends across the edge; !: outlier;\nwithout: "
      "change of the annotations' centre, and of the rotation, without this annotation)\n\n";
  text += summaryLine(solution) + "\n";
  for (const GeometryWarning& warning : warnings) text += plainLine("weak: " + warning.text);
  text += "\n" + posesText(views, solution);
  if (!solution.ambiguous) return text;
  text += "\na second pose fits these annotations with rms " +
          fixedText(solution.ambiguous->rms_px, 3) + " px:\n";
  const Pose ambiguous = views.size() == 1
                             ? views[0].camera_from_rig * solution.ambiguous->rig_from_station
                             : solution.ambiguous->rig_from_station;
  return text + poseText(ambiguous, Matrix6d::Zero(),
                         views.size() == 1 ? "camera_from_station" : "rig_from_station");
}

}  // namespace boresight::sessions
