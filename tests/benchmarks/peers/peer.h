// SPDX-License-Identifier: Apache-2.0
// What every peer is given and what it answers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/geometry/pose.h"
#include "sessions/io/scene_mesh.h"
#include "sessions/run/trace.h"
#include "tests/benchmarks/peers/settings.h"

namespace boresight::peers {

/// One image without lens distortion, at one resolution. The centre of the top-left pixel is (0,
/// 0).
struct PinholeImage {
  cv::Mat gray;    ///< CV_8UC1
  cv::Mat colour;  ///< CV_8UC3 (BGR), empty where the file has no colour
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< px

  cv::Matx33d cameraMatrix() const { return {fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0}; }
};

/// The same at 1 / 2^level of the resolution, every pixel the mean of those that it covers.
PinholeImage atLevel(const PinholeImage& image, int level);
/// How many of `levels` resolutions have no side shorter than `least_side_px`; at least 1.
int levelsOf(const PinholeImage& image, int levels, int least_side_px);

struct PeerProblem {
  PinholeImage image;
  const sessions::SceneMesh* scene = nullptr;  ///< station frame, metres
  Pose camera_from_station_seed;
};

struct PeerAnswer {
  std::string status;      ///< "converged", or why not
  std::string message;     ///< in the peer's own words
  bool completed = false;  ///< as far as the peer can tell
  Pose camera_from_station;
  int iterations = 0;
  double share = 0.0;              ///< of its measured places that it used at the end
  sessions::StageSeconds seconds;  ///< initialization: model and images; matching: the rest
};

/// Finds the pose in one image by a program of others.
class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string name() const = 0;
  virtual std::string version() const = 0;
  virtual Settings& settings() = 0;
  /// May throw what the other program throws, loop for ever, or crash: to be run in a guard.
  virtual PeerAnswer localize(const PeerProblem& problem) = 0;
};

/// Those that this program was built with.
std::vector<std::unique_ptr<Peer>> builtPeers();

}  // namespace boresight::peers
