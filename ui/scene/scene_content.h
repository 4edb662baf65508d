// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <QColor>
#include <QString>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// Appearance of a pose's camera; the hues are those of the image's layers.
struct PoseRoleStyle {
  const char* name = "";
  QColor color;
  /// Lengths of dashes and gaps in turn, as shares of the line; empty: a solid line. A second
  /// distinction in addition to the colour.
  std::vector<double> dashes;
  double width_px = 2.0;
};
/// `rejected`: of the estimate of a run that was rejected.
const PoseRoleStyle& poseRoleStyle(PoseRole role, bool rejected = false);

/// A straight line in the station frame, metres.
using SceneLine = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

/// A line cut into the dashes of a style, which repeat this number of times along it.
std::vector<SceneLine> dashed(const SceneLine& line, const std::vector<double>& dashes,
                              double periods = 12.0);

/// A camera as a pyramid of the rays through its image's corners.
struct Frustum {
  PoseRole role = PoseRole::kSeed;
  bool rejected = false;
  QString label;
  QColor color;
  Eigen::Vector3d apex_m = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 4> corner_m;  ///< top left, top right, bottom right, bottom left
  /// Dashed by the role, with a roof at the image's top; and edges of parts fixed to the camera.
  std::vector<SceneLine> lines;
  Eigen::Vector3d label_at_m = Eigen::Vector3d::Zero();
};

/// `centre_m`: of the scene; the pyramid is drawn a share of the way towards it.
Frustum frustumOf(PoseRole role, const QString& label, const Camera& camera,
                  const Pose& camera_from_station, const Eigen::Vector3d& centre_m,
                  bool rejected = false);

enum class ScenePointKind : std::uint8_t {
  kInlier,
  kOutlier,
  kUnmatched,  ///< a template that was not found, or an edge place that was not used
};

/// A template's 3D point, or a place along an edge that the refinement searched from.
struct ScenePoint {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< station frame
  ScenePointKind kind = ScenePointKind::kUnmatched;
  double residual_px = 0.0;  ///< magnitude; 0 where there is none
  int template_index = -1;   ///< into the iteration's templates, or -1
};

/// Elements of the scene that are shown.
struct SceneShown {
  bool mesh = true;
  bool mesh_edges = true;
  bool frusta = true;
  bool trail = true;
  bool points = true;
  bool axes = true;
};

/// Everything that the scene draws, as plain values in the station frame.
struct SceneContent {
  /// Owns the mesh, which is not copied; nullptr: nothing is open.
  std::shared_ptr<const sessions::LoadedCase> one;
  BoundingBox bounds;  ///< of all parts
  std::vector<Frustum> frusta;
  std::vector<Eigen::Vector3d> trail_m;  ///< camera centres: the seed's, then each iteration's
  int trail_now = -1;                    ///< index of the shown one, or -1
  std::vector<ScenePoint> points;
  double residual_limit_px = 1.0;  ///< upper end of the colours
  double point_radius_px = 4.5;    ///< on the screen; edge places are many and therefore small
  int selected_template = -1;
  double axis_length_m = 0.1;

  bool empty() const { return one == nullptr; }
  /// Without parts that are fixed to the camera.
  MeshView mesh() const { return one ? sessions::stationView(one->scene) : MeshView(); }
};

/// Whether two contents have the same mesh in the same place, as most edits of a case leave it.
bool sameMesh(const SceneContent& a, const SceneContent& b);

/// The content at the state's cursor.
SceneContent sceneContent(const ViewState& state);

/// Colours of the station's x, y and z axis, which also carry their letters.
QColor axisColor(int axis);

/// Edges of the mesh worth drawing: where two faces meet at more than 30 deg, where a face ends, or
/// where more than two meet.
std::vector<SceneLine> sharpEdges(const MeshView& mesh);

/// Lines of one colour each.
using ColoredLines = std::vector<std::pair<SceneLine, QColor>>;

/// The station's axes; none without a case.
ColoredLines axisLines(const SceneContent& content);
/// From each camera centre of the trail to the next.
ColoredLines trailLines(const SceneContent& content);

}  // namespace boresight::ui
