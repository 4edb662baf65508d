// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include "core/base/image.h"
#include "core/localizer/localizer.h"

namespace boresight::sessions {

/// Input of a matching method, which finds features of the render in the image. All data is at the
/// level of the iteration and valid until the method returns.
struct MatchQuery {
  const Iteration& iteration;  ///< render (edges, mask, camera), templates, hypothesis, uncertainty
  const LocalizerOptions& options;
  ImageView image;  ///< the test image, as read, pooled to the level by means
  /// Shaded render, lit from the camera, each part by its albedo; 0 for background.
  ImageView intensity;
  std::span<const float> depth;      ///< z in m, row by row; 0 for background
  const BitImage* ignore = nullptr;  ///< of the full resolution; may be nullptr

  /// Search window for the centre of a square of this side (px, even) around a point of the
  /// station, when the hypothesis moves within the uncertainty.
  SearchWindow windowOf(const Eigen::Vector3d& point_in_station_m, int side_px) const;
  /// 3D point of a position in the render (px); false outside its matched parts.
  [[nodiscard]] bool pointAt(const Eigen::Vector2d& place_px, Template& item) const;
  /// Whether any full-resolution pixel of a pixel of the level is ignored.
  bool ignored(int x, int y) const;
};

/// Failure of a method, as one sentence: the run in which it happened is lost.
class MethodError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Replaces WHS in the localizer's loop: computes correspondences between a render and an image.
/// Renderer, templates, schedule and pose solver are the core's. To add a method, derive from this
/// class, and name it in methods.cpp. One run at a time.
class MatchingMethod {
 public:
  virtual ~MatchingMethod() = default;

  /// Called before each run: drops data of another image. After a stop request, long operations may
  /// end with a MethodError. MethodError.
  virtual void begin(const std::stop_token& stop) { static_cast<void>(stop); }
  /// Fills `found`: either one entry per template of the iteration, in their order (`found` false
  /// where there is no place), or any other items of the render, at most options.templates.count.
  /// MethodError.
  virtual void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) = 0;
  /// Largest number of correspondences returned; 0: one per template.
  virtual int capacity() const { return 0; }
};

/// Connects a localizer whose matches come from outside to the method that computes them: owns the
/// shaded render and the pooled images. The caller that steps the localizer calls `serve()` before
/// each step.
class OutsideMatching {
 public:
  /// Call before the localizer's first step; both must outlive the object. `albedo_of_part`: of the
  /// problem's mesh, or empty. MethodError, std::bad_alloc.
  OutsideMatching(Localizer& localizer, MatchingMethod& method,
                  std::span<const double> albedo_of_part, const std::stop_token& stop);

  OutsideMatching(const OutsideMatching&) = delete;
  OutsideMatching& operator=(const OutsideMatching&) = delete;

  /// Runs the method when the localizer waits for matches. MethodError.
  void serve();

 private:
  ImageView imageAt(int level);
  void shadeByAlbedo(std::size_t pixels);

  Localizer& localizer_;
  MatchingMethod& method_;
  std::vector<std::uint8_t> intensity_;
  std::vector<float> depth_m_;
  std::vector<double> relative_albedo_;  ///< of each part, the brightest is 1; empty: all alike
  std::vector<std::int32_t> face_;       ///< empty with relative_albedo_
  /// Pooled images by level; empty until they are needed.
  std::array<std::vector<std::uint8_t>, kPyramidLevels> images_;
  std::vector<SuppliedMatch> found_;
};

}  // namespace boresight::sessions
