// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "core/base/math.h"
#include "core/localizer/acceptance.h"
#include "core/refine/edge_refinement.h"
#include "core/render/band_painter.h"
#include "core/templates/template_selection.h"
#include "sessions/io/files/least_known.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/acceptance.h"

namespace boresight::sessions {
namespace {

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  std::array<char, 640> text{};
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text.data(), text.size(), pattern, arguments);
  va_end(arguments);
  return text.data();
}

double toDegrees(double angle_rad) { return angle_rad / kDegree_rad; }
double toMillimetres(double length_m) { return length_m * 1e3; }

/// `place` has the origin and the axes.
std::string sigmaText(const Matrix6d& covariance, const std::string& place) {
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, covariance(i, i))); };
  return format(
      "1 sigma at the %s, along and about its x y z: %.4f %.4f %.4f mm, %.4f %.4f %.4f "
      "mrad\n",
      place.c_str(), toMillimetres(sigma(3)), toMillimetres(sigma(4)), toMillimetres(sigma(5)),
      1e3 * sigma(0), 1e3 * sigma(1), 1e3 * sigma(2));
}

/// The axis that is furthest beyond its limit.
std::string leftUncertaintyText(const LocalizationTrace& trace) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  const Pose& last = trace.iterations.back()->camera_from_station;
  const Vector6d offset =
      offsetAboutPivot(trace.camera_from_station_seed, last, trace.uncertainty.pivot_in_camera_m);
  int worst = 0;
  double worst_ratio = -1.0;
  for (int i = 0; i < 6; ++i) {
    const double allowed =
        i < 3 ? trace.uncertainty.rotation_rad[i] : trace.uncertainty.translation_m[i - 3];
    const double ratio = std::abs(offset[i]) / std::max(1e-12, allowed);
    if (ratio > worst_ratio) {
      worst = i;
      worst_ratio = ratio;
    }
  }
  const double factor = trace.lastOptions().loop.leave_factor;
  const std::string measured =
      worst < 3 ? format("%.2f deg about %s, allowed %.2f deg (%.2f x %.2f)",
                         toDegrees(std::abs(offset[worst])), kAxes[worst],
                         factor * toDegrees(trace.uncertainty.rotation_rad[worst]), factor,
                         toDegrees(trace.uncertainty.rotation_rad[worst]))
                : format("%.2f mm along %s, allowed %.2f mm (%.2f x %.2f)",
                         toMillimetres(std::abs(offset[worst])), kAxes[worst - 3],
                         factor * toMillimetres(trace.uncertainty.translation_m[worst - 3]), factor,
                         toMillimetres(trace.uncertainty.translation_m[worst - 3]));
  return "the pose left the seed's uncertainty: it moved by " + measured +
         "; check seed and mesh, or state a larger uncertainty";
}

std::string pnpFailedText(const LocalizationTrace& trace, const IterationTrace& last) {
  if (last.kind == IterationKind::kRefine) {
    return format(
        "too few image edges near the rendered edges: refinement found %d of %d and used %d, "
        "needed %d within %.1f px; check exposure, focus and seed",
        last.refinement.found_count, last.refinement.sample_count, last.refinement.used_count,
        EdgeRefinement::kMinFound, last.threshold_px);
  }
  return format(
      "too few inliers: %d matches, at most %d inliers at %.1f px, needed %d; check seed, "
      "uncertainty and image edges",
      last.correspondence_count, last.pnp.inlier_count, last.threshold_px,
      trace.lastOptions().pnp.min_inliers);
}

std::string faultText(const LocalizationTrace& trace) {
  if (trace.fault == Status::kInvalidOption &&
      trace.lastOptions().loop.correction_point == CorrectionPoint::kEndEffector)
    return "loop.correction_point is end_effector, but no end effector is known: state "
           "camera_from_end_effector in dataset.json, or choose another point";
  std::string text = std::string("the run stopped: ") + statusText(trace.fault);
  if (trace.fault == Status::kCapacityExceeded)
    text += format(
        "; the render has more than %d edge pixels: raise render.max_edge_pixels, or "
        "check the mesh",
        trace.lastOptions().render.max_edge_pixels);
  if (trace.fault == Status::kTooManyLayers)
    text += format(
        "; more than %d faces of the mesh overlap in an image row: use a coarser mesh, or its "
        "outer surfaces only",
        static_cast<int>(BandPainter::kMostLayers));
  if (trace.fault == Status::kMemoryChanged)
    text += "; a bit of the inputs or of tables derived from them flipped in memory: run again";
  if (trace.fault == Status::kArenaTooSmall) {
    text += format(
        "; image, mask and mesh take %zu bytes and the options need %zu more, of %zu: lower "
        "render.max_edge_pixels or loop.coarse_size_px, or use a coarser mesh or the default "
        "profile",
        trace.memory.inputs, trace.memory.use.total(), trace.memory.limit);
  }
  return text;
}

std::string notSupportedText(const LocalizationTrace& trace) {
  if (hasProbability(trace))
    return probabilityText(trace) + "; check mesh and camera, or state a larger uncertainty";
  const EdgeSupport& support = trace.support;
  return format(
      "the pose is probably wrong: edge support is %.1f %%, needed %.1f %%; %.1f %% of the "
      "rendered edges are seen (%.1f %% by chance), %.1f %% of the edges seen on the object are "
      "rendered (%.1f %% by chance); check seed and mesh",
      100.0 * support.share(), 100.0 * trace.lastOptions().support.min_support,
      100.0 * support.coverage(), 100.0 * support.chanceCoverage(), 100.0 * support.explanation(),
      100.0 * support.chanceExplanation());
}

/// "12.0 mm and 3.00 deg away" from the run's last pose.
std::string awayText(const LocalizationTrace& trace, const Pose& camera_from_station) {
  const Pose& best = trace.iterations.back()->camera_from_station;
  const Eigen::Quaterniond turn =
      (camera_from_station.rotation * best.rotation.conjugate()).normalized();
  return format("%.1f mm and %.2f deg away",
                toMillimetres((camera_from_station.translation_m - best.translation_m).norm()),
                toDegrees(rotationLog(turn).norm()));
}

/// Of a run whose next best pose has about the same score.
std::string closeScoresText(const LocalizationTrace& trace) {
  const PoseHypothesis& other = trace.hypotheses[static_cast<std::size_t>(trace.competitor)];
  return "another pose, " + awayText(trace, other.camera_from_station) +
         format(
             ", has about the same evidence: its score is lower by %.2f, needed %.2f; show more "
             "distinct features, give a closer seed, or add a view",
             trace.gap, kLeastGap);
}

std::string ambiguousText(const LocalizationTrace& trace) {
  const CompetingPose* other = closestCompetingPose(trace);
  if (trace.iterations.empty()) return "a competing pose explains the image as well";
  if (other == nullptr)
    return trace.competitor >= 0 ? closeScoresText(trace)
                                 : "a competing pose explains the image as well";
  if (other->mirrored)
    return format(
        "the mirror image of the mesh is %s more likely; check that the mesh is not mirrored",
        timesText(-other->margin_nats).c_str());
  return "a competing pose, " + awayText(trace, other->camera_from_station) +
         ", explains the image " +
         (other->margin_nats < 0.0
              ? "better: it is " + timesText(-other->margin_nats) + " more likely; "
              : "nearly as well: it is " + timesText(other->margin_nats) + " less likely, needed " +
                    timesText(kLeastMargin_nats) + "; ") +
         "both poses look alike: show more distinct features, give a closer seed, state a larger "
         "uncertainty, or check that the mesh is not mirrored";
}

/// The widest edges, measured along their normals.
std::string blurredText(const LocalizationTrace& trace) {
  static constexpr const char* kAcross[kEdgeDirections] = {
      "along x", "22 deg below x", "45 deg below x", "67 deg below x",
      "along y", "67 deg above x", "45 deg above x", "22 deg above x"};
  const int widest = trace.edge_width.widestDirection();
  if (widest < 0) return "the image is too blurred for a pose";
  return format(
      "the image is blurred: its edges on the object are %.1f px wide %s, limit %.0f px; use a "
      "sharper image",
      trace.edge_width.widest_px(), kAcross[widest], EdgeWidth::kWidest_px);
}

std::string cameraMismatchText(const LocalizationTrace& trace) {
  const double percent = 100.0 * trace.focal.change;
  return format(
      "the focal length estimated from the edges is %.1f %% %s than the camera's (one sigma %.2f "
      "%%); check calibration and mesh proportions",
      std::abs(percent), percent < 0.0 ? "shorter" : "longer", 100.0 * trace.focal.sigma);
}

std::string iterationLimitText(const LocalizationTrace& trace, const IterationTrace& last) {
  const LoopOptions& loop = trace.lastOptions().loop;
  return format(
      "the iteration limit of %d is reached: the last correction is %.3f mm and %.3f deg, needed "
      "under %.3f mm and %.3f deg %d times in a row; raise loop.max_iterations if corrections "
      "still shrink",
      loop.max_iterations, toMillimetres(last.correction_translation_m),
      toDegrees(last.correction_rotation_rad), toMillimetres(loop.converged_translation_m),
      toDegrees(loop.converged_rotation_rad), loop.converged_iterations);
}

std::string tooFewText(const LocalizationTrace& trace, const IterationTrace& last) {
  const LocalizerOptions& options = trace.lastOptions();
  if (trace.status == LocalizationStatus::kTooFewEdges)
    return format(
        "too few salient edges: the render has %d edge pixels, needed %d; check that the station "
        "is in view, and the mesh's unit",
        last.edge_pixel_count, TemplateSelector::kMinEdgePixels);
  if (trace.status == LocalizationStatus::kTooFewTemplates)
    return format(
        "too few templates: %d of %d px fit on %d rendered edge pixels, needed %d; use a smaller "
        "feature size or a smaller ignore mask",
        last.template_count, last.template_side_px, last.edge_pixel_count,
        TemplateSelector::kMinCount);
  if (last.template_count == 0)  // another method matched, without templates
    return format("too few matches on the station and in the search window: %d, needed %d",
                  last.correspondence_count, options.pnp.min_inliers);
  return format(
      "too few templates inside the image: %d of %d, needed %d; the station may be at the border, "
      "or the template (%d px) too large",
      last.correspondence_count, last.template_count, options.pnp.min_inliers,
      last.template_side_px);
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  if (text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text.back() == '.' ? text : text + ".";
}

std::string countText(std::size_t count, const char* item, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? item : many);
}

std::string convergedText(const LocalizationTrace& trace) {
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, trace.covariance(i, i))); };
  std::string text =
      "Converged in " + countText(trace.iterations.size(), "iteration", "iterations");
  if (trace.attempts > 1) text += format(" and %d attempts", trace.attempts);
  text += trace.replayed ? "." : format(", %.2f s.", trace.seconds.total());
  if (trace.lastOptions().support.gate) text += " " + acceptanceText(trace);
  text += format(
      " 1 sigma by the image only, at the camera, along its x, y, z: %.3f, %.3f, "
      "%.3f mm; about them: %.3f, %.3f, %.3f mrad.",
      toMillimetres(sigma(3)), toMillimetres(sigma(4)), toMillimetres(sigma(5)), 1e3 * sigma(0),
      1e3 * sigma(1), 1e3 * sigma(2));
  const std::string least_known = leastKnownText(trace.covariance, trace.camera_from_station);
  return least_known.empty() ? text : text + " Least known: " + least_known + ".";
}

/// With the probability of a pose that was rejected for another reason.
std::string failedText(const LocalizationTrace& trace) {
  std::string text = "Did not converge. " + sentence(explanation(trace));
  if (hasProbability(trace) && trace.status != LocalizationStatus::kNotSupported)
    text += " " + sentence(probabilityText(trace));
  return text;
}

/// Labels an onboard run.
std::string replayedText(const LocalizationTrace& trace) {
  const std::string begin = "Onboard record, replayed. ";
  if (trace.converged()) return begin + convergedText(trace);
  if (trace.finished && trace.iterations.empty())
    return begin + "It ended as " + localizationStatusText(trace.status) +
           "; its iterations are unknown.";
  if (trace.finished) return begin + failedText(trace);
  return begin + "It ends after " + countText(trace.iterations.size(), "iteration", "iterations") +
         ": its final status is unknown.";
}

std::string aloneText(const LocalizationTrace& trace) {
  if (trace.converged()) return convergedText(trace);
  if (trace.finished) return failedText(trace);
  if (trace.iterations.empty())
    return trace.edges ? "The image's edges are found." : "The run has begun.";
  const std::string number = std::to_string(trace.iterations.size());
  if (!trace.last_under_way) return "Iteration " + number + " is complete.";
  return "Iteration " + number + ": last complete stage is " +
         stageText(trace.iterations.back()->reached) + ".";
}

/// Of one of several views; one that was left out says why, and what is known all the same.
std::string viewText(const LocalizationTrace& trace) {
  const ViewOutcome& own = trace.views[trace.own_view];
  const std::string with = sentence(togetherText(trace.views, own.case_id)) + " ";
  const bool others = std::any_of(trace.views.begin(), trace.views.end(),
                                  [](const ViewOutcome& view) { return view.tookPart(); });
  if (!trace.finished || trace.converged() || !others) return with + aloneText(trace);
  return with + "This view was left out: " + leftOutText(own.status) +
         ". The pose of the others is its last iteration's.";
}

}  // namespace

std::string iterationTable(const LocalizationTrace& trace) {
  int number = 0;
  TextTable table({"iteration", "attempt", "kind", "level", "templates", "matches", "inliers",
                   "threshold px", "correction mm", "deg", "rms px"});
  for (const auto& shared : trace.iterations) {
    const IterationTrace& iteration = *shared;
    const bool refines = iteration.kind == IterationKind::kRefine;
    table.add({std::to_string(++number), std::to_string(iteration.attempt + 1),
               refines ? "refine" : "match", std::to_string(iteration.level),
               refines ? std::to_string(iteration.refinement.sample_count)
                       : std::to_string(iteration.template_count),
               refines ? std::to_string(iteration.refinement.found_count)
                       : std::to_string(iteration.searched_count),
               std::to_string(iteration.support()), fixedText(iteration.threshold_px, 1),
               fixedText(toMillimetres(iteration.correction_translation_m), 3),
               fixedText(toDegrees(iteration.correction_rotation_rad), 3),
               fixedText(iteration.rms_px(), 2)});
  }
  return table.text() +
         (std::any_of(
              trace.iterations.begin(), trace.iterations.end(),
              [](const auto& iteration) { return iteration->kind == IterationKind::kRefine; })
              ? "(refine: points along rendered edges, points with an image edge, points used)\n"
              : "");
}

std::string poseText(const Pose& pose, const Matrix6d& covariance, const std::string& name,
                     const std::string& place) {
  const Eigen::Vector3d rotation_rad = rotationLog(pose.rotation);
  Eigen::Quaterniond q = pose.rotation;
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const Eigen::Matrix3d matrix = pose.matrix();
  std::string text = plainLine(name);
  for (int row = 0; row < 3; ++row)
    text += format("  %12.9f %12.9f %12.9f %12.9f\n", matrix(row, 0), matrix(row, 1),
                   matrix(row, 2), pose.translation_m[row]);
  text += format("rotation vector %.5f %.5f %.5f deg; quaternion wxyz %.9f %.9f %.9f %.9f\n",
                 toDegrees(rotation_rad.x()), toDegrees(rotation_rad.y()),
                 toDegrees(rotation_rad.z()), q.w(), q.x(), q.y(), q.z());
  const std::string usual = name.starts_with("rig") ? "rig's origin" : "camera";
  if (!covariance.isZero(0.0)) text += sigmaText(covariance, place.empty() ? usual : place);
  return text;
}

std::string explanation(const LocalizationTrace& trace) {
  if (trace.converged()) return "";
  if (trace.status == LocalizationStatus::kRunning) return "the run was stopped";
  if (trace.status == LocalizationStatus::kFault || trace.iterations.empty())
    return faultText(trace);
  if (trace.edges && trace.edges->edge_count == 0)
    return "the image has no edges; check its exposure and the options edges.*";
  const IterationTrace& last = *trace.iterations.back();
  switch (trace.status) {
    case LocalizationStatus::kLeftUncertainty:
      return leftUncertaintyText(trace);
    case LocalizationStatus::kPnpFailed:
      return pnpFailedText(trace, last);
    case LocalizationStatus::kNotSupported:
      return notSupportedText(trace);
    case LocalizationStatus::kAmbiguous:
      return ambiguousText(trace);
    case LocalizationStatus::kBlurred:
      return blurredText(trace);
    case LocalizationStatus::kCameraMismatch:
      return cameraMismatchText(trace);
    case LocalizationStatus::kIterationLimit:
      return iterationLimitText(trace, last);
    case LocalizationStatus::kTooFewEdges:
    case LocalizationStatus::kTooFewTemplates:
    case LocalizationStatus::kTooFewMatches:
      return tooFewText(trace, last);
    case LocalizationStatus::kRunning:
    case LocalizationStatus::kConverged:
    case LocalizationStatus::kFault:
      break;
  }
  return "";
}

std::string memoryTable(const LocalizationTrace& trace) {
  const MemoryTrace& memory = trace.memory;
  TextTable table({"memory", "bytes", "high water"});
  const auto add = [&](const char* name, std::size_t bytes, std::size_t high_water) {
    table.add({name, std::to_string(bytes), std::to_string(high_water)});
  };
  const std::size_t lasting = memory.inputs + memory.use.kept;
  add("image, mask, mesh", memory.inputs, memory.inputs);
  add("kept throughout", memory.use.kept, lasting);
  add("construction", memory.use.construction, lasting + memory.use.construction);
  for (std::size_t i = 0; i < memory.use.stage.size(); ++i)
    add(stageText(static_cast<Stage>(i)), memory.use.stage[i], lasting + memory.use.stage[i]);
  std::string text = table.text();
  text += format("all: %zu bytes", memory.total());
  if (memory.limit > 0) text += format(" of %zu", memory.limit);
  return text + "\n";
}

std::string runStatusText(const LocalizationTrace& trace) {
  if (trace.replayed) return replayedText(trace);
  return trace.views.empty() ? aloneText(trace) : viewText(trace);
}

}  // namespace boresight::sessions
