// SPDX-License-Identifier: Apache-2.0
// ViSP behind a wall: its headers are C++17, so that this one and its source are, too, and include
// nothing of the project.
#pragma once

#include <array>
#include <memory>
#include <string>

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
  double depth_threshold = 1e-4;  ///< of the scan line visibility test
};

/// Names in the model's file: of lines to follow, and of faces that only hide.
inline constexpr const char* kVispLine = "line";
inline constexpr const char* kVispFace = "face";

/// 4 x 4, row-major, metres.
using PoseRows = std::array<double, 16>;

/// vpMbGenericTracker by moving edges, with scan line visibility. Throws vpException, which is a
/// std::exception.
class VispTracker {
 public:
  /// Reads a model (.cao).
  VispTracker(const std::string& model_file, const VispTuning& tuning);
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
