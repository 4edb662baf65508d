// SPDX-License-Identifier: Apache-2.0
// What every peer is given and what it answers.
#pragma once

#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "core/geometry/pose.h"
#include "sessions/io/scene_mesh.h"
#include "sessions/run/trace.h"

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

/// A number that a peer can be tuned by.
struct Setting {
  std::string name;  ///< "visp.mask_px"
  double value = 0.0;
  std::string help;  ///< with its unit
};

/// The settings of one peer.
class Settings {
 public:
  explicit Settings(std::vector<Setting> settings) : settings_(std::move(settings)) {}

  const std::vector<Setting>& all() const { return settings_; }
  /// Of one that exists; std::out_of_range otherwise.
  double value(const std::string& name) const;
  int whole(const std::string& name) const { return static_cast<int>(value(name)); }
  /// Takes over what of `values` is this peer's.
  void take(const std::map<std::string, double>& values);

 private:
  std::vector<Setting> settings_;
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

enum class RapidKind { kRapid, kOls, kGos };

/// OpenCV's trackers of silhouettes: RAPID itself, optimal local and global optimal searching. The
/// latter two tell object from background by hue and saturation, and answer nothing without colour.
std::unique_ptr<Peer> makeRapidPeer(RapidKind kind);
/// vpMbGenericTracker with moving edges.
std::unique_ptr<Peer> makeVispPeer();
/// Those that this program was built with.
std::vector<std::unique_ptr<Peer>> builtPeers();

/// Processor time of this process in pieces: what others do on the machine does not count.
class StopWatch {
 public:
  /// Seconds since it was made or last asked.
  double lap() {
    const double now_s = processor_s();
    const double passed_s = now_s - began_s_;
    began_s_ = now_s;
    return passed_s;
  }

 private:
  static double processor_s() {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double began_s_ = processor_s();
};

}  // namespace boresight::peers
