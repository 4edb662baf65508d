// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

enum class TurnAxis : std::int32_t { kView = 0, kStationX = 1, kStationY = 2, kStationZ = 3 };
inline constexpr const char* kTurnAxisNames[] = {"view", "station_x", "station_y", "station_z"};

/// The search before the first iteration, for seeds far off: restarts turned about an axis and
/// moved in depth, each with one iteration at low resolution; the best by evidence go on. Off as
/// long as both ranges are 0.
struct WideOptions {
  double rotation_rad = 0.0;
  TurnAxis rotation_axis = TurnAxis::kView;
  double rotation_spacing_rad = 0.139626340159546;  ///< 8 deg
  double translation_m = 0.0;
  double depth_spacing = 0.1;
  std::int32_t size_px = 320;
  std::int32_t max_restarts = 128;
  std::int32_t finalists = 3;

  /// Whether anything is searched beyond the seed's own uncertainty.
  bool isOn() const { return rotation_rad > 0.0 || translation_m > 0.0; }
  bool operator==(const WideOptions&) const = default;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"wide.rotation_rad", "rad", 0.0, 3.15,
                     "Restarts cover turns up to this to either side (pi: a full turn), or the "
                     "seed's uncertainty about the axis where that is larger; 0: none."},
          self.rotation_rad);
    visit(OptionInfo{"wide.rotation_axis", "", 0, 3,
                     "What restarts are turned about: the ray to the station's middle, or an axis "
                     "of the station through it.",
                     kTurnAxisNames},
          self.rotation_axis);
    visit(OptionInfo{"wide.rotation_spacing_rad", "rad", 0.02, 3.15,
                     "Angle between turned restarts, at most, unless there would be too many."},
          self.rotation_spacing_rad);
    visit(OptionInfo{"wide.translation_m", "m", 0.0, 100.0,
                     "Restarts cover translations up to this along each axis of the camera, or the "
                     "seed's uncertainty where that is larger; 0: the seed's, in one depth."},
          self.translation_m);
    visit(OptionInfo{"wide.depth_spacing", "", 0.02, 2.0,
                     "Distance between restarts in depth, as a share of the depth, at most."},
          self.depth_spacing);
    visit(OptionInfo{"wide.size_px", "px", 64, 16384,
                     "Restarts match at the level whose longer image side is at most this, or at "
                     "that of the first iteration where it is coarser."},
          self.size_px);
    visit(OptionInfo{"wide.max_restarts", "", 1, 512,
                     "Restarts, at most; with more wanted, turned ones are spaced wider."},
          self.max_restarts);
    visit(OptionInfo{"wide.finalists", "", 1, 9,
                     "So many of the restarts, the best by evidence, go on to the level of the "
                     "first iteration; further attempts go on with the next best of them."},
          self.finalists);
  }
};

}  // namespace boresight
