// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// Stands between a localizer whose matches come from outside and the method that makes them: owns
/// the shaded render and the pooled images. Whoever steps the localizer calls `serve()` before each
/// step.
class OutsideMatching {
 public:
  /// Before the localizer's first step; both must outlive the object. MethodError, std::bad_alloc.
  OutsideMatching(Localizer& localizer, MatchingMethod& method, const std::stop_token& stop);

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

  Localizer& localizer_;
  MatchingMethod& method_;
  std::vector<std::uint8_t> intensity_;
  std::vector<float> depth_m_;
  std::array<Picture, kPyramidLevels> images_;
  std::vector<SuppliedMatch> found_;
};

}  // namespace boresight::sessions
