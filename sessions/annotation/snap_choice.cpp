// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/snap_choice.h"

#include <algorithm>
#include <optional>

namespace boresight::sessions {
namespace {

constexpr double kEdgeHandicap = 0.5;  ///< of the radius
/// An ellipse that is seen nearly all round is no accident: corners near its centre (the slot of a
/// screw) come after it.
constexpr double kSureSupport = 0.85;
constexpr double kCornersEdge_px = 3.0;  ///< how far a corner's edges lie from it
constexpr double kFaint = 0.5;           ///< of the contrast

double handicap_px(const ImageSnap& snap, double radius_px) {
  if (snap.kind == ImageSnapKind::kEdge) return kEdgeHandicap * radius_px;
  if (snap.kind != ImageSnapKind::kEllipse) return 0.0;
  return (snap.ellipse.support >= kSureSupport ? -0.5 : 0.25) * radius_px;
}

double handicap_px(const MeshSnap& snap, double radius_px) {
  return snap.kind == MeshSnapKind::kEdge ? kEdgeHandicap * radius_px : 0.0;
}

template <class Snap>
void sortByLikelihood(std::vector<Snap>& snaps, double radius_px) {
  std::stable_sort(snaps.begin(), snaps.end(), [radius_px](const Snap& a, const Snap& b) {
    return a.distance_px + handicap_px(a, radius_px) < b.distance_px + handicap_px(b, radius_px);
  });
}

/// Specks in a shadow are corners too, but nobody who is at an edge means them.
bool isFainter(const ImageView& image, const Eigen::Vector2d& corner,
               const std::optional<EdgeSnap>& edge) {
  if (!edge) return false;
  const auto at_corner = snapToEdge(image, corner, kCornersEdge_px);
  return !at_corner || at_corner->contrast < kFaint * edge->contrast;
}

}  // namespace

std::vector<ImageSnap> imageSnaps(const ImageView& image, const Eigen::Vector2d& near,
                                  double radius_px, double rim_px) {
  std::vector<ImageSnap> snaps;
  const auto offer = [&](ImageSnap snap) {
    snap.distance_px = (snap.pixel - near).norm();
    if (snap.distance_px <= radius_px) snaps.push_back(snap);
  };
  const auto edge = snapToEdge(image, near, radius_px);
  const auto corner = snapToCorner(image, near, radius_px);
  if (corner && !isFainter(image, *corner, edge))
    offer({ImageSnapKind::kCorner, *corner, 0.0, {}, {}});
  if (const auto ellipse = snapToEllipse(image, near, rim_px))
    offer({ImageSnapKind::kEllipse, ellipse->centre, 0.0, {}, *ellipse});
  if (edge) offer({ImageSnapKind::kEdge, edge->pixel, 0.0, *edge, {}});
  sortByLikelihood(snaps, radius_px);
  return snaps;
}

std::vector<MeshSnap> likeliestFirst(std::vector<MeshSnap> snaps, double radius_px) {
  sortByLikelihood(snaps, radius_px);
  return snaps;
}

}  // namespace boresight::sessions
