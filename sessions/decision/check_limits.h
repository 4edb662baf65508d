// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/accept/edge_width.h"
#include "core/base/options.h"
#include "sessions/decision/decision.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/json/option_value.h"

namespace boresight::sessions {

/// Limits of the checks, declared once for the panel, the session's file and the command line.
/// Purpose of each limit and source of its value: checks.md.
struct CheckLimits {
  double last_correction_percent = 25.0;
  double inlier_count = 12.0;
  double inlier_ratio_percent = 40.0;
  double inlier_spread_percent = 40.0;
  double inlier_depth_percent = 25.0;
  double border_percent = 40.0;
  double peak_margin_percent = 2.0;
  double sigmas = 3.0;
  double saturated_percent = 75.0;
  double range_gray = 10.0;
  double coverage_percent = 30.0;
  double clutter_percent = 95.0;
  double evidence_percent = 40.0;
  double fall_off_percent = 15.0;
  double edge_width_px = EdgeWidth::kWidest_px;
  double focal_percent = 0.5;
  double centre_px = 4.0;
  double scale_percent = 0.1;
  double agreement_percent = 100.0;
  double convergence_percent = 90.0;
  double competing_percent = 115.0;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    const auto limit = [&visit](auto& field, const char* name, const char* unit, double minimum,
                                double maximum, const char* help) {
      visit(OptionInfo{name, unit, minimum, maximum, help}, field);
    };
    limit(self.last_correction_percent, "check.last_correction_percent", "%", 0.0, 1000.0,
          "Largest last correction relative to the first one, in the image; a first "
          "correction below a pixel counts as a pixel.");
    limit(self.inlier_count, "check.inlier_count", "", 0.0, 10000.0,
          "Least number of inliers of the last matching iteration that led to the pose.");
    limit(self.inlier_ratio_percent, "check.inlier_ratio_percent", "%", 0.0, 100.0,
          "Least share of inliers among the matches of that iteration.");
    limit(self.inlier_spread_percent, "check.inlier_spread_percent", "%", 0.0, 1000.0,
          "Least spread of the inliers in the image in their narrowest direction; 100: "
          "as wide as the station's edges.");
    limit(self.inlier_depth_percent, "check.inlier_depth_percent", "%", 0.0, 1000.0,
          "Least spread of the inliers along the view axis, if the station has depth.");
    limit(self.border_percent, "check.border_percent", "%", 0.0, 100.0,
          "Largest share of matches on the border of their search window, beyond which "
          "the true position may lie.");
    limit(self.peak_margin_percent, "check.peak_margin_percent", "%", 0.0, 100.0,
          "Least median, over the inliers, of the margin between best and second-best score.");
    limit(self.sigmas, "check.sigmas", "", 0.0, 100.0,
          "Number of standard deviations of the pose that must fit into the requirement.");
    limit(self.saturated_percent, "check.saturated_percent", "%", 0.0, 100.0,
          "Largest share of saturated pixels in the box that the station fills.");
    limit(self.range_gray, "check.range_gray", "", 0.0, 255.0,
          "Least range of gray levels in the box that the station fills, from the 1st "
          "to the 99th percentile.");
    limit(self.coverage_percent, "check.coverage_percent", "%", 0.0, 100.0,
          "Least share of the predicted edges that the image shows.");
    limit(self.clutter_percent, "check.clutter_percent", "%", 0.0, 100.0,
          "Largest share of the image's edges on the station that the pose does not predict.");
    limit(self.evidence_percent, "check.evidence_percent", "%", 0.0, 1000.0,
          "Least evidence of the predicted edges beyond chance, relative to that of a "
          "right pose.");
    limit(self.edge_width_px, "check.edge_width_px", "px", 0.5, 100.0,
          "Largest width of the image's edges in the least sharp direction.");
    limit(self.fall_off_percent, "check.fall_off_percent", "%", 0.0, 100.0,
          "Least share of the seen edges that is lost when the pose is displaced in any "
          "direction.");
    limit(self.focal_percent, "check.focal_percent", "%", 0.0, 100.0,
          "Largest significant change of the focal length when estimated from the "
          "edges; where focal_relative is not stated, also the limit of 0.8 sigma.");
    limit(self.centre_px, "check.centre_px", "px", 0.0, 10000.0,
          "Largest significant shift of the principal point when estimated from the "
          "edges; where principal_point_px is not stated, also the limit of 0.8 sigma.");
    limit(self.scale_percent, "check.scale_percent", "%", 0.0, 100.0,
          "Largest significant change of the mesh's scale when estimated from the rig's "
          "baseline.");
    limit(self.agreement_percent, "check.agreement_percent", "%", 0.0, 10000.0,
          "Largest distance to another pose (annotation, truth, second camera), "
          "relative to requirement and covariances.");
    limit(self.convergence_percent, "check.convergence_percent", "%", 0.0, 100.0,
          "Least share of further seeds that converge to the same pose.");
    limit(self.competing_percent, "check.competing_percent", "%", 0.0, 1000.0,
          "Largest edge coverage of a competing pose or a mirrored station, relative to "
          "that of this pose.");
  }
};

/// Named limits, and the requirement of cases without one.
struct CheckPreset {
  std::string name;
  std::string help;  ///< one sentence: its purpose
  Requirement requirement;
  CheckLimits limits;
};

inline constexpr const char* kDefaultCheckPreset = "sample_transfer";

/// All presets; the default comes first.
const std::vector<CheckPreset>& checkPresets();
/// nullptr when no preset has this name.
const CheckPreset* findCheckPreset(const std::string& name);

/// The first preset whose requirement limits the same figures (pixels for photographs), whatever
/// their values; the default when there is none.
const CheckPreset& presetFor(const Requirement& requirement);

/// A preset's limits with the changes of a session. OptionError when a changed limit does not exist
/// or is out of range; std::invalid_argument when there is no such preset.
CheckLimits checkLimits(const std::string& preset, const OptionList& changed);

/// The limits of another preset; changes to the former limits are dropped. std::invalid_argument
/// when there is no such preset.
ReviewSettings withPreset(const ReviewSettings& settings, const std::string& preset);

/// These limits, stored as differences from the preset. std::invalid_argument when the preset does
/// not exist.
ReviewSettings withLimits(const ReviewSettings& settings, const CheckLimits& limits);

}  // namespace boresight::sessions
