// SPDX-License-Identifier: Apache-2.0
// After a pose has converged: the others under which the model's edges look like themselves. Each
// starts like the last iteration that matches, within a box that does not reach the next, and goes
// on to its end as from any seed; of two that are borne out the one with more evidence leads on.
// The lead's last iteration is done again at the end, so that what the run ends with is its own.
#include <algorithm>
#include <cmath>

#include "core/localizer/localizer.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"

namespace boresight {

void Localizer::layOutRivals() {
  lead_render_ = createRender(fine_level_);
  const Camera camera = cameraAtLevel(problem_.camera, fine_level_);
  similarity_.create(camera.width, camera.height, kept_);
  rivals_ = kept_.allocate<Rival>(static_cast<std::size_t>(options_.ambiguity.max_rivals));
}

bool Localizer::weighsRivals() const {
  return options_.ambiguity.enabled && rival_round_ != RivalRound::kReturn;
}

bool Localizer::isInSeedsBox(const Pose& camera_from_station) const {
  return !leftUncertainty(first_started_, camera_from_station, options_.loop.leave_factor);
}

/// A rival is looked for with the templates that led to the first pose.
double Localizer::templateFactorNow() const {
  if (options_.wide.isOn()) return 1.0;
  return templateFactor(rival_round_ == RivalRound::kNone ? attempt_ : first_attempt_);
}

/// A pose has converged and is supported.
StepReport Localizer::weighRivals() {
  if (rival_round_ == RivalRound::kNone) {
    first_started_ = started_;
    first_attempt_ = attempt_;
    rival_count_ = 0;
    lead_.rival = -1;
    takeLead();
    beginScan();
    return StepReport::of(Stage::kSupport, true);
  }
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  Rival& rival = rivals_[static_cast<std::size_t>(rival_)];
  const double margin_nats = comparePredictions(lead_render_, now.render, now.level, problem_.image,
                                                problem_.ignore, options_.support)
                                 .nats();
  rival.ended = LocalizationStatus::kConverged;
  rival.camera_from_station = camera_from_station_;
  rival.margin_nats = margin_nats;
  if (margin_nats >= 0.0 ||
      (!isInSeedsBox(camera_from_station_) && -margin_nats < options_.ambiguity.min_margin_nats))
    return nextRival(StepReport::of(Stage::kSupport, true));
  // The one that led takes its place, and what it was ahead of the others adds to the lead.
  for (Rival& other : rivals_.first(static_cast<std::size_t>(rival_))) {
    if (other.ended == LocalizationStatus::kConverged) other.margin_nats -= margin_nats;
  }
  rival.camera_from_station = lead_.camera_from_station;
  rival.margin_nats = -margin_nats;
  lead_.rival = rival_;
  takeLead();
  beginScan();
  return StepReport::of(Stage::kSupport, true);
}

void Localizer::takeLead() {
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  lead_.camera_from_station = camera_from_station_;
  lead_.camera_from_station_before = now.camera_from_station_before;
  lead_.matched = matched_;
  lead_.started = started_;
  lead_.iteration = iteration_ - 1;
  copyRender(now.render, lead_render_);
  lead_is_shown_ = true;
}

/// As far as the seed's uncertainty allows from one of its ends to the other.
void Localizer::beginScan() {
  rival_round_ = RivalRound::kScan;
  const double depth_m = (lead_.camera_from_station * bounds_.centre()).z();
  const Eigen::Vector3d reach_m =
      2.0 * options_.ambiguity.reach * first_started_.uncertainty.translation_m;
  const auto inPixels = [&](double reach, double focal_px, int most) {
    const double px = depth_m > 0.0 ? reach * focal_px / depth_m : 0.0;
    return static_cast<int>(std::clamp(px, 0.0, static_cast<double>(most)));
  };
  const Camera& camera = lead_render_.camera;
  similarity_.begin(lead_render_, inPixels(reach_m.x(), camera.fx, camera.width),
                    inPixels(reach_m.y(), std::abs(camera.fy), camera.height),
                    options_.ambiguity.min_similarity);
}

StepReport Localizer::stepScan() {
  if (!similarity_.step()) return StepReport::of(Stage::kSupport, false);
  noteRivals();
  return nextRival(StepReport::of(Stage::kSupport, false));
}

void Localizer::noteRivals() {
  const Camera& camera = problem_.camera;
  for (const SelfShift& shift : similarity_.shifts()) {
    if (rival_count_ == static_cast<int>(rivals_.size())) break;
    Pose moved = lead_.camera_from_station;
    moved.translation_m += shift.displacement_in_camera_m;
    const double shift_px =
        displacementBetween_px(lead_.camera_from_station, moved, bounds_, camera);
    if (leftUncertainty(first_started_, moved, options_.ambiguity.reach) ||
        isKnown(moved, 0.4 * shift_px))
      continue;
    Rival& rival = rivals_[static_cast<std::size_t>(rival_count_++)];
    rival = Rival();
    rival.camera_from_station_before = moved;
    rival.camera_from_station = moved;
    rival.similarity = shift.similarity;
  }
  workspace_.rivals = rivals_.first(static_cast<std::size_t>(rival_count_));
}

bool Localizer::isKnown(const Pose& camera_from_station, double within_px) const {
  const auto isNear = [&](const Pose& other) {
    return displacementBetween_px(other, camera_from_station, bounds_, problem_.camera) < within_px;
  };
  const auto known = rivals_.first(static_cast<std::size_t>(rival_count_));
  return isNear(lead_.camera_from_station) ||
         std::any_of(known.begin(), known.end(), [&](const Rival& rival) {
           return isNear(rival.camera_from_station_before) || isNear(rival.camera_from_station);
         });
}

StepReport Localizer::nextRival(StepReport made) {
  if (rival_round_ == RivalRound::kScan) {
    rival_round_ = RivalRound::kRivals;
    rival_ = lead_.rival + 1;
  } else {
    ++rival_;
  }
  if (rival_ >= rival_count_) return concludeRivals(made);
  startRival();
  return made;
}

void Localizer::startRival() {
  const Rival& rival = rivals_[static_cast<std::size_t>(rival_)];
  constexpr double kBox = 0.25;         // of the distance to the lead
  constexpr double kTurn_rad = 0.0262;  // 1.5 deg: the edges' directions are the lead's
  lead_is_shown_ = false;
  workspace_.attempts = ++attempt_ + 1;
  camera_from_station_ = rival.camera_from_station_before;
  const double distance_m =
      (camera_from_station_.translation_m - lead_.camera_from_station.translation_m).norm();
  iteration_ = options_.loop.match_iterations > 1 ? 1 : 0;
  small_corrections_ = 0;
  SeedUncertainty box;
  box.translation_m.setConstant(kBox * distance_m);
  box.rotation_rad.setConstant(kTurn_rad);
  box.pivot_in_camera_m = camera_from_station_ * bounds_.centre();
  started_ = problem_;
  started_.camera_from_station_seed = camera_from_station_;
  started_.uncertainty =
      scaled(box, 1.0 / shrinkAt(options_.loop.uncertainty_shrink, options_.loop, iteration_));
  iteration_pending_ = true;
}

/// What the self-similarity promised is not there.
StepReport Localizer::endRival(Stage stage, LocalizationStatus status) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.status = status;
  if (now.index == workspace_.iterations) ++workspace_.iterations;
  rivals_[static_cast<std::size_t>(rival_)].ended = status;
  StepReport made = StepReport::of(stage, true);
  made.iteration_complete = true;
  return nextRival(made);
}

StepReport Localizer::concludeRivals(StepReport made) {
  digestRivals(workspace_.rivals, digest_);
  rival_round_ = RivalRound::kReturn;
  if (lead_is_shown_) {
    finish(verdict());
    made.finished = true;
  } else {
    returnToLead();
  }
  return made;
}

/// Its last iteration once more, with the same render and from the same pose: the same bits.
void Localizer::returnToLead() {
  workspace_.attempts = ++attempt_ + 1;
  started_ = lead_.started;
  camera_from_station_ = lead_.camera_from_station_before;
  matched_ = lead_.matched;
  iteration_ = lead_.iteration;
  small_corrections_ = options_.loop.converged_iterations - 1;
  copyRender(lead_render_, fine_render_);
  buffers_[0].render = fine_render_;
  iteration_pending_ = true;
}

/// The seed speaks against poses outside its box: they must be clearly better, and then it is
/// wrong.
LocalizationStatus Localizer::verdict() const {
  if (!options_.ambiguity.enabled) return LocalizationStatus::kConverged;
  if (!isInSeedsBox(camera_from_station_)) return LocalizationStatus::kLeftUncertainty;
  const bool ambiguous =
      std::any_of(workspace_.rivals.begin(), workspace_.rivals.end(), [this](const Rival& rival) {
        return rival.ended == LocalizationStatus::kConverged &&
               rival.margin_nats < options_.ambiguity.min_margin_nats &&
               isInSeedsBox(rival.camera_from_station);
      });
  return ambiguous ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged;
}

}  // namespace boresight
