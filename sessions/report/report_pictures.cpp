// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/pose_report.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <opencv2/imgproc.hpp>
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/session/case_annotations.h"
#include "sessions/trace/decisive_iterations.h"
#include "sessions/trace/overlay.h"

namespace boresight::sessions {
namespace {

constexpr double kMargin = 0.12;  ///< around the station, of its size in the image
constexpr int kLeastSide_px = 160;

PredictedPlace predicted(const PoseReport& report, const Eigen::Vector3d& point_in_station_m) {
  return predictPlace(report.loaded->source.camera, report.pose.camera_from_station,
                      point_in_station_m);
}

/// Where the pose predicts the station; the whole image where a corner does not project.
cv::Rect stationArea(const PoseReport& report) {
  const ImageView image = report.loaded->image.view();
  const cv::Rect whole(0, 0, image.width, image.height);
  Eigen::AlignedBox2d box;
  for (const auto& corner : boxCorners(matchedBounds(report.loaded->scene.view()))) {
    const PredictedPlace place = predicted(report, corner);
    if (!place.valid) return whole;
    box.extend(place.pixel);
  }
  const double side = std::max(box.sizes().maxCoeff(), static_cast<double>(kLeastSide_px));
  const Eigen::Vector2d half = 0.5 * box.sizes() + Eigen::Vector2d::Constant(kMargin * side);
  const Eigen::Vector2d limit(image.width, image.height);
  const Eigen::Vector2i low =
      (box.center() - half).array().floor().max(0.0).min(limit.array()).cast<int>();
  const Eigen::Vector2i high =
      (box.center() + half).array().floor().max(0.0).min(limit.array()).cast<int>();
  const cv::Rect area(low.x(), low.y(), high.x() - low.x(), high.y() - low.y());
  return area.width < 16 || area.height < 16 ? whole : area;
}

/// A part of an image of three bytes a pixel.
ReportPicture cut(const cv::Mat& bgr, const cv::Rect& area) {
  const cv::Mat part = bgr(area).clone();
  return {{part.cols, part.rows, {part.datastart, part.dataend}}, area.x, area.y};
}

/// The last refinement that led to the run's pose, or nullptr.
std::shared_ptr<const IterationTrace> lastRefinement(const LocalizationTrace& run) {
  std::shared_ptr<const IterationTrace> found;
  for (const auto& item : decisiveIterations(run))
    if (item->kind == IterationKind::kRefine && item->support() > 0) found = item;
  return found;
}

ReportResiduals ofEdges(const PoseReport& report, const IterationTrace& iteration) {
  ReportResiduals residuals{"edge points of the refinement", {}};
  for (const EdgeSample& sample : iteration.refinement.samples) {
    const PredictedPlace place = predicted(report, sample.point_in_station_m);
    if (place.valid && sample.gradient != 0.0)
      residuals.all.push_back(
          {place.pixel, sample.residual_px * sample.normal(), sample.weight > 0.0});
  }
  return residuals;
}

ReportResiduals ofTemplates(const PoseReport& report, const IterationTrace& iteration) {
  ReportResiduals residuals{"matched templates", {}};
  for (std::size_t i = 0; i < iteration.correspondences.size(); ++i) {
    const Correspondence& correspondence = iteration.correspondences[i];
    const PredictedPlace place = predicted(report, correspondence.point_in_station_m);
    const bool inlier = i < iteration.pnp.inlier.size() && iteration.pnp.inlier[i] != 0;
    if (place.valid)
      residuals.all.push_back({place.pixel, correspondence.pixel - place.pixel, inlier});
  }
  return residuals;
}

ReportResiduals ofAnnotations(const PoseReport& report) {
  ReportResiduals residuals{"annotations", {}};
  const auto found = report.session->annotations.find(report.pose.case_id);
  if (found == report.session->annotations.end()) return residuals;
  for (const PointPair& point : found->second->points) {
    if (!point.complete()) continue;
    const PredictedPlace place = predicted(report, *point.point_in_station_m);
    if (place.valid)
      residuals.all.push_back({place.pixel, *point.pixel - place.pixel, point.enabled});
  }
  return residuals;
}

}  // namespace

ReportPicture overlayPicture(const PoseReport& report) {
  const LoadedCase& loaded = *report.loaded;
  std::vector<OverlayLayer> layers;
  if (loaded.source.has_seed)
    layers.push_back({"seed", loaded.source.camera_from_station_seed, kSeedColor, true});
  layers.push_back({"pose", report.pose.camera_from_station, kResultColor, true});
  ColorImage drawn =
      drawOverlay(loaded.image.view(), loaded.source.camera, loaded.scene.view(), layers);
  return cut(cv::Mat(drawn.height, drawn.width, CV_8UC3, drawn.bgr.data()), stationArea(report));
}

ReportPicture palePicture(const PoseReport& report) {
  const ImageView view = report.loaded->image.view();
  // OpenCV has no const headers; nothing is written.
  const cv::Mat gray(view.height, view.width, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                     static_cast<std::size_t>(view.stride));
  cv::Mat pale;
  cv::cvtColor(gray, pale, cv::COLOR_GRAY2BGR);
  pale.convertTo(pale, CV_8U, 105.0 / 255.0, 150.0);
  return cut(pale, stationArea(report));
}

double ReportResiduals::rms_px() const {
  double squares = 0.0;
  int count = 0;
  for (const ReportResidual& residual : all) {
    if (!residual.used) continue;
    squares += residual.residual_px.squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0.0;
}

ReportResiduals reportResiduals(const PoseReport& report) {
  if (report.pose.source == PoseSource::kAnnotation) return ofAnnotations(report);
  if (!report.trace) return {};
  if (const auto refined = lastRefinement(*report.trace)) return ofEdges(report, *refined);
  if (const auto matched = lastMatching(*report.trace)) return ofTemplates(report, *matched);
  return {};
}

}  // namespace boresight::sessions
