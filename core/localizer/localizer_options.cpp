// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/localizer_options.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace boresight {
namespace {

/// Whether an option affects the test edges, the rendered edges or the memory size.
bool holdsForWholeRun(std::string_view name) {
  constexpr std::string_view kNames[] = {"templates.count",        "refinement.enabled",
                                         "refinement.max_samples", "loop.coarse_size_px",
                                         "loop.halved_size_px",    "loop.max_rolled_hypotheses",
                                         "loop.correction_point"};
  return name.starts_with("edges.") || name.starts_with("render.") || name.starts_with("search.") ||
         std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

/// Calls `visit` with the name of every option that differs.
template <class Visitor>
void visitDifferences(const LocalizerOptions& before, const LocalizerOptions& after,
                      Visitor&& visit) {
  const OptionValues values(before);
  std::size_t at = 0;
  LocalizerOptions::visitFields(after, [&](const OptionInfo& info, const auto& field) {
    const bool known = at < OptionValues::kMost;
    if (!known || values.value[at] != static_cast<double>(field)) visit(info.name);
    ++at;
  });
}

}  // namespace

bool sameOptions(const LocalizerOptions& first, const LocalizerOptions& second) {
  bool same = true;
  visitDifferences(first, second, [&same](const char*) { same = false; });
  return same;
}

const char* firstFixedOption(const LocalizerOptions& before, const LocalizerOptions& after) {
  const char* fixed = nullptr;
  visitDifferences(before, after, [&fixed](const char* name) {
    if (fixed == nullptr && holdsForWholeRun(name)) fixed = name;
  });
  return fixed;
}

LocalizationProblem withoutUnusedInputs(LocalizationProblem problem,
                                        const LocalizerOptions& options) {
  if (!options.search.enabled || !options.search.color) problem.color = {};
  if (options.loop.correction_point != CorrectionPoint::kEndEffector)
    problem.end_effector_in_camera_m.setZero();
  return problem;
}

LocalizerOptions defaultProfile() { return {}; }

LocalizerOptions paperProfile() {
  LocalizerOptions options;
  options.render.max_edge_pixels = 150000;  // of the whole resolution
  options.templates.size_factor = 1.0;
  options.pnp.sampler = PnpSampler::kEpnp;
  options.pnp.max_samples = 5000;  // a sample of five is seldom free of outliers
  options.loop.match_iterations = options.loop.max_iterations;
  options.loop.coarse_size_px = 16384;
  options.loop.halved_size_px = 16384;
  options.loop.max_rolled_hypotheses = 1;
  options.loop.max_attempts = 1;
  options.loop.converged_image_px = 0.0;
  options.loop.enough_inliers = 2.0;
  options.loop.render_again_px = 0.0;
  options.loop.anchored = false;
  // The pose is known to 75 mm (Sec. I); the search area begins with 30 mm (Sec. III-A).
  options.loop.leave_factor = 2.5;
  options.loop.subpixel_matches = false;
  options.refinement.enabled = false;
  options.support.gate = false;
  options.search.enabled = false;
  return options;
}

}  // namespace boresight
