// SPDX-License-Identifier: Apache-2.0
#include "sessions/decision/check_limits.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

CheckPreset sampleTransfer() {
  CheckPreset preset;
  preset.name = kDefaultCheckPreset;
  preset.help = "Insertion of a sample tube: 0.4 mm and 0.25 deg.";
  preset.requirement.normal_mm = 0.4;
  preset.requirement.lateral_mm = 0.4;
  preset.requirement.rotation_deg = 0.25;
  // Rendered stations show nearly all of their edges: 120 % and more.
  preset.limits.evidence_percent = 70.0;
  return preset;
}

CheckPreset photographs() {
  CheckPreset preset;
  preset.name = "photographs";
  preset.help = "Photographs with truth and calibration good to a few pixels.";
  preset.requirement.projection_px = 5.0;
  // Meshes of toys and castings, glossy or printed surfaces: less is seen, more is not predicted.
  preset.limits.inlier_ratio_percent = 14.0;
  preset.limits.coverage_percent = 25.0;
  preset.limits.clutter_percent = 97.0;
  preset.limits.evidence_percent = 25.0;
  preset.limits.fall_off_percent = 8.0;
  // Printed boxes and things that look alike from many sides are hard to find.
  preset.limits.convergence_percent = 30.0;
  return preset;
}

}  // namespace

const std::vector<CheckPreset>& checkPresets() {
  static const std::vector<CheckPreset> presets = {sampleTransfer(), photographs()};
  return presets;
}

const CheckPreset* findCheckPreset(const std::string& name) {
  const auto& all = checkPresets();
  const auto found = std::ranges::find(all, name, &CheckPreset::name);
  return found == all.end() ? nullptr : &*found;
}

const CheckPreset& presetFor(const Requirement& requirement) {
  const auto names = [](const Requirement& item) {
    return std::array{item.normal_mm.has_value(), item.lateral_mm.has_value(),
                      item.rotation_deg.has_value(), item.projection_px.has_value()};
  };
  const auto& all = checkPresets();
  const auto found = std::ranges::find_if(all, [&](const CheckPreset& preset) {
    return names(preset.requirement) == names(requirement);
  });
  return found == all.end() ? all.front() : *found;
}

CheckLimits checkLimits(const std::string& preset, const OptionList& changed) {
  const CheckPreset* found = findCheckPreset(preset);
  if (found == nullptr) throw std::invalid_argument("there is no preset '" + preset + "'");
  CheckLimits limits = found->limits;
  for (const auto& [name, value] : changed) applyOption(limits, name, value);
  return limits;
}

ReviewSettings withPreset(const ReviewSettings& settings, const std::string& preset) {
  (void)checkLimits(preset, {});  // it exists
  return {preset, {}, settings.second_person};
}

ReviewSettings withLimits(const ReviewSettings& settings, const CheckLimits& limits) {
  ReviewSettings next = settings;
  next.limits = changedOptions(limits, checkLimits(settings.preset, {}));
  std::ranges::sort(next.limits, {}, &OptionList::value_type::first);
  return next;
}

}  // namespace boresight::sessions
