// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/visp_peer.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "tests/benchmarks/peers/stop_watch.h"
#include "tests/benchmarks/peers/visible_lines.h"
#include "tests/benchmarks/peers/visp_tracker.h"
#include "tests/benchmarks/peers/wire_model.h"

namespace boresight::peers {
namespace {

PoseRows rowsOf(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.matrix();
  PoseRows rows{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[static_cast<std::size_t>(4 * i + j)] = rotation(i, j);
    rows[static_cast<std::size_t>(4 * i + 3)] = pose.translation_m[i];
  }
  rows[15] = 1.0;
  return rows;
}

Pose poseOf(const PoseRows& rows) {
  Eigen::Matrix3d rotation;
  Pose pose;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation(i, j) = rows[static_cast<std::size_t>(4 * i + j)];
    pose.translation_m[i] = rows[static_cast<std::size_t>(4 * i + 3)];
  }
  pose.rotation = Eigen::Quaterniond(rotation).normalized();
  return pose;
}

VispPoint vispPoint(const WireModel& model, int index) {
  const Eigen::Vector3d& point = model.points_m[static_cast<std::size_t>(index)];
  return {point.x(), point.y(), point.z()};
}

VispModel vispModel(const WireModel& model) {
  VispModel made;
  for (const auto& line : model.lines)
    made.lines.push_back({vispPoint(model, line[0]), vispPoint(model, line[1])});
  for (const auto& face : model.faces)
    made.faces.push_back(
        {vispPoint(model, face[0]), vispPoint(model, face[1]), vispPoint(model, face[2])});
  return made;
}

class VispPeer : public Peer {
 public:
  std::string name() const override { return "visp-edge"; }
  std::string version() const override { return "ViSP " + VispTracker::version(); }
  Settings& settings() override { return settings_; }
  PeerAnswer localize(const PeerProblem& problem) override;

 private:
  VispTuning tuning() const;
  /// What is seen from a pose.
  VispModel modelAt(const PeerProblem& problem, const Pose& camera_from_station) const;
  double seekAt(int pass, int passes) const;
  void runLevel(VispTracker& tracker, int level, Pose& pose, PeerAnswer& answer) const;
  void judge(const VispTracker& tracker, PeerAnswer& answer) const;

  Settings settings_{{
      {"visp.levels", 4, "resolutions, the coarsest at 1 / 2^(levels - 1)"},
      {"visp.least_side_px", 300, "no resolution with a shorter side"},
      {"visp.first_seek_px", 20, "search on both sides of a line, first pass of a level"},
      {"visp.last_seek_px", 4, "the same, last pass of a level"},
      {"visp.passes", 8, "searches at each level"},
      {"visp.settle", 6, "further calls of track at the finest level, at most"},
      {"visp.range_px", 4, "search of track itself"},
      {"visp.mask_px", 5, "side of the masks of convolution"},
      {"visp.mask_count", 180, "masks"},
      {"visp.threshold", 5000, "likelihood that an edge must reach"},
      {"visp.mu1", 0.5, "contrast may fall by this share"},
      {"visp.mu2", 0.5, "contrast may rise by this share"},
      {"visp.sample_px", 4, "between sites"},
      {"visp.crease_deg", 30, "angle between faces from which their edge is followed"},
      {"visp.scan_lines", 0, "1: ViSP's scan line test says what is hidden; slow on fine meshes"},
      {"visp.depth_threshold", 1e-4, "of that test (m)"},
      {"visp.good_share", 0.4, "of sites that must be good"},
      {"visp.largest_error_deg", 18, "mean angle between lines and gradients to be accepted"},
  }};
};

VispTuning VispPeer::tuning() const {
  VispTuning tuning;
  tuning.mask_px = static_cast<unsigned int>(settings_.whole("visp.mask_px"));
  tuning.mask_count = static_cast<unsigned int>(settings_.whole("visp.mask_count"));
  tuning.range_px = static_cast<unsigned int>(settings_.whole("visp.range_px"));
  tuning.threshold = settings_.value("visp.threshold");
  tuning.mu1 = settings_.value("visp.mu1");
  tuning.mu2 = settings_.value("visp.mu2");
  tuning.sample_px = settings_.value("visp.sample_px");
  tuning.good_share = settings_.value("visp.good_share");
  tuning.scan_lines = settings_.value("visp.scan_lines") != 0.0;
  tuning.depth_threshold = settings_.value("visp.depth_threshold");
  return tuning;
}

VispModel VispPeer::modelAt(const PeerProblem& problem, const Pose& camera_from_station) const {
  WireModel model =
      wireModel(*problem.scene, camera_from_station, settings_.value("visp.crease_deg"));
  if (settings_.value("visp.scan_lines") == 0.0) {
    keepVisibleLines(problem.image, camera_from_station, model);
    model.faces.clear();
  }
  return vispModel(model);
}

double VispPeer::seekAt(int pass, int passes) const {
  const double first = settings_.value("visp.first_seek_px");
  const double last = settings_.value("visp.last_seek_px");
  return passes < 2 ? last : first * std::pow(last / first, pass / (passes - 1.0));
}

void VispPeer::runLevel(VispTracker& tracker, int level, Pose& pose, PeerAnswer& answer) const {
  const int passes = settings_.whole("visp.passes");
  for (int pass = 0; pass < passes; ++pass, ++answer.iterations) {
    tracker.begin(rowsOf(pose), static_cast<unsigned int>(std::lround(seekAt(pass, passes))));
    tracker.track();
    pose = poseOf(tracker.pose());
  }
  for (int i = 0; level == 0 && i < settings_.whole("visp.settle"); ++i, ++answer.iterations) {
    const Pose before = pose;
    tracker.track();
    pose = poseOf(tracker.pose());
    if (perturbationBetween(before, pose).norm() < 1e-6) break;
  }
}

void VispPeer::judge(const VispTracker& tracker, PeerAnswer& answer) const {
  answer.share = tracker.share();
  const double error_deg = tracker.projectionError_deg();
  answer.completed = answer.camera_from_station.isFinite() &&
                     error_deg <= settings_.value("visp.largest_error_deg");
  answer.status = answer.completed ? "converged" : "lost";
  answer.message = "projection error " + std::to_string(error_deg) + " deg";
}

PeerAnswer VispPeer::localize(const PeerProblem& problem) {
  PeerAnswer answer;
  Pose pose = problem.camera_from_station_seed;
  answer.camera_from_station = pose;
  StopWatch watch;
  try {
    for (int level = levelsOf(problem.image, settings_.whole("visp.levels"),
                              settings_.whole("visp.least_side_px")) -
                     1;
         level >= 0; --level) {
      watch.lap();
      const PinholeImage image = atLevel(problem.image, level);
      // Anew at each level: what is hidden, and the outline of what is round, move with the pose.
      VispTracker tracker(modelAt(problem, pose), tuning());
      tracker.look(image.gray, image.fx, image.fy, image.cx, image.cy);
      answer.seconds.initialization += watch.lap();
      runLevel(tracker, level, pose, answer);
      answer.seconds.matching += watch.lap();
      answer.camera_from_station = pose;
      if (level == 0) judge(tracker, answer);
    }
  } catch (const std::exception& error) {
    answer.seconds.matching += watch.lap();
    answer.status = "lost";
    answer.message = error.what();
  }
  return answer;
}

}  // namespace

std::unique_ptr<Peer> makeVispPeer() { return std::make_unique<VispPeer>(); }

}  // namespace boresight::peers
