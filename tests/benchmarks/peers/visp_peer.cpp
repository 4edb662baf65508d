// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/peer.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "tests/benchmarks/peers/visp_tracker.h"
#include "tests/benchmarks/peers/wire_model.h"

namespace boresight::peers {
namespace {

constexpr double kSide_px = 640.0;

/// Inverse depth of the nearest face in each pixel; 0 where there is none.
class DepthImage {
 public:
  explicit DepthImage(const PinholeImage& image)
      : scale_(std::min(1.0, kSide_px / std::max(image.gray.cols, image.gray.rows))),
        inverse_(cv::Mat::zeros(static_cast<int>(image.gray.rows * scale_),
                                static_cast<int>(image.gray.cols * scale_), CV_64F)),
        image_(&image) {}

  /// x, y px and inverse depth 1/m; inverse depth 0 behind the camera.
  Eigen::Vector3d project(const Eigen::Vector3d& point_in_camera_m) const {
    const double depth_m = point_in_camera_m.z();
    if (depth_m < 1e-3) return Eigen::Vector3d::Zero();
    return {scale_ * (image_->fx * point_in_camera_m.x() / depth_m + image_->cx),
            scale_ * (image_->fy * point_in_camera_m.y() / depth_m + image_->cy), 1.0 / depth_m};
  }

  void draw(const std::array<Eigen::Vector3d, 3>& corner) {
    if (corner[0].z() == 0.0 || corner[1].z() == 0.0 || corner[2].z() == 0.0) return;
    const double area = cross(corner[0], corner[1], corner[2]);
    if (std::abs(area) < 1e-9) return;
    const auto [left, right] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    const auto [top, bottom] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    const int last_x = static_cast<int>(std::min(right, inverse_.cols - 1.0));
    const int last_y = static_cast<int>(std::min(bottom, inverse_.rows - 1.0));
    for (int y = static_cast<int>(std::max(top, 0.0)); y <= last_y; ++y)
      for (int x = static_cast<int>(std::max(left, 0.0)); x <= last_x; ++x) {
        const Eigen::Vector3d pixel(x, y, 0.0);
        const double a = cross(pixel, corner[1], corner[2]) / area;
        const double b = cross(corner[0], pixel, corner[2]) / area;
        if (a < 0.0 || b < 0.0 || a + b > 1.0) continue;
        double& held = inverse_.at<double>(y, x);
        held =
            std::max(held, a * corner[0].z() + b * corner[1].z() + (1.0 - a - b) * corner[2].z());
      }
  }

  bool sees(const Eigen::Vector3d& point_in_camera_m) const {
    const Eigen::Vector3d place = project(point_in_camera_m);
    if (place.z() == 0.0 || place.x() < 0.0 || place.y() < 0.0 || place.x() > inverse_.cols - 1.0 ||
        place.y() > inverse_.rows - 1.0)
      return false;
    const double nearest = inverse_.at<double>(static_cast<int>(std::lround(place.y())),
                                               static_cast<int>(std::lround(place.x())));
    return nearest == 0.0 || 1.0 / nearest > 0.99 * point_in_camera_m.z() - 1e-3;
  }

 private:
  static double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  }

  double scale_;
  cv::Mat inverse_;
  const PinholeImage* image_;
};

/// Keeps the lines of a model that are seen from a pose: at least two of three places on a line lie
/// inside the image and not behind a face of the model (by more than 1 mm and 1 % of their depth;
/// faces are drawn into a depth image of 640 px).
void keepVisibleLines(const PinholeImage& image, const Pose& camera_from_station,
                      WireModel& model) {
  std::vector<Eigen::Vector3d> points_in_camera_m;
  for (const Eigen::Vector3d& point : model.points_m)
    points_in_camera_m.push_back(camera_from_station * point);
  const auto at = [&](int index) { return points_in_camera_m[static_cast<std::size_t>(index)]; };
  DepthImage depth(image);
  for (const auto& face : model.faces)
    depth.draw(
        {depth.project(at(face[0])), depth.project(at(face[1])), depth.project(at(face[2]))});
  std::erase_if(model.lines, [&](const std::array<int, 2>& line) {
    int seen = 0;
    for (const double along : {0.2, 0.5, 0.8})
      seen += depth.sees((1.0 - along) * at(line[0]) + along * at(line[1])) ? 1 : 0;
    return seen < 2;
  });
}

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
