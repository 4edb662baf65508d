// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/accept/edge_support.h"
#include "core/base/options.h"
#include "core/edges/edge_map.h"
#include "core/localizer/problem.h"
#include "core/localizer/search_options.h"
#include "core/pnp/pnp_options.h"
#include "core/refine/edge_refinement.h"
#include "core/render/edge_render.h"
#include "core/templates/template_selection.h"

namespace boresight {

enum class CorrectionPoint : std::int32_t { kCamera = 0, kStation = 1, kEndEffector = 2 };
inline constexpr const char* kCorrectionPointNames[] = {"camera", "station", "end_effector"};

/// Options of the loop around the stages (Pham 2025, Sec. III-A).
struct LoopOptions {
  std::int32_t max_iterations = 10;
  std::int32_t max_attempts = 3;
  std::int32_t match_iterations = 2;
  std::int32_t coarse_size_px = 640;
  std::int32_t halved_size_px = 512;
  std::int32_t max_rolled_hypotheses = 9;
  double enough_inliers = 0.5;
  double inlier_threshold_px = 8.0;
  double threshold_shrink = 0.5;
  double uncertainty_shrink = 0.5;
  std::int32_t shrink_iterations = 2;
  CorrectionPoint correction_point = CorrectionPoint::kStation;
  double converged_translation_m = 0.0005;
  double converged_rotation_rad = 0.00872664625997;  ///< 0.5 deg
  std::int32_t converged_iterations = 2;
  double converged_image_px = 0.25;
  double render_again_px = 0.25;
  double leave_factor = 1.5;
  bool anchored = true;
  bool subpixel_matches = true;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(
        OptionInfo{"loop.max_iterations", "", 1, 50, "Largest number of iterations of an attempt."},
        self.max_iterations);
    visit(OptionInfo{"loop.max_attempts", "", 1, 3,
                     "Largest number of attempts of a run without a search: from the seed, with "
                     "templates of the same, twice and half the size."},
          self.max_attempts);
    visit(
        OptionInfo{
            "loop.match_iterations", "", 1, 50,
            "Number of iterations that match templates; later ones refine the pose on edges."},
        self.match_iterations);
    visit(
        OptionInfo{
            "loop.coarse_size_px", "px", 64, 16384,
            "The first iteration works at the level whose longer image side is at most this."},
        self.coarse_size_px);
    visit(OptionInfo{"loop.halved_size_px", "px", 64, 16384,
                     "An image whose longer side is more than this starts at half its resolution "
                     "at least."},
          self.halved_size_px);
    visit(
        OptionInfo{"loop.max_rolled_hypotheses", "", 1, 9,
                   "Largest number of renders of the first iteration, rolled about the view axis."},
        self.max_rolled_hypotheses);
    visit(OptionInfo{"loop.enough_inliers", "", 0.0, 2.0,
                     "A first attempt tries no further rolled renders after one with this share of "
                     "inliers among its matches; above 1: it tries all."},
          self.enough_inliers);
    visit(OptionInfo{"loop.inlier_threshold_px", "px", 0.1, 200.0,
                     "RANSAC threshold of the first iteration, in pixels of the full image."},
          self.inlier_threshold_px);
    visit(OptionInfo{"loop.threshold_shrink", "", 0.05, 1.0,
                     "The threshold is multiplied by this at each of the next shrink_iterations."},
          self.threshold_shrink);
    visit(
        OptionInfo{"loop.uncertainty_shrink", "", 0.05, 1.0,
                   "The uncertainty is multiplied by this at each of the next shrink_iterations."},
        self.uncertainty_shrink);
    visit(OptionInfo{"loop.shrink_iterations", "", 0, 10,
                     "Iterations that shrink threshold and uncertainty."},
          self.shrink_iterations);
    visit(
        OptionInfo{"loop.correction_point", "", 0, 2,
                   "Where corrections are measured: at the camera's centre, the station's, or the "
                   "end effector.",
                   kCorrectionPointNames},
        self.correction_point);
    visit(OptionInfo{"loop.converged_translation_m", "m", 0.0, 1.0,
                     "A correction below this is small."},
          self.converged_translation_m);
    visit(OptionInfo{"loop.converged_rotation_rad", "rad", 0.0, 3.2,
                     "A correction below this is small."},
          self.converged_rotation_rad);
    visit(OptionInfo{"loop.converged_iterations", "", 1, 10,
                     "Number of consecutive small corrections that end the run."},
          self.converged_iterations);
    visit(OptionInfo{"loop.converged_image_px", "px", 0.0, 100.0,
                     "A correction that moves the scene's box by less in the image is small, too."},
          self.converged_image_px);
    visit(OptionInfo{"loop.render_again_px", "px", 0.0, 100.0,
                     "A refinement keeps the last refinement's render while the scene's box has "
                     "moved by less in the image."},
          self.render_again_px);
    visit(OptionInfo{"loop.anchored", "", 0, 1,
                     "The seed's uncertainty constrains directions that the image leaves open, and "
                     "early poses."},
          self.anchored);
    visit(OptionInfo{"loop.leave_factor", "", 1.0, 10.0,
                     "A pose beyond this multiple of the seed's uncertainty ends the run."},
          self.leave_factor);
    visit(OptionInfo{"loop.subpixel_matches", "", 0, 1, "Parabola through the score's peak."},
          self.subpixel_matches);
  }
};

/// Every parameter of a run.
struct LocalizerOptions {
  EdgeOptions edges;             ///< stage `edges`
  RenderOptions render;          ///< stage `render`
  TemplateOptions templates;     ///< stage `templates`
  PnpOptions pnp;                ///< stage `pnp`
  LoopOptions loop;              ///< the loop around the stages
  RefinementOptions refinement;  ///< the last step, on the image's edges
  SupportOptions support;        ///< acceptance test
  SearchOptions search;          ///< search before the first iteration

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    EdgeOptions::visitFields(self.edges, visit);
    RenderOptions::visitFields(self.render, visit);
    TemplateOptions::visitFields(self.templates, visit);
    PnpOptions::visitFields(self.pnp, visit);
    LoopOptions::visitFields(self.loop, visit);
    RefinementOptions::visitFields(self.refinement, visit);
    SupportOptions::visitFields(self.support, visit);
    SearchOptions::visitFields(self.search, visit);
  }
};

/// Values of all options in the order of the visitor.
struct OptionValues {
  static constexpr std::size_t kMost = 160;  ///< largest number of options
  std::array<double, kMost> value{};         ///< by option; the rest 0
  std::size_t count = 0;                     ///< number of options, also beyond kMost

  /// Takes the values of all options.
  explicit OptionValues(const LocalizerOptions& options) {
    LocalizerOptions::visitFields(options, [this](const OptionInfo&, const auto& field) {
      if (count < kMost) value[count] = static_cast<double>(field);
      ++count;
    });
  }
};

/// The problem without colour and end effector when the run does not use them.
LocalizationProblem withoutUnusedInputs(LocalizationProblem problem,
                                        const LocalizerOptions& options);

bool sameOptions(const LocalizerOptions& first, const LocalizerOptions& second);
/// The first option that differs and holds for a whole run, or nullptr: test edges are detected and
/// memory is laid out once.
const char* firstFixedOption(const LocalizerOptions& before, const LocalizerOptions& after);

/// The loop of Pham 2025, Sec. III-A and III-B: full resolution from the start, whole-pixel peaks,
/// EPnP with RANSAC, no search, no refinement on edges, no acceptance test. Choices that the paper
/// leaves open: resources/evidence/paper.md.
LocalizerOptions paperProfile();
/// Recommended settings.
LocalizerOptions defaultProfile();

}  // namespace boresight
