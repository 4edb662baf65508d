// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/options.h"
#include "core/geometry/pose.h"
#include "core/match/whs_types.h"

namespace boresight {

/// Templates searched for turned and scaled, in place of renders rolled as a whole.
struct WarpOptions {
  bool enabled = false;
  double tolerance_px = 3.0;
  std::int32_t max_per_template = 99;
  std::int32_t iterations = 1;

  bool operator==(const WarpOptions&) const = default;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"warp.enabled", "", 0, 1,
                     "Every template is searched for in as many turns and scales as the "
                     "uncertainty asks for at its place; then no rolled renders are tried."},
          self.enabled);
    visit(OptionInfo{"warp.tolerance_px", "px", 0.25, 50.0,
                     "A turn or scale may displace the border of a template by this, in pixels of "
                     "its level, before there is one of its own."},
          self.tolerance_px);
    visit(OptionInfo{"warp.max_per_template", "", 1, 999,
                     "Turns and scales of a template, at most; with more wanted they are wider "
                     "apart."},
          self.max_per_template);
    visit(OptionInfo{"warp.iterations", "", 1, 50, "So many matching iterations warp templates."},
          self.iterations);
  }
};

/// How a template was turned (about the view axis, from x to y) and scaled before it was looked
/// for.
struct TemplateWarp {
  double roll_rad = 0.0;  ///< about the view axis, from x to y
  double scale = 1.0;     ///< above 1: larger in the image
  bool operator==(const TemplateWarp&) const = default;
};

/// The warps of one template, the identity first, then by roll and scale: 0, +1, -1, +2, ... steps.
/// Each serves half a step to either side, and all of them what the uncertainty leaves open.
struct WarpGrid {
  std::int32_t rolls = 1;      ///< odd
  std::int32_t scales = 1;     ///< odd
  double roll_step_rad = 0.0;  ///< between neighbours
  double scale_step = 0.0;     ///< between neighbours, relative

  /// Warps in the grid.
  std::int32_t count() const { return rolls * scales; }
  TemplateWarp at(std::int32_t index) const;  ///< The warp of a number in 0 ... count() - 1.
};

/// What the uncertainty, at a point in the camera frame, asks for: turns by its rotation about the
/// view axis, scales by how much nearer or farther the point may be. A warp is due where the middle
/// of a side of the square would otherwise be displaced by more than the tolerance.
WarpGrid warpGrid(const WarpOptions& options, const SeedUncertainty& uncertainty,
                  const Eigen::Vector3d& point_in_camera_m, int side_px);

/// Room for the bits of one warped template.
class WarpedTemplate {
 public:
  /// Takes the bits of one template of up to this side.
  void create(int max_side_px, Arena& arena);
  /// The template turned and scaled about its centre: every pixel takes the bits of the pixel of
  /// the render that it comes from; what comes from outside the render is not in the mask. The view
  /// lasts until the next call.
  TemplateView warp(const TemplateView& view, const TemplateWarp& warp);

 private:
  BitImage edges_;
  BitImage mask_;
};

}  // namespace boresight
