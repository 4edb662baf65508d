// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/report_pictures.h"

#include <algorithm>
#include <cmath>

#include "sessions/annotation/predicted_place.h"
#include "sessions/run/overlay.h"
#include "sessions/session/case_marks.h"

namespace boresight::sessions {
namespace {

constexpr double kMargin = 0.12;  ///< around the station, of its size in the image
constexpr int kLeastSide_px = 160;

struct Area {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< px; the last two are one beyond
};

/// Where the pose predicts the station; the whole image when it does not say.
Area stationArea(const PoseReport& report) {
  const ImageView image = report.loaded->image.view();
  const Area whole = {0, 0, image.width, image.height};
  Camera camera = report.loaded->source.camera;
  if (prepareCamera(camera) != Status::kOk) return whole;
  Eigen::AlignedBox2d box;
  for (const auto& corner : boxCorners(matchedBounds(report.loaded->scene.view()))) {
    const auto place = predictPlace(camera, report.pose.camera_from_station, corner);
    if (!place.valid) return whole;
    box.extend(place.pixel);
  }
  const double side = std::max(box.sizes().maxCoeff(), static_cast<double>(kLeastSide_px));
  const Eigen::Vector2d half = 0.5 * box.sizes() + Eigen::Vector2d::Constant(kMargin * side);
  const Eigen::Vector2d low = box.center() - half;
  const Eigen::Vector2d high = box.center() + half;
  const auto within = [](double value, int limit) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(limit)));
  };
  const Area area = {within(low.x(), image.width), within(low.y(), image.height),
                     within(high.x(), image.width), within(high.y(), image.height)};
  return area.right - area.left < 16 || area.bottom - area.top < 16 ? whole : area;
}

ReportPicture cut(const ColorImage& image, const Area& area) {
  ReportPicture made;
  made.left_px = area.left;
  made.top_px = area.top;
  made.image.width = area.right - area.left;
  made.image.height = area.bottom - area.top;
  for (int y = area.top; y < area.bottom; ++y) {
    const std::ptrdiff_t first = 3 * (std::ptrdiff_t{y} * image.width + area.left);
    const auto row = image.bgr.begin() + first;
    made.image.bgr.insert(made.image.bgr.end(), row, row + 3 * std::ptrdiff_t{made.image.width});
  }
  return made;
}

}  // namespace

ReportPicture overlayPicture(const PoseReport& report) {
  Camera camera = report.loaded->source.camera;
  const Area area = stationArea(report);
  if (prepareCamera(camera) != Status::kOk) return palePicture(report);
  const OverlayLayer layers[] = {
      {"seed", report.loaded->source.camera_from_station_seed, kSeedColor, true},
      {"pose", report.pose.camera_from_station, kResultColor, true}};
  return cut(drawOverlay(report.loaded->image.view(), camera, report.loaded->scene.view(), layers),
             area);
}

ReportPicture palePicture(const PoseReport& report) {
  const ImageView view = report.loaded->image.view();
  ColorImage pale{view.width, view.height, {}};
  pale.bgr.reserve(3 * static_cast<std::size_t>(view.width) *
                   static_cast<std::size_t>(view.height));
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto value = static_cast<std::uint8_t>(150 + view.at(x, y) * 105 / 255);
      pale.bgr.insert(pale.bgr.end(), 3, value);
    }
  }
  return cut(pale, stationArea(report));
}

}  // namespace boresight::sessions
