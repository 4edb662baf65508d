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

/// What a method is asked: where is what the render shows in the image? Everything is at the level
/// of the iteration and lives until the method returns.
struct MatchQuery {
  const Iteration& iteration;  ///< render (edges, mask, camera), templates, hypothesis, uncertainty
  const LocalizerOptions& options;
  ImageView image;  ///< the test image, as read, pooled to the level by means
  /// Shaded render, lit from the camera, each part by its albedo; 0 where nothing is.
  ImageView intensity;
  std::span<const float> depth;      ///< z in m, row by row; 0 where nothing is
  const BitImage* ignore = nullptr;  ///< of the full resolution; may be nullptr

  /// Where the centre of something of this size (px, even) may lie when the hypothesis moves within
  /// the uncertainty; its point in the station's frame.
  SearchWindow windowOf(const Eigen::Vector3d& point_in_station_m, int side_px) const;
  /// 3D point of a place of the render (px); false outside its matched parts.
  [[nodiscard]] bool pointAt(const Eigen::Vector2d& place_px, Template& item) const;
  /// A pixel of the level of which some full-resolution pixel is ignored.
  bool ignored(int x, int y) const;
};

/// A method that cannot go on, as one sentence: it costs the run that it happened in.
class MethodError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Takes part in the localizer's loop in place of WHS: it turns a render and an image into
/// correspondences. Renderer, templates, schedule and pose solver stay the core's. To add one,
/// derive from this, and name it in methods.cpp. One run at a time.
class MatchingMethod {
 public:
  virtual ~MatchingMethod() = default;

  /// Before each run: what was kept of another image is void. Once a stop is asked for, whatever
  /// takes long may end with a MethodError. MethodError.
  virtual void begin(const std::stop_token& stop) { static_cast<void>(stop); }
  /// Fills `found`: either one entry per template of the iteration, in their order (`found` false
  /// where there is no place), or any other items of the render, at most options.templates.count.
  /// MethodError.
  virtual void match(const MatchQuery& query, std::vector<SuppliedMatch>& found) = 0;
  /// Most correspondences that it wants to give; 0: one per template.
  virtual int capacity() const { return 0; }
};

/// Stands between a localizer whose matches come from outside and the method that makes them: owns
/// the shaded render and the pooled images. The caller that steps the localizer calls `serve()`
/// before each step.
class OutsideMatching {
 public:
  /// Before the localizer's first step; both must outlive the object. `albedo_of_part`: of the
  /// problem's mesh, or empty. MethodError, std::bad_alloc.
  OutsideMatching(Localizer& localizer, MatchingMethod& method,
                  std::span<const double> albedo_of_part, const std::stop_token& stop);

  OutsideMatching(const OutsideMatching&) = delete;
  OutsideMatching& operator=(const OutsideMatching&) = delete;

  /// Has the method match when the localizer waits for it. MethodError.
  void serve();

 private:
  struct Picture {
    std::vector<std::uint8_t> gray;
    int width = 0, height = 0;
    ImageView view() const { return {gray.data(), width, height, width}; }
  };
  const Picture& imageAt(int level);
  void shadeByAlbedo(std::size_t pixels);

  Localizer& localizer_;
  MatchingMethod& method_;
  std::vector<std::uint8_t> intensity_;
  std::vector<float> depth_m_;
  std::vector<double> relative_albedo_;  ///< of each part, the brightest is 1; empty: all alike
  std::vector<std::int32_t> face_;       ///< empty with relative_albedo_
  std::array<Picture, kPyramidLevels> images_;
  std::vector<SuppliedMatch> found_;
};

}  // namespace boresight::sessions
