// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/edge_band.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sessions/annotation/annotations_on_image.h"
#include "sessions/trace/scene_render.h"

namespace boresight::sessions {
namespace {

constexpr double kNormalQuantile = 1.959963984540054;  ///< 95 % of a Gaussian lie within
constexpr int kSections = 16;  ///< of an edge, to learn how long it is in the image
constexpr int kMostSections = 4096;

/// Depth of the nearest surface at each pixel. Edges lie where depth jumps, so a place is seen when
/// nothing hides it at one of the nine pixels around it.
class DepthImage {
 public:
  DepthImage(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station)
      : camera_(camera),
        depth_m_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)) {
    SurfaceRender surfaces;
    surfaces.depth_m = depth_m_;
    RenderTrace unused;
    rendered_ = renderScene(camera, mesh, camera_from_station, unused, surfaces) == Status::kOk;
  }

  bool rendered() const { return rendered_; }

  bool sees(const PredictedPlace& place) const {
    if (!place.valid || !isInImage(camera_, place.pixel)) return false;
    const int x = static_cast<int>(std::lround(place.pixel.x()));
    const int y = static_cast<int>(std::lround(place.pixel.y()));
    for (int v = std::max(0, y - 1); v <= std::min(camera_.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(camera_.width - 1, x + 1); ++u)
        if (!hides(u, v, place.depth_m)) return true;
    return false;
  }

 private:
  bool hides(int x, int y, double depth_m) const {
    const float nearest_m =
        depth_m_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) +
                 static_cast<std::size_t>(x)];
    return nearest_m > 0.0F && nearest_m < depth_m * (1.0 - kHidingShare);
  }

  Camera camera_;
  std::vector<float> depth_m_;  ///< row by row; 0 where nothing is
  bool rendered_ = false;
};

/// An edge under a camera and a pose.
struct PosedEdge {
  const Camera& camera;
  const Pose& camera_from_station;
  const ModelEdge& edge;

  PredictedPlace at(double t) const {
    return predictPlace(camera, camera_from_station, edge.at(t));
  }

  bool isOnImage(const PredictedPlace& place) const {
    return place.valid && isInImage(camera, place.pixel);
  }

  /// Length of the part that projects, to within its sections; 0 when no part is in the image.
  double length_px() const {
    double length_px = 0.0;
    bool in_image = false;
    PredictedPlace before = at(0.0);
    for (int i = 1; i <= kSections; ++i) {
      const PredictedPlace place = at(static_cast<double>(i) / kSections);
      if (before.valid && place.valid) length_px += (place.pixel - before.pixel).norm();
      in_image = in_image || isOnImage(before) || isOnImage(place);
      before = place;
    }
    return in_image ? length_px : 0.0;
  }
};

/// Nothing where the edge runs along the ray: it has no direction across.
std::optional<BandPlace> bandPlace(const PosedEdge& posed, const PredictedPlace& place,
                                   const Matrix6d& covariance) {
  const Eigen::Vector3d direction =
      posed.camera_from_station.rotation *
      (posed.edge.end_in_station_m - posed.edge.start_in_station_m).normalized();
  const Eigen::Vector2d along = place.pixel_by_point * direction;
  if (!(along.norm() > 1e-9 * place.pixel_by_point.norm())) return {};
  BandPlace band;
  band.pixel = place.pixel;
  band.normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
  const Eigen::Matrix<double, 1, 6> row = band.normal.transpose() * place.pixel_by_xi;
  band.half_width_px = kNormalQuantile * std::sqrt(std::max(0.0, row.dot(row * covariance)));
  return band;
}

void addPieces(const PosedEdge& posed, const DepthImage& depth, const Matrix6d& covariance,
               double step_px, std::vector<BandPiece>& pieces) {
  const double length_px = posed.length_px();
  if (!(length_px > 0.0)) return;
  const int sections =
      static_cast<int>(std::clamp(std::ceil(length_px / step_px), 1.0, double{kMostSections}));
  BandPiece piece;
  const auto finish = [&] {
    if (piece.places.size() > 1) pieces.push_back(piece);
    piece.places.clear();
  };
  for (int i = 0; i <= sections; ++i) {
    const PredictedPlace place = posed.at(static_cast<double>(i) / sections);
    const auto result = depth.sees(place) ? bandPlace(posed, place, covariance) : std::nullopt;
    if (result)
      piece.places.push_back(*result);
    else
      finish();
  }
  finish();
}

}  // namespace

std::vector<BandPiece> edgeBand(const MeshSnapper& mesh, const Camera& camera,
                                const Pose& camera_from_station, const Matrix6d& covariance,
                                double step_px) {
  std::vector<BandPiece> pieces;
  const DepthImage depth(camera, mesh.mesh(), camera_from_station);
  if (!depth.rendered()) return pieces;
  for (const ModelEdge& edge : mesh.edges())
    addPieces({camera, camera_from_station, edge}, depth, covariance, step_px, pieces);
  return pieces;
}

}  // namespace boresight::sessions
