// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/solution_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "sessions/io/json_writer.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

constexpr double kThousand = 1000.0;  ///< mm in a metre, mrad in a radian

const char* kindName(GeometryWeakness weakness) {
  switch (weakness) {
    case GeometryWeakness::kTooFew:
      return "too_few";
    case GeometryWeakness::kFew:
      return "few";
    case GeometryWeakness::kCollinear:
      return "collinear";
    case GeometryWeakness::kCoplanar:
      return "coplanar";
    case GeometryWeakness::kClustered:
      return "clustered";
    case GeometryWeakness::kOneDepth:
      return "one_depth";
    case GeometryWeakness::kImprecise:
      return "imprecise";
  }
  throw std::logic_error("no such weakness");
}

ordered_json pairJson(const Eigen::Vector2d& vector) {
  return ordered_json::array({vector.x(), vector.y()});
}

/// Roots of three entries of the diagonal, in thousandths.
ordered_json sigmas(const Matrix6d& covariance, int first) {
  ordered_json made = ordered_json::array();
  for (int i = first; i < first + 3; ++i)
    made.push_back(kThousand * std::sqrt(std::max(0.0, covariance(i, i))));
  return made;
}

ordered_json viewJson(const MarkedView& view, const Pose& camera_from_station,
                      const Matrix6d& covariance) {
  ordered_json json;
  json["name"] = view.name;
  json["camera_from_rig"] = toJson(view.camera_from_rig);
  json["camera_from_station"] = toJson(camera_from_station);
  json["covariance"] = toJson(covariance);
  json["sigma_mm"] = sigmas(covariance, 3);
  json["sigma_mrad"] = sigmas(covariance, 0);
  return json;
}

ordered_json markJson(std::span<const MarkedView> views, const SolvedMark& mark,
                      const LeftOut* without) {
  ordered_json json;
  json["view"] = views[mark.address.view].name;
  json["id"] = markId(views, mark.address);
  json["kind"] = mark.address.kind == MarkKind::kPoint ? "point" : "line";
  json["projected"] = mark.projected;
  json["residual_px"] = pairJson(mark.residual_px);
  json["residual_mm"] = pairJson(mark.residual_mm);
  json["normalized"] = mark.normalized;
  json["weight"] = mark.weight;
  if (without == nullptr) return json;
  json["without"]["determined"] = without->determined;
  json["without"]["translation_mm"] = without->translation_mm;
  json["without"]["rotation_mrad"] = without->rotation_mrad;
  return json;
}

void addSolution(std::span<const MarkedView> views, const MarksSolution& solution,
                 std::span<const LeftOut> left_out, ordered_json& json) {
  json["rms_px"] = solution.rms_px;
  json["noise_factor"] = solution.noise_factor;
  json["degrees_of_freedom"] = solution.degrees_of_freedom;
  json["rig_from_station"] = toJson(solution.rig_from_station);
  json["covariance"] = toJson(solution.covariance);
  json["views"] = ordered_json::array();
  for (std::size_t i = 0; i < views.size(); ++i)
    json["views"].push_back(
        viewJson(views[i], solution.camera_from_station[i], cameraCovariance(solution, views[i])));
  json["marks"] = ordered_json::array();
  for (std::size_t i = 0; i < solution.marks.size(); ++i)
    json["marks"].push_back(
        markJson(views, solution.marks[i], i < left_out.size() ? &left_out[i] : nullptr));
  if (!solution.twin) return;
  json["twin"]["rig_from_station"] = toJson(solution.twin->rig_from_station);
  json["twin"]["rms_px"] = solution.twin->rms_px;
}

}  // namespace

void writeSolution(const std::filesystem::path& file, std::span<const MarkedView> views,
                   const MarksResult& result, std::span<const LeftOut> left_out,
                   std::span<const GeometryWarning> warnings, bool robust) {
  ordered_json json;
  json["format"] = "boresight-solution";
  json["version"] = 1;
  json["solved"] = result.solution.has_value();
  json["robust"] = robust;
  if (result.solution)
    addSolution(views, *result.solution, left_out, json);
  else
    json["reason"] = result.reason;
  json["warnings"] = ordered_json::array();
  for (const GeometryWarning& warning : warnings) {
    ordered_json one;
    one["kind"] = kindName(warning.weakness);
    one["prevents"] = warning.prevents;
    one["text"] = warning.text;
    json["warnings"].push_back(one);
  }
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
