// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/peer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/rapid.hpp>

namespace boresight::peers {
namespace {

struct CvMesh {
  cv::Mat points;     ///< N x 1, CV_32FC3
  cv::Mat triangles;  ///< N x 1, CV_32SC3, counter-clockwise from outside
};

constexpr double kSidesOfMesh = 40.0;
constexpr int kSplits = 6;

/// Splits a triangle into four until no side is longer than `longest_m`.
void addTriangle(const std::array<cv::Point3f, 3>& corner, double longest_m, int splits,
                 std::vector<cv::Point3f>& points, std::vector<cv::Vec3i>& triangles) {
  const std::array<cv::Point3f, 3> middle = {(corner[0] + corner[1]) * 0.5F,
                                             (corner[1] + corner[2]) * 0.5F,
                                             (corner[2] + corner[0]) * 0.5F};
  const double side_m = std::max({cv::norm(corner[0] - corner[1]), cv::norm(corner[1] - corner[2]),
                                  cv::norm(corner[2] - corner[0])});
  if (splits == 0 || side_m <= longest_m) {
    const int first = static_cast<int>(points.size());
    points.insert(points.end(), corner.begin(), corner.end());
    triangles.emplace_back(first, first + 1, first + 2);
    return;
  }
  for (const auto& part :
       {std::array{corner[0], middle[0], middle[2]}, std::array{middle[0], corner[1], middle[1]},
        std::array{middle[2], middle[1], corner[2]}, middle})
    addTriangle(part, longest_m, splits - 1, points, triangles);
}

/// Matched parts only: what merely hides would lend its outline to the object. Large triangles are
/// split, as places on the outline are interpolated between vertices that lie on it.
CvMesh cvMesh(const sessions::SceneMesh& scene) {
  std::vector<cv::Point3f> points;
  std::vector<cv::Vec3i> triangles;
  const double longest_m = matchedBounds(scene.view()).diagonal() / kSidesOfMesh;
  for (std::size_t i = 0; i < scene.faces.size(); ++i) {
    if (!scene.parts[scene.part_of_face[i]].match) continue;
    std::array<cv::Point3f, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& vertex =
          scene.vertices_in_station_m[static_cast<std::size_t>(scene.faces[i].vertex[k])];
      corner[k] = {vertex.x(), vertex.y(), vertex.z()};
    }
    addTriangle(corner, longest_m, kSplits, points, triangles);
  }
  return {cv::Mat(points, true), cv::Mat(triangles, true)};
}

struct CvPose {
  cv::Mat rotation;  ///< Rodrigues, 3 x 1
  cv::Mat translation_m;

  explicit CvPose(const Pose& pose) {
    cv::Mat matrix;
    const Eigen::Matrix3d rotation_matrix = pose.matrix();
    cv::eigen2cv(rotation_matrix, matrix);
    cv::Rodrigues(matrix, rotation);
    cv::eigen2cv(pose.translation_m, translation_m);
  }
  Pose pose() const {
    cv::Mat matrix;
    cv::Rodrigues(rotation, matrix);
    Eigen::Matrix3d rotation_matrix;
    cv::cv2eigen(matrix, rotation_matrix);
    Pose made;
    made.rotation = Eigen::Quaterniond(rotation_matrix).normalized();
    cv::cv2eigen(translation_m, made.translation_m);
    return made;
  }
};

class RapidPeer : public Peer {
 public:
  explicit RapidPeer(RapidKind kind) : kind_(kind) {}
  std::string name() const override {
    return kind_ == RapidKind::kRapid ? "rapid"
           : kind_ == RapidKind::kOls ? "rapid-ols"
                                      : "rapid-gos";
  }
  std::string version() const override { return "OpenCV " CV_VERSION; }
  Settings& settings() override { return settings_; }
  PeerAnswer localize(const PeerProblem& problem) override;

 private:
  cv::Ptr<cv::rapid::Tracker> tracker(const CvMesh& mesh) const;
  int lengthAt(int pass, int passes) const;
  void runLevel(cv::rapid::Tracker& tracker, const PinholeImage& image, CvPose& pose,
                PeerAnswer& answer) const;

  RapidKind kind_;
  Settings settings_{{
      {"rapid.levels", 4, "resolutions, the coarsest at 1 / 2^(levels - 1)"},
      {"rapid.least_side_px", 480, "no resolution with a shorter side"},
      {"rapid.lines", 200, "search lines around the outline"},
      {"rapid.first_length_px", 6, "search on both sides of it, first pass of a level"},
      {"rapid.last_length_px", 2, "the same, last pass of a level"},
      {"rapid.passes", 20, "searches at each level"},
      {"rapid.good_share", 0.5, "of lines that must have met an edge in the last pass"},
  }};
};

cv::Ptr<cv::rapid::Tracker> RapidPeer::tracker(const CvMesh& mesh) const {
  if (kind_ == RapidKind::kOls) return cv::rapid::OLSTracker::create(mesh.points, mesh.triangles);
  if (kind_ == RapidKind::kGos) return cv::rapid::GOSTracker::create(mesh.points, mesh.triangles);
  return cv::rapid::Rapid::create(mesh.points, mesh.triangles);
}

int RapidPeer::lengthAt(int pass, int passes) const {
  const double first = settings_.value("rapid.first_length_px");
  const double last = settings_.value("rapid.last_length_px");
  if (passes < 2) return static_cast<int>(last);
  return static_cast<int>(std::lround(first * std::pow(last / first, pass / (passes - 1.0))));
}

void RapidPeer::runLevel(cv::rapid::Tracker& tracker, const PinholeImage& image, CvPose& pose,
                         PeerAnswer& answer) const {
  const cv::TermCriteria once(cv::TermCriteria::MAX_ITER, 1, 0.0);
  const int passes = settings_.whole("rapid.passes");
  for (int pass = 0; pass < passes; ++pass) {
    answer.share = static_cast<double>(tracker.compute(
        kind_ == RapidKind::kRapid ? image.gray : image.colour, settings_.whole("rapid.lines"),
        lengthAt(pass, passes), image.cameraMatrix(), pose.rotation, pose.translation_m, once));
    ++answer.iterations;
    if (!pose.pose().isFinite()) return;
  }
}

PeerAnswer RapidPeer::localize(const PeerProblem& problem) {
  PeerAnswer answer;
  answer.camera_from_station = problem.camera_from_station_seed;
  answer.status = "lost";
  if (kind_ != RapidKind::kRapid && problem.image.colour.empty()) {
    answer.message = "needs colour: the image has none";
    return answer;
  }
  StopWatch watch;
  const CvMesh mesh = cvMesh(*problem.scene);
  const cv::Ptr<cv::rapid::Tracker> tracker = this->tracker(mesh);
  CvPose pose(problem.camera_from_station_seed);
  answer.seconds.initialization = watch.lap();
  try {
    for (int level = levelsOf(problem.image, settings_.whole("rapid.levels"),
                              settings_.whole("rapid.least_side_px")) -
                     1;
         level >= 0; --level)
      runLevel(*tracker, atLevel(problem.image, level), pose, answer);
  } catch (const cv::Exception& error) {
    answer.message = error.what();
    return answer;
  }
  answer.seconds.matching = watch.lap();
  const Pose found = pose.pose();
  if (!found.isFinite() || found.translation_m.z() <= 0.0) {
    answer.message = "went out of sight";
    return answer;
  }
  answer.camera_from_station = found;
  answer.completed = answer.share >= settings_.value("rapid.good_share");
  if (answer.completed) answer.status = "converged";
  return answer;
}

}  // namespace

std::unique_ptr<Peer> makeRapidPeer(RapidKind kind) { return std::make_unique<RapidPeer>(kind); }

}  // namespace boresight::peers
