// SPDX-License-Identifier: Apache-2.0
#include "app/bench_localization.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sessions/evaluation/reseed.h"
#include "sessions/io/errors.h"
#include "sessions/run/problem.h"

namespace boresight::app {
namespace {

constexpr int kHouseholdWidth = 640;
constexpr int kHouseholdHeight = 480;

/// What a case's problem points into.
struct Loaded {
  sessions::GrayImage image;
  sessions::SceneMesh scene;
  Camera camera;
  Pose camera_from_station_seed;
  sessions::DeclaredUncertainty uncertainty;
  LocalizerOptions options;

  LocalizationProblem problem() const {
    return sessions::problemOf(image, nullptr, camera, scene.view(), camera_from_station_seed,
                               uncertainty);
  }
};

Loaded load(const sessions::Dataset& dataset, const sessions::Case& one,
            const LocalizerOptions& options) {
  Loaded loaded;
  const sessions::Station& station = dataset.stations.at(one.station);
  loaded.image = sessions::readCaseImage(dataset, one);
  loaded.scene = sessions::readStationScene(station);
  loaded.camera = dataset.cameras.at(one.camera);
  loaded.camera_from_station_seed = one.seed_camera_from_station;
  loaded.uncertainty = one.uncertainty.value_or(sessions::DeclaredUncertainty());
  loaded.options = options;
  if (options.templates.feature_size_m == 0.0 && station.feature_size_m)
    loaded.options.templates.feature_size_m = *station.feature_size_m;
  return loaded;
}

void addRun(const Loaded& loaded, const sessions::RunSettings& settings,
            LocalizationFigure& figure) {
  sessions::RunSettings summary = settings;
  summary.level = sessions::RecordLevel::kSummary;
  figure.kernels = settings.kernels;
  figure.threads = settings.threads;
  const sessions::LocalizationTrace trace =
      sessions::localize(loaded.problem(), loaded.options, summary);
  figure.mean_seconds += trace.seconds;
  figure.converged += trace.status == LocalizationStatus::kConverged ? 1 : 0;
  figure.arena_bytes = trace.arena_bytes;
  if (figure.runs == 0) figure.digest = trace.digest;
  ++figure.runs;
}

void takeMean(LocalizationFigure& figure) {
  const double share = 1.0 / std::max(1, figure.runs);
  sessions::StageSeconds& seconds = figure.mean_seconds;
  for (double* each : {&seconds.initialization, &seconds.rendering, &seconds.matching,
                       &seconds.pose, &seconds.refinement}) {
    *each *= share;
  }
}

/// Scales to the household camera's size and cuts off above and below what does not fit.
void bringToHouseholdSize(Loaded& loaded) {
  const double scale = static_cast<double>(kHouseholdWidth) / loaded.image.width;
  const int scaled_height = std::max(1, static_cast<int>(loaded.image.height * scale + 0.5));
  const cv::Mat pixels(loaded.image.height, loaded.image.width, CV_8U, loaded.image.pixels.data());
  cv::Mat scaled;
  cv::resize(pixels, scaled, cv::Size(kHouseholdWidth, scaled_height), 0, 0, cv::INTER_AREA);
  const int above = (scaled_height - kHouseholdHeight) / 2;
  cv::Mat fitted(kHouseholdHeight, kHouseholdWidth, CV_8U, cv::Scalar(0));
  const int rows = std::min(scaled_height, kHouseholdHeight);
  const int from = std::max(0, above);
  const int to = std::max(0, -above);
  scaled.rowRange(from, from + rows).copyTo(fitted.rowRange(to, to + rows));
  loaded.image.pixels.assign(fitted.data, fitted.data + fitted.total());
  loaded.image.width = kHouseholdWidth;
  loaded.image.height = kHouseholdHeight;

  Camera& camera = loaded.camera;
  camera.width = kHouseholdWidth;
  camera.height = kHouseholdHeight;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5 - above;
  if (prepareCamera(camera) != Status::kOk)
    throw sessions::InputError("bench", "camera", "cannot be brought to 640 x 480");
}

}  // namespace

LocalizationFigure measureCase(const sessions::Dataset& dataset, const sessions::Case& one,
                               const LocalizerOptions& options, int repetitions,
                               const sessions::RunSettings& settings) {
  const Loaded loaded = load(dataset, one, options);
  LocalizationFigure figure;
  figure.name = one.id;
  figure.width = loaded.camera.width;
  figure.height = loaded.camera.height;
  for (int i = 0; i < repetitions; ++i) addRun(loaded, settings, figure);
  takeMean(figure);
  return figure;
}

LocalizationFigure measureHouseholdScale(const sessions::Dataset& dataset,
                                         const sessions::Case& one, const LocalizerOptions& options,
                                         int seeds, const sessions::RunSettings& settings) {
  if (!one.truth_camera_from_station)
    throw sessions::InputError(dataset.file, "cases." + one.id + ".truth",
                               "seeds are drawn around the truth, and there is none");
  Loaded loaded = load(dataset, one, options);
  bringToHouseholdSize(loaded);
  loaded.uncertainty.translation_m = Eigen::Vector3d::Constant(0.03);
  loaded.uncertainty.rotation_deg = Eigen::Vector3d::Constant(10.0);
  loaded.uncertainty.pivot = sessions::UncertaintyPivot::kStation;
  LocalizationFigure figure;
  figure.name = one.id + " at household scale";
  figure.width = kHouseholdWidth;
  figure.height = kHouseholdHeight;
  const Eigen::Vector3d centre_in_station_m = matchedBounds(loaded.scene.view()).centre();
  for (int seed = 1; seed <= seeds; ++seed) {
    loaded.camera_from_station_seed = sessions::seedForOffset(
        *one.truth_camera_from_station, sessions::drawOffset(loaded.uncertainty, 1.0, one.id, seed),
        loaded.uncertainty.pivot, centre_in_station_m);
    addRun(loaded, settings, figure);
  }
  takeMean(figure);
  return figure;
}

}  // namespace boresight::app
