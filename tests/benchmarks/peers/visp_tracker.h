// SPDX-License-Identifier: Apache-2.0
// ViSP behind a wall: its headers are C++17, so that this one and its source are, too, and include
// nothing of the project.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace boresight::peers {

/// What of its tracker is tuned; ViSP's names where they are plain.
struct VispTuning {
  unsigned int mask_px = 5;
  unsigned int mask_count = 180;
  unsigned int range_px = 4;
  double threshold = 0.0;  ///< of the likelihood of an edge
  double mu1 = 0.5;
  double mu2 = 0.5;
  double sample_px = 4.0;
  double good_share = 0.4;
  bool scan_lines = false;        ///< whether it tests by scan lines what is hidden
  double depth_threshold = 1e-4;  ///< of that test, m
};

/// Points in the station frame, metres.
using VispPoint = std::array<double, 3>;

struct VispModel {
  std::vector<std::array<VispPoint, 2>> lines;  ///< to follow; at least one
  std::vector<std::array<VispPoint, 3>> faces;  ///< hide what lies behind them
};

/// 4 x 4, row-major, metres.
using PoseRows = std::array<double, 16>;

/// vpMbGenericTracker by moving edges. Throws vpException, which is a
/// std::exception.
class VispTracker {
 public:
  VispTracker(const VispModel& model, const VispTuning& tuning);
  VispTracker(VispTracker&&) noexcept;
  ~VispTracker();

  static std::string version();

  /// The image (CV_8UC1, kept) and its camera, px.
  void look(const cv::Mat& gray, double fx, double fy, double cx, double cy);
  /// Lays the lines out anew. A tracker begins on the edges of the image before: its measures of
  /// contrast are taken where it begins. From a rough seed there is no such image, so each site is
  /// put onto the strongest edge within `seek_px` along its normal, and contrast measured there.
  void begin(const PoseRows& camera_from_station, unsigned int seek_px);
  void track();

  PoseRows pose() const;
  /// Mean weight of the edge places in the last adjustment.
  double share() const;
  /// Mean angle between lines and gradients, of the last track.
  double projectionError_deg() const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace boresight::peers
