// SPDX-License-Identifier: Apache-2.0
// How a run ended, in words: all sentences about it are here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/math.h"
#include "core/localizer/acceptance.h"
#include "core/refine/edge_refinement.h"
#include "core/render/band_painter.h"
#include "core/templates/template_selection.h"
#include "sessions/io/files/least_known.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"
#include "sessions/trace/doubtful_pose.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

using enum LocalizationStatus;

double toDegrees(double angle_rad) { return angle_rad / kDegree_rad; }

/// Whether a pose was found, and accepted or rejected by its evidence. Otherwise the evidence is
/// that of an earlier attempt's pose.
bool wasJudged(LocalizationStatus status) {
  return status == kConverged || status == kNotSupported || status == kAmbiguous ||
         status == kBlurred || status == kCameraMismatch;
}

std::string neededProbability(const LocalizationTrace& trace) {
  return percentText(trace.lastOptions().support.min_probability, 1);
}

std::string neededSupport(const LocalizationTrace& trace) {
  return percentText(trace.lastOptions().support.min_support, 1);
}

std::string supportShare(const LocalizationTrace& trace) {
  return percentText(trace.support.share(), 1);
}

/// Of a run that hasProbability(), for the middle of a sentence: "the probability that the pose is
/// right is 99.1 %, needed 30.0 %: edges show 91 % of the evidence ...".
std::string probabilityText(const LocalizationTrace& trace) {
  const PoseEvidence& evidence = trace.evidence;
  return "the probability that the pose is right is " + probabilityPercent(trace.probability) +
         ", needed " + neededProbability(trace) + ": edges show " +
         percentText(std::clamp(evidence.finest().shareOfExpected(), 0.0, 1.0)) +
         " of the evidence that a right pose would have, inside and outside differ along " +
         percentText(evidence.region.separatedShare()) + " of the outline, edge support is " +
         supportShare(trace);
}

/// " It has the most evidence of 3 compared poses and comes from candidate 1 of the search."
std::string comparisonText(const LocalizationTrace& trace) {
  if (trace.best_hypothesis < 0) return "";
  const std::size_t count = trace.hypotheses.size();
  const PoseHypothesis& best = trace.hypotheses[static_cast<std::size_t>(trace.best_hypothesis)];
  return (count == 1
              ? std::string(" It is the only pose found")
              : " It has the most evidence of " + std::to_string(count) + " compared poses") +
         " and comes from " + originText(best) + "." +
         (trace.competitor < 0
              ? ""
              : " The next best pose is lower by a score of " + fixedText(trace.gap, 2) + ".");
}

std::string competingText(const LocalizationTrace& trace) {
  const CompetingPose* closest = closestCompetingPose(trace);
  if (closest == nullptr) return "";
  const std::size_t count = trace.competing_poses.size();
  return (count == 1
              ? std::string(" One competing pose is similar; it is ")
              : " " + std::to_string(count) + " competing poses are similar; the closest is ") +
         timesText(std::abs(closest->margin_nats)) +
         (closest->margin_nats < 0.0 ? " more likely" : " less likely") +
         (closest->mirrored                               ? " and shows the mesh mirrored."
          : trace.converged() && closest->margin_nats < 0 ? ", but outside the seed's uncertainty."
                                                          : ".");
}

/// "in 8 iterations and 2 attempts, 1.25 s."
std::string effortText(const LocalizationTrace& trace) {
  std::string text = "in " + countText(trace.iterations.size(), "iteration");
  if (trace.attempts > 1) text += formatText(" and %d attempts", trace.attempts);
  return text + (trace.replayed ? "." : formatText(", %.2f s.", trace.seconds.total()));
}

// ---- why a run failed

/// The axis that is furthest beyond its limit.
std::string leftUncertaintyText(const LocalizationTrace& trace) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  const Vector6d offset =
      offsetAboutPivot(trace.camera_from_station_seed, trace.iterations.back()->camera_from_station,
                       trace.uncertainty.pivot_in_camera_m);
  Vector6d allowed;
  allowed << trace.uncertainty.rotation_rad, trace.uncertainty.translation_m;
  int worst = 0;
  offset.cwiseAbs().cwiseQuotient(allowed.cwiseMax(1e-12)).maxCoeff(&worst);
  const bool turned = worst < 3;
  const auto shown = [turned](double value) {
    return turned ? toDegrees(value) : kMillimetres * value;
  };
  const char* unit = turned ? "deg" : "mm";
  const double factor = trace.lastOptions().loop.leave_factor;
  const double box = shown(allowed[worst]);
  return "the pose left the seed's uncertainty: it moved by " +
         formatText("%.2f %s %s %s, allowed %.2f %s (%.2f x %.2f)", shown(std::abs(offset[worst])),
                    unit, turned ? "about" : "along", kAxes[worst % 3], factor * box, unit, factor,
                    box) +
         "; check seed and mesh, or state a larger uncertainty";
}

std::string pnpFailedText(const LocalizationTrace& trace, const IterationTrace& last) {
  if (last.kind == IterationKind::kRefine)
    return formatText(
        "too few image edges near the rendered edges: refinement found %d of %d and used %d, "
        "needed %d within %.1f px; check exposure, focus and seed",
        last.refinement.found_count, last.refinement.sample_count, last.refinement.used_count,
        EdgeRefinement::kMinFound, last.threshold_px);
  return formatText(
      "too few inliers: %d matches, at most %d inliers at %.1f px, needed %d; check seed, "
      "uncertainty and image edges",
      last.correspondence_count, last.pnp.inlier_count, last.threshold_px,
      trace.lastOptions().pnp.min_inliers);
}

/// Whether what a render needs has exceeded a capacity.
bool isCapacity(Status fault) {
  return fault == Status::kCapacityExceeded || fault == Status::kTooManyLayers;
}

/// What a render exceeds, and what to do.
std::string capacityText(const LocalizationTrace& trace) {
  if (trace.fault == Status::kTooManyLayers)
    return formatText(
        "more than %d faces of the mesh overlap in an image row: use a coarser mesh, or its outer "
        "surfaces only",
        static_cast<int>(BandPainter::kMostLayers));
  return formatText(
      "the render has more than %d edge pixels: raise render.max_edge_pixels, or check the mesh",
      trace.lastOptions().render.max_edge_pixels);
}

/// Of a run that a capacity did not end: the poses that it could not compare.
std::string leftOutText(const LocalizationTrace& trace) {
  if (trace.status == LocalizationStatus::kFault || !isCapacity(trace.fault)) return "";
  return " Poses were left out of the comparison: " + capacityText(trace) + ".";
}

std::string faultText(const LocalizationTrace& trace) {
  const LocalizerOptions& options = trace.lastOptions();
  if (trace.fault == Status::kInvalidOption &&
      options.loop.correction_point == CorrectionPoint::kEndEffector)
    return "loop.correction_point is end_effector, but no end effector is known: state "
           "camera_from_end_effector of the case, or choose another point";
  const std::string text = std::string("the run stopped: ") + statusText(trace.fault);
  if (isCapacity(trace.fault)) return text + "; " + capacityText(trace);
  if (trace.fault == Status::kMemoryChanged)
    return text +
           "; a bit of the inputs or of tables derived from them flipped in memory: run again";
  if (trace.fault == Status::kArenaTooSmall)
    return text + formatText(
                      "; image, mask and mesh take %zu bytes and the options need %zu more, of "
                      "%zu: lower render.max_edge_pixels or loop.coarse_size_px, or use a coarser "
                      "mesh or the default profile",
                      trace.memory.inputs, trace.memory.use.total(), trace.memory.limit);
  return text;
}

std::string notSupportedText(const LocalizationTrace& trace) {
  if (doubtfulPose(trace)) return probabilityText(trace) + ". " + doubtfulPoseText(trace);
  if (hasProbability(trace))
    return probabilityText(trace) + "; check mesh and camera, or state a larger uncertainty";
  const EdgeSupport& support = trace.support;
  return "the pose is probably wrong: edge support is " + supportShare(trace) + ", needed " +
         neededSupport(trace) + "; " + percentText(support.coverage(), 1) +
         " of the rendered edges are seen (" + percentText(support.chanceCoverage(), 1) +
         " by chance), " + percentText(support.explanation(), 1) +
         " of the edges seen on the object are rendered (" +
         percentText(support.chanceExplanation(), 1) + " by chance); check seed and mesh";
}

/// "12.0 mm and 3.00 deg away" from the run's last pose.
std::string awayText(const LocalizationTrace& trace, const Pose& camera_from_station) {
  const Pose& best = trace.iterations.back()->camera_from_station;
  const Eigen::Quaterniond turn =
      (camera_from_station.rotation * best.rotation.conjugate()).normalized();
  return formatText("%.1f mm and %.2f deg away",
                    kMillimetres * (camera_from_station.translation_m - best.translation_m).norm(),
                    toDegrees(rotationLog(turn).norm()));
}

/// Of a run whose next best pose has about the same score.
std::string closeScoresText(const LocalizationTrace& trace) {
  const PoseHypothesis& other = trace.hypotheses[static_cast<std::size_t>(trace.competitor)];
  return "another pose, " + awayText(trace, other.camera_from_station) +
         formatText(
             ", has about the same evidence: its score is lower by %.2f, needed %.2f; show more "
             "distinct features, give a closer seed, or add a view",
             trace.gap, kLeastGap);
}

std::string ambiguousText(const LocalizationTrace& trace) {
  const CompetingPose* other = closestCompetingPose(trace);
  if (other == nullptr)
    return trace.competitor >= 0 ? closeScoresText(trace)
                                 : "a competing pose explains the image as well";
  if (other->mirrored)
    return "the mirror image of the mesh is " + timesText(-other->margin_nats) +
           " more likely; check that the mesh is not mirrored";
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
  return formatText(
      "the image is blurred: its edges on the object are %.1f px wide %s, limit %.0f px; use a "
      "sharper image",
      trace.edge_width.widest_px(), kAcross[widest], EdgeWidth::kWidest_px);
}

std::string cameraMismatchText(const LocalizationTrace& trace) {
  const double percent = 100.0 * trace.focal.change;
  return formatText(
      "the focal length estimated from the edges is %.1f %% %s than the camera's (one sigma %.2f "
      "%%); check calibration and mesh proportions",
      std::abs(percent), percent < 0.0 ? "shorter" : "longer", 100.0 * trace.focal.sigma);
}

std::string iterationLimitText(const LocalizationTrace& trace, const IterationTrace& last) {
  const LoopOptions& loop = trace.lastOptions().loop;
  return formatText(
      "the iteration limit of %d is reached: the last correction is %.3f mm and %.3f deg, needed "
      "under %.3f mm and %.3f deg %d times in a row; raise loop.max_iterations if corrections "
      "still shrink",
      loop.max_iterations, kMillimetres * last.correction_translation_m,
      toDegrees(last.correction_rotation_rad), kMillimetres * loop.converged_translation_m,
      toDegrees(loop.converged_rotation_rad), loop.converged_iterations);
}

std::string tooFewMatchesText(const LocalizationTrace& trace, const IterationTrace& last) {
  const int needed = trace.lastOptions().pnp.min_inliers;
  if (last.template_count == 0)  // another method matched, without templates
    return formatText("too few matches on the station and in the search window: %d, needed %d",
                      last.correspondence_count, needed);
  return formatText(
      "too few templates inside the image: %d of %d, needed %d; the station may be at the border, "
      "or the template (%d px) too large",
      last.correspondence_count, last.template_count, needed, last.template_side_px);
}

// ---- one line

/// What the operator may doubt of the seed: not a turn that was searched.
std::string seedDoubt(const LocalizationTrace& trace) {
  return searchedEveryTurn(trace)
             ? "Every turn about the view axis was searched: the seed may be tilted or far off."
             : "The seed may be turned or far off.";
}

std::string acceptedSentence(const LocalizationTrace& trace) {
  if (hasProbability(trace))
    return " Probability of the pose " + probabilityPercent(trace.probability) + " (" +
           neededProbability(trace) + " needed).";
  if (!trace.lastOptions().support.gate) return "";
  return " " + supportShare(trace) + " of the edges agree (" + neededSupport(trace) + " needed).";
}

std::string notSupportedSentence(const LocalizationTrace& trace) {
  if (doubtfulPose(trace)) return doubtfulPoseText(trace);
  if (hasProbability(trace))
    return "Probability of the pose " + probabilityPercent(trace.probability) + ", " +
           neededProbability(trace) + " needed. " + seedDoubt(trace);
  const bool chance = trace.support.coverage() <= 1.5 * trace.support.chanceCoverage();
  return (chance ? "The edges fit no better than chance: " : "Too few edges fit: ") +
         supportShare(trace) + " agree, " + neededSupport(trace) + " needed. " + seedDoubt(trace);
}

std::string noPoseSentence(const LocalizationTrace& trace) {
  if (trace.status == kPnpFailed && !trace.iterations.empty() &&
      trace.iterations.back()->kind == IterationKind::kMatch) {
    const IterationTrace& last = *trace.iterations.back();
    return formatText("Only %d of %d matches agree, %d needed.", last.pnp.inlier_count,
                      last.correspondence_count, trace.lastOptions().pnp.min_inliers);
  }
  return asSentence(explanation(trace));
}

// ---- the status

std::string convergedText(const LocalizationTrace& trace) {
  const Vector6d sigma = trace.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  std::string text = "Converged " + effortText(trace);
  if (trace.lastOptions().support.gate) text += " " + acceptanceText(trace);
  text += formatText(
      " 1 sigma by the image only, at the camera, along its x, y, z: %.3f, %.3f, "
      "%.3f mm; about them: %.3f, %.3f, %.3f mrad.",
      kMillimetres * sigma(3), kMillimetres * sigma(4), kMillimetres * sigma(5),
      kMilliradians * sigma(0), kMilliradians * sigma(1), kMilliradians * sigma(2));
  const std::string least_known = leastKnownText(trace.covariance, trace.camera_from_station);
  if (!least_known.empty()) text += " Least known: " + least_known + ".";
  return text + leftOutText(trace);
}

/// With the probability of a pose that was rejected for another reason.
std::string failedText(const LocalizationTrace& trace) {
  std::string text = "Did not converge. " + asSentence(explanation(trace));
  if (hasProbability(trace) && trace.status != kNotSupported)
    text += " " + asSentence(probabilityText(trace));
  return text + leftOutText(trace);
}

/// Labels an onboard run.
std::string replayedText(const LocalizationTrace& trace) {
  const std::string begin = "Onboard record, replayed. ";
  if (trace.converged()) return begin + convergedText(trace);
  if (trace.finished && trace.iterations.empty())
    return begin + "It ended as " + localizationStatusText(trace.status) +
           "; its iterations are unknown.";
  if (trace.finished) return begin + failedText(trace);
  return begin + "It ends after " + countText(trace.iterations.size(), "iteration") +
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

bool anyTookPart(const std::vector<ViewOutcome>& views) {
  return std::ranges::any_of(views, &ViewOutcome::tookPart);
}

/// Why a view has no part in the pose of all, for the middle of a sentence.
std::string leftOutText(const std::string& status) {
  constexpr std::pair<LocalizationStatus, const char*> kReasons[] = {
      {kTooFewEdges, "too few of its edges are rendered or found"},
      {kTooFewTemplates, "too few templates"},
      {kTooFewMatches, "too few of its templates match edges of the image"},
      {kPnpFailed, "too few of its matches or edges agree with the pose of the others"},
      {kNotSupported, "its edge support is below the limit"}};
  for (const auto& [known, reason] : kReasons)
    if (status == localizationStatusText(known)) return reason;
  return status;
}

/// Of one of several views; one that was left out says why, and what is known all the same.
std::string viewText(const LocalizationTrace& trace) {
  const ViewOutcome& own = trace.views[trace.own_view];
  const std::string with = asSentence(togetherText(trace.views, own.case_id)) + " ";
  if (!trace.finished || trace.converged() || !anyTookPart(trace.views))
    return with + aloneText(trace);
  return with + "This view was left out: " + leftOutText(own.status) +
         ". The pose of the others is its last iteration's.";
}

}  // namespace

bool hasProbability(const LocalizationTrace& trace) {
  return trace.evidence.finest().places != 0 && wasJudged(trace.status);
}

const CompetingPose* closestCompetingPose(const LocalizationTrace& trace) {
  const auto& poses = trace.competing_poses;
  // A pose outside the seed's uncertainty may have more evidence: it contradicts by more only.
  const Seed seed{trace.camera_from_station_seed, trace.uncertainty};
  const auto beyond_limit = [&](const CompetingPose& pose) {
    return pose.mirrored
               ? -std::numeric_limits<double>::infinity()
               : pose.margin_nats - leastMargin_nats(pose.camera_from_station, trace.probability,
                                                     seed, trace.lastOptions());
  };
  const auto closest = std::ranges::min_element(poses, {}, beyond_limit);
  return closest == poses.end() ? nullptr : &*closest;
}

std::string timesText(double nats) {
  constexpr double kMostTimes = 1000.0;
  const double times = std::exp(nats);
  if (times > kMostTimes) return "more than 1000 times";
  return fixedText(times, times < 10.0 ? 1 : 0) + " times";
}

std::string doubtfulPoseText(const LocalizationTrace& trace) {
  const std::optional<DoubtfulPose> pose = doubtfulPose(trace);
  if (!pose) return "";
  return "Doubtful pose, probability " + probabilityPercent(pose->probability) + " (" +
         neededProbability(trace) +
         " needed): compare it with the image, and annotate from it if it is right.";
}

std::string originText(const PoseHypothesis& hypothesis) {
  switch (hypothesis.origin) {
    case HypothesisOrigin::kCandidate:
      return formatText("candidate %d of the search", hypothesis.number + 1);
    case HypothesisOrigin::kTemplates:
      return "templates around the first candidate";
    case HypothesisOrigin::kSeed:
      return "templates around the seed";
    case HypothesisOrigin::kRestart:
      break;
  }
  return formatText("restart %d of the best pose", hypothesis.number + 1);
}

std::string acceptanceText(const LocalizationTrace& trace) {
  std::string text;
  if (hasProbability(trace))
    text = asSentence(probabilityText(trace));
  else if (trace.converged())
    text = "Edge support is " + supportShare(trace) + ", needed " + neededSupport(trace) + ".";
  else
    return "";
  if (trace.edge_width.widestDirection() >= 0)
    text += formatText(" The image's edges are %.1f px wide, at most %.0f px are accepted.",
                       trace.edge_width.widest_px(), EdgeWidth::kWidest_px);
  return text + comparisonText(trace) + competingText(trace);
}

std::string explanation(const LocalizationTrace& trace) {
  if (trace.converged()) return "";
  if (trace.status == kRunning) return "the run was stopped";
  if (trace.status == kFault || trace.iterations.empty()) return faultText(trace);
  if (trace.edges && trace.edges->edge_count == 0)
    return "the image has no edges; check its exposure and the options edges.*";
  const IterationTrace& last = *trace.iterations.back();
  switch (trace.status) {
    case kLeftUncertainty:
      return leftUncertaintyText(trace);
    case kPnpFailed:
      return pnpFailedText(trace, last);
    case kNotSupported:
      return notSupportedText(trace);
    case kAmbiguous:
      return ambiguousText(trace);
    case kBlurred:
      return blurredText(trace);
    case kCameraMismatch:
      return cameraMismatchText(trace);
    case kIterationLimit:
      return iterationLimitText(trace, last);
    case kTooFewEdges:
      return formatText(
          "too few salient edges: the render has %d edge pixels, needed %d; check that the station "
          "is in view, and the mesh's unit",
          last.edge_pixel_count, TemplateSelector::kMinEdgePixels);
    case kTooFewTemplates:
      return formatText(
          "too few templates: %d of %d px fit on %d rendered edge pixels, needed %d; use a smaller "
          "feature size or a smaller ignore mask",
          last.template_count, last.template_side_px, last.edge_pixel_count,
          TemplateSelector::kMinCount);
    case kTooFewMatches:
      return tooFewMatchesText(trace, last);
    case kRunning:
    case kConverged:
    case kFault:
      break;
  }
  return "";
}

RunHeadline runHeadline(const LocalizationTrace& trace) {
  if (trace.converged()) return {"Converged", effortText(trace) + acceptedSentence(trace)};
  if (trace.status == kNotSupported) return {"Rejected", notSupportedSentence(trace)};
  return {wasJudged(trace.status) ? "Rejected" : "No pose found", noPoseSentence(trace)};
}

std::string runStatusText(const LocalizationTrace& trace) {
  if (trace.replayed) return replayedText(trace);
  return trace.views.empty() ? aloneText(trace) : viewText(trace);
}

bool searchedEveryTurn(const LocalizationTrace& trace) {
  constexpr double kNearlyHalfTurn_rad = 179.0 * kDegree_rad;
  return trace.uncertainty.rotation_rad.z() >= kNearlyHalfTurn_rad;
}

std::string togetherText(const std::vector<ViewOutcome>& views, const std::string& own_case) {
  const bool converged = anyTookPart(views);
  std::vector<std::string> names;
  for (const ViewOutcome& view : views) {
    if (view.case_id == own_case) continue;
    const bool out = converged && !view.tookPart();
    names.push_back(view.case_id + (out ? " (left out: " + leftOutText(view.status) + ")" : ""));
  }
  return "together with " + listText(names);
}

}  // namespace boresight::sessions
