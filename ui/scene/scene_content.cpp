// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_content.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>
#include <QCoreApplication>

#include "core/base/math.h"
#include "sessions/trace/run_text.h"
#include "ui/models/text.h"
#include "ui/style/theme.h"
#include "ui/views/layer.h"

namespace boresight::ui {
namespace {

constexpr double kFrustumShare = 0.3;  ///< of the way to the scene's centre

QString sceneText(const char* source) { return QCoreApplication::translate("Scene", source); }

BoundingBox boundsOf(const MeshView& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m) box.extend(vertex);
  return boxOf(box);
}

Eigen::Vector3d rayOf(const Camera& camera, const Eigen::Vector2d& pixel) {
  Eigen::Vector3d ray;
  if (unproject(camera, pixel, ray)) return ray;
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, 1.0};
}

void addFrusta(const ViewState& state, SceneContent& content) {
  const sessions::LoadedCase& loaded_case = *content.one;
  const Eigen::Vector3d centre_m = content.bounds.centre();
  // Of the parts that are fixed to the camera: a gripper, a held tube.
  const auto held_in_camera_m = sharpEdges(sessions::heldView(loaded_case.scene));
  const std::array<QString, kPoseRoles> labels = {
      sceneText("seed"),
      state.snapshot()
          ? sceneText("iteration %1")
                .arg(fromText(sessions::iterationName(*state.snapshot(), state.cursor().iteration)))
          : QString(),
      sceneText("nudged"), sceneText("truth"), sceneText("annotated")};
  const bool run_rejected = state.snapshot() && isRejected(*state.snapshot());
  for (int i = 0; i < kPoseRoles; ++i) {
    const auto role = static_cast<PoseRole>(i);
    const std::optional<Pose> pose = poseOf(state, role);
    if (!pose || !pose->isFinite()) continue;
    const bool rejected = run_rejected && role == PoseRole::kEstimate;
    const QString& label = labels[static_cast<std::size_t>(i)];
    content.frusta.push_back(frustumOf(role, rejected ? sceneText("rejected") : label,
                                       loaded_case.source.camera, *pose, centre_m, rejected));
    const Pose station_from_camera = pose->inverse();
    for (const SceneLine& line : held_in_camera_m)
      content.frusta.back().lines.emplace_back(station_from_camera * line.first,
                                               station_from_camera * line.second);
  }
}

void addTrail(const ViewState& state, SceneContent& content) {
  const auto& snapshot = state.snapshot();
  if (!snapshot) return;
  const auto centre = [](const Pose& pose) { return pose.inverse().translation_m; };
  content.trail_m.push_back(centre(snapshot->camera_from_station_seed));
  for (const auto& iteration : snapshot->iterations)
    content.trail_m.push_back(centre(iteration->camera_from_station));
  content.trail_now = state.cursor().iteration + 1;
}

void addTemplates(const sessions::IterationTrace& iteration, SceneContent& content) {
  std::vector<std::size_t> place_of(iteration.templates.size(), SIZE_MAX);
  for (std::size_t i = 0; i < iteration.templates.size(); ++i) {
    ScenePoint point;
    point.at_m = iteration.templates[i].point_in_station_m;
    if (!point.at_m.allFinite()) continue;  // an onboard record's, on another mesh
    place_of[i] = content.points.size();
    point.template_index = static_cast<int>(i);
    content.points.push_back(point);
  }
  const std::size_t solved = std::min({iteration.template_of.size(), iteration.pnp.inlier.size(),
                                       iteration.pnp.residual_px.size()});
  for (std::size_t i = 0; i < solved; ++i) {
    const auto of = place_of.at(static_cast<std::size_t>(iteration.template_of[i]));
    if (of >= content.points.size()) continue;
    content.points[of].kind =
        iteration.pnp.inlier[i] != 0 ? ScenePointKind::kInlier : ScenePointKind::kOutlier;
    content.points[of].residual_px = iteration.pnp.residual_px[i];
  }
}

void addEdgePlaces(const sessions::IterationTrace& iteration, SceneContent& content) {
  for (const EdgeSample& sample : iteration.refinement.samples) {
    ScenePoint point;
    point.at_m = sample.point_in_station_m;
    const bool found = sample.gradient != 0.0;
    if (found)
      point.kind = sample.weight > 0.5 ? ScenePointKind::kInlier : ScenePointKind::kOutlier;
    point.residual_px = found ? std::abs(sample.residual_px) : 0.0;
    content.points.push_back(point);
  }
}

/// Nineteen of twenty inliers lie below it, so that one stray value doesn't make all others alike.
double residualLimit(const std::vector<ScenePoint>& points) {
  std::vector<double> residuals_px;
  for (const ScenePoint& point : points)
    if (point.kind == ScenePointKind::kInlier) residuals_px.push_back(point.residual_px);
  if (residuals_px.empty()) return 1.0;
  const auto at = residuals_px.begin() + static_cast<std::ptrdiff_t>(residuals_px.size() * 19 / 20);
  std::nth_element(residuals_px.begin(), at, residuals_px.end());
  return roundedUp(std::max(*at, 0.01));
}

constexpr int kRejected = kPoseRoles;  ///< after the roles
using RoleStyles = std::array<PoseRoleStyle, kPoseRoles + 1>;

RoleStyles roleStyles(QRgb seed, QRgb pose, QRgb rejected, QRgb truth) {
  return {{{"seed", QColor(seed), {0.6, 0.4}, 2.0},
           {"estimate", QColor(pose), {}, 3.0},
           {"nudged", QColor(seed), {0.5, 0.2, 0.1, 0.2}, 2.5},
           {"truth", QColor(truth), {0.25, 0.25}, 2.0},
           {"annotated", kAnnotatedColor, {0.7, 0.1, 0.1, 0.1}, 2.5},
           {"rejected", QColor(rejected), {0.12, 0.2}, 3.0}}};
}

}  // namespace

const PoseRoleStyle& poseRoleStyle(PoseRole role, bool rejected) {
  static const RoleStyles light =
      roleStyles(kSceneSeed, kScenePose, kSceneRejected, kLightTheme.text);
  static const RoleStyles dark =
      roleStyles(kSeedLine.color, kPoseLine.color, kRejectedLine.color, kTruthLine.color);
  const RoleStyles& styles = themeName() == ThemeName::kDark ? dark : light;
  return styles[static_cast<std::size_t>(rejected ? kRejected : static_cast<int>(role))];
}

std::vector<SceneLine> dashed(const SceneLine& line, const std::vector<double>& dashes,
                              double periods) {
  const double period = std::accumulate(dashes.begin(), dashes.end(), 0.0);
  if (dashes.size() < 2 || !(period > 0.0)) return {line};
  const Eigen::Vector3d along = line.second - line.first;
  std::vector<SceneLine> scene_lines;
  double from = 0.0;                  // in periods of the whole line
  constexpr double kRounding = 1e-9;  // else the last dash could have no length
  for (std::size_t i = 0; from < periods - kRounding; ++i) {
    const double to = std::min(from + dashes[i % dashes.size()] / period, periods);
    if (i % 2 == 0)
      scene_lines.emplace_back(line.first + from / periods * along,
                               line.first + to / periods * along);
    from = to;
  }
  return scene_lines;
}

Frustum frustumOf(PoseRole role, const QString& label, const Camera& camera,
                  const Pose& camera_from_station, const Eigen::Vector3d& centre_m, bool rejected) {
  const PoseRoleStyle& style = poseRoleStyle(role, rejected);
  Frustum frustum;
  frustum.role = role;
  frustum.rejected = rejected;
  frustum.label = label;
  frustum.color = style.color;
  const Pose station_from_camera = camera_from_station.inverse();
  frustum.apex_m = station_from_camera.translation_m;
  const double depth_m = std::max(kFrustumShare * (centre_m - frustum.apex_m).norm(), 1e-6);
  const double right = camera.width - 0.5;
  const double bottom = camera.height - 0.5;
  const std::array<Eigen::Vector2d, 4> corners = {
      {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}}};
  for (std::size_t i = 0; i < 4; ++i)
    frustum.corner_m[i] = station_from_camera * (depth_m * rayOf(camera, corners[i]));
  std::vector<SceneLine> solid;
  for (std::size_t i = 0; i < 4; ++i) {
    solid.emplace_back(frustum.apex_m, frustum.corner_m[i]);
    solid.emplace_back(frustum.corner_m[i], frustum.corner_m[(i + 1) % 4]);
  }
  const Eigen::Vector3d& left_m = frustum.corner_m[0];
  const Eigen::Vector3d& right_m = frustum.corner_m[1];
  const Eigen::Vector3d roof_m =
      0.5 * (left_m + right_m) +
      0.15 * (0.5 * (left_m + right_m) - 0.5 * (frustum.corner_m[2] + frustum.corner_m[3]));
  solid.emplace_back(left_m, roof_m);
  solid.emplace_back(roof_m, right_m);
  for (const SceneLine& line : solid)
    for (const SceneLine& dash : dashed(line, style.dashes)) frustum.lines.push_back(dash);
  // The frusta of a good run nearly coincide, so each role has its label in a place of its own.
  const std::array<Eigen::Vector3d, kPoseRoles> places = {
      left_m, frustum.apex_m, frustum.corner_m[3], right_m, frustum.corner_m[2]};
  frustum.label_at_m = places[static_cast<std::size_t>(role)];
  return frustum;
}

bool sameMesh(const SceneContent& a, const SceneContent& b) {
  if (a.one == b.one) return true;
  return a.one && b.one && sessions::sameScene(a.one->source, b.one->source) &&
         a.one->scene.view().faces.size() == b.one->scene.view().faces.size();
}

SceneContent sceneContent(const ViewState& state) {
  SceneContent content;
  content.one = state.currentCase();
  if (!content.one) return content;
  content.bounds = boundsOf(content.mesh());
  content.axis_length_m = roundedUp(0.2 * content.bounds.diagonal());
  addFrusta(state, content);
  addTrail(state, content);
  if (const auto shown = state.iteration()) {
    if (!shown->templates.empty()) {
      addTemplates(*shown, content);
    } else {
      addEdgePlaces(*shown, content);
      content.point_radius_px = 2.0;
    }
  }
  content.residual_limit_px = residualLimit(content.points);
  content.selected_template = state.selectedTemplate();
  return content;
}

QColor axisColor(int axis) {
  static const std::array<QColor, 3> colors = {QColor(235, 90, 80), QColor(110, 200, 90),
                                               QColor(90, 150, 245)};
  return colors[static_cast<std::size_t>(axis)];
}

std::vector<SceneLine> sharpEdges(const MeshView& mesh) {
  struct Side {
    std::array<std::int32_t, 2> ends{};
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  };
  const float least_cosine = std::cos(static_cast<float>(kPi / 6.0));
  std::vector<Side> sides;
  sides.reserve(3 * mesh.faces.size());
  const auto at = [&mesh](std::int32_t vertex) {
    return mesh.vertices_in_station_m[static_cast<std::size_t>(vertex)];
  };
  for (const Face& face : mesh.faces) {
    const Eigen::Vector3f first = at(face.vertex[0]);
    const Eigen::Vector3f normal =
        (at(face.vertex[1]) - first).cross(at(face.vertex[2]) - first).stableNormalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(face.vertex[i], face.vertex[(i + 1) % 3]);
      sides.push_back({{low, high}, normal});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.ends < b.ends; });
  std::vector<SceneLine> edges;
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sides[end].ends == sides[first].ends) ++end;
    // Coarse meshes are not always oriented, so the normals' signs do not count.
    const bool smooth = end - first == 2 &&
                        std::abs(sides[first].normal.dot(sides[first + 1].normal)) >= least_cosine;
    const auto& [low, high] = sides[first].ends;
    if (!smooth) edges.emplace_back(at(low).cast<double>(), at(high).cast<double>());
  }
  return edges;
}

ColoredLines axisLines(const SceneContent& content) {
  ColoredLines lines;
  for (int axis = 0; axis < 3 && !content.empty(); ++axis)
    lines.push_back({{Eigen::Vector3d::Zero(), content.axis_length_m * Eigen::Vector3d::Unit(axis)},
                     axisColor(axis)});
  return lines;
}

ColoredLines trailLines(const SceneContent& content) {
  ColoredLines lines;
  const QColor color = poseRoleStyle(PoseRole::kEstimate).color.darker(120);
  for (std::size_t i = 1; i < content.trail_m.size(); ++i)
    lines.push_back({{content.trail_m[i - 1], content.trail_m[i]}, color});
  return lines;
}

}  // namespace boresight::ui
