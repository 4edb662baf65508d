// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/peer_runs.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sessions/evaluation/model_error.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/io/file_bytes.h"
#include "sessions/run/problem.h"
#include "tests/benchmarks/peers/guarded_run.h"

namespace boresight::peers {
namespace {

using nlohmann::ordered_json;
using sessions::Case;
using sessions::Dataset;
using sessions::PlannedRun;
using sessions::RunResult;
using sessions::SqlValue;

cv::Mat undistorted(const cv::Mat& image, const Camera& camera, const cv::Matx33d& matrix) {
  if (camera.model == CameraModel::kPinhole) return image;
  cv::Mat x_px;
  cv::Mat y_px;
  if (camera.model == CameraModel::kBrownConrady)
    cv::initUndistortRectifyMap(matrix, cv::Mat(camera.distortion, true), cv::noArray(), matrix,
                                image.size(), CV_32FC1, x_px, y_px);
  else
    cv::fisheye::initUndistortRectifyMap(matrix,
                                         cv::Vec4d(camera.distortion[0], camera.distortion[1],
                                                   camera.distortion[2], camera.distortion[3]),
                                         cv::noArray(), matrix, image.size(), CV_32FC1, x_px, y_px);
  cv::Mat straight;
  cv::remap(image, straight, x_px, y_px, cv::INTER_CUBIC);
  return straight;
}

PinholeImage pinholeImage(const sessions::GrayImage& image, const Camera& camera) {
  PinholeImage made;
  made.fx = camera.fx;
  made.fy = camera.fy;
  made.cx = camera.cx;
  made.cy = camera.cy;
  const cv::Mat gray(image.height, image.width, CV_8U,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  made.gray = undistorted(gray, camera, made.cameraMatrix()).clone();
  if (image.channels >= 3)
    made.colour = undistorted(
        cv::imread(image.file.string(), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION), camera,
        made.cameraMatrix());
  return made;
}

/// What errors and seeds need of a station.
struct Shape {
  sessions::SceneMesh scene;
  std::vector<Eigen::Vector3f> vertices;
  Eigen::Vector3d centre_m;

  explicit Shape(const sessions::Station& station)
      : scene(sessions::readStationScene(station)),
        vertices(sessions::matchedVertices(scene.view())),
        centre_m(matchedBounds(scene.view()).centre()) {}
};

Pose seedOf(const PlannedRun& planned, double reseed_scale, const Eigen::Vector3d& centre_m) {
  const Case& one = *planned.input;
  if (planned.reseed == 0) return one.seed_camera_from_station;
  return sessions::seedForOffset(
      *one.truth_camera_from_station,
      sessions::drawOffset(*one.uncertainty, reseed_scale, one.id, planned.reseed),
      one.uncertainty->pivot, centre_m);
}

RunResult namedResult(const PlannedRun& planned, const std::string& method) {
  const Case& one = *planned.input;
  RunResult result;
  result.case_id = one.id;
  result.place = planned.place;
  result.reseed = planned.reseed;
  result.station = one.station;
  result.method = method;
  result.requirement = one.requirement;
  return result;
}

void noteAnswer(const PeerAnswer& answer, RunResult& result) {
  result.status = answer.status;
  result.message = answer.message;
  result.completed = answer.completed;
  result.camera_from_station = answer.camera_from_station;
  result.iterations = answer.iterations;
  result.edge_support = answer.share;
  result.seconds = answer.seconds;
}

RunResult runPeer(const Dataset& dataset, const PlannedRun& planned, Peer& peer,
                  double reseed_scale) {
  cv::setNumThreads(1);
  const Case& one = *planned.input;
  const sessions::Station& station = dataset.stations.at(one.station);
  const Camera& camera = dataset.cameras.at(one.camera);
  const Shape shape(station);
  const sessions::GrayImage image = sessions::readCaseImage(dataset, one);
  RunResult result = namedResult(planned, peer.name());
  result.camera_from_station_seed = seedOf(planned, reseed_scale, shape.centre_m);
  result.camera_from_station = result.camera_from_station_seed;
  const auto errorOf = [&](const Pose& pose) -> std::optional<sessions::PoseError> {
    if (!one.truth_camera_from_station) return std::nullopt;
    return sessions::wholeError(camera, *one.truth_camera_from_station, pose,
                                one.camera_from_end_effector,
                                {shape.vertices, &station.symmetries});
  };
  result.seed_error = errorOf(result.camera_from_station_seed);
  result.message =
      sessions::seedConcern(camera, shape.scene.view(), result.camera_from_station_seed);
  if (result.message.empty()) {
    StopWatch watch;
    const PeerProblem problem{pinholeImage(image, camera), &shape.scene,
                              result.camera_from_station_seed};
    const double image_s = watch.lap();
    noteAnswer(peer.localize(problem), result);
    result.seconds.initialization += image_s;
  } else {
    result.status = "bad_seed";
  }
  result.error = errorOf(result.camera_from_station);
  sessions::judge(false, result);
  return result;
}

/// The stages' seconds are of wall time: on a machine that does other things besides, they are
/// brought to the processor time that all of the run took.
RunResult runWhs(const Dataset& dataset, const PlannedRun& planned, double reseed_scale) {
  sessions::BatchOptions options;
  options.reseed_scale = reseed_scale;
  RunResult result;
  StopWatch processor;
  const auto began = std::chrono::steady_clock::now();
  sessions::runPlanned(dataset, options, {planned},
                       [&](std::size_t, std::size_t, const RunResult& run) { result = run; });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  const double share = std::min(1.0, processor.lap() / wall.count());
  for (double* seconds :
       {&result.seconds.initialization, &result.seconds.rendering, &result.seconds.matching,
        &result.seconds.pose, &result.seconds.refinement})
    *seconds *= share;
  return result;
}

/// A result as a row of a results file, as JSON.
std::string rowText(const RunResult& result) {
  ordered_json row = ordered_json::array();
  for (const SqlValue& value : sessions::runTable().values(result))
    std::visit(
        [&](const auto& held) {
          if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
            row.push_back(nullptr);
          else
            row.push_back(held);
        },
        value);
  return row.dump();
}

SqlValue valueOf(const ordered_json& json) {
  if (json.is_null()) return {};
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  return json.get<std::string>();
}

RunResult resultOf(const std::string& row_text, const Dataset& dataset) {
  std::vector<SqlValue> row;
  for (const ordered_json& value : ordered_json::parse(row_text)) row.push_back(valueOf(value));
  return sessions::runTable().read(dataset.file, sessions::runTable().names(), row);
}

}  // namespace

RunResult runOne(const Dataset& dataset, const PlannedRun& planned, Peer* peer,
                 const RunLimits& limits) {
  const GuardedAnswer guarded = runGuarded(
      [&] {
        return rowText(peer != nullptr ? runPeer(dataset, planned, *peer, limits.reseed_scale)
                                       : runWhs(dataset, planned, limits.reseed_scale));
      },
      limits.seconds);
  RunResult result = namedResult(planned, peer != nullptr ? peer->name() : sessions::kWhs);
  if (guarded.answer) {
    result = resultOf(*guarded.answer, dataset);
  } else {
    result.status = "killed";
    result.message = guarded.loss;
    if (planned.input->truth_camera_from_station && result.requirement) result.success = false;
  }
  result.tags = planned.input->tags;
  return result;
}

sessions::MethodFacts peerFacts(Peer& peer, const RunLimits& limits) {
  ordered_json options = ordered_json::object();
  for (const Setting& setting : peer.settings().all()) options[setting.name] = setting.value;
  sessions::MethodFacts facts;
  facts.method = peer.name();
  facts.profile = peer.version();
  facts.options = options.dump();
  facts.options_sha256 = sessions::sha256Text(facts.options);
  facts.reseed_scale = limits.reseed_scale;
  return facts;
}

}  // namespace boresight::peers
