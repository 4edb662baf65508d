// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/run_difference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "sessions/checks/checks.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/option_value.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/record/onboard_record.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr double kTelling = 0.1;  // of the requirement: a change of the error that counts

/// A run as it was read, with its checks.
struct ReadRun {
  const RunRecord* record = nullptr;
  ReviewSubject subject;
  std::vector<Check> checks;
};

ReadRun readRun(const Session& session, const std::string& digest,
                const std::shared_ptr<const LoadedCase>& loaded) {
  ReadRun run;
  run.record = findRun(session, loaded->source.id, digest);
  if (run.record == nullptr)
    throw std::invalid_argument("case " + loaded->source.id + " has no run with digest " + digest);
  run.subject = reviewSubject(session, loaded, PoseSource::kRun, digest);
  run.checks = checkPose(run.subject, checkLimits(session.review.preset, session.review.limits));
  return run;
}

void takeError(const ReviewSubject& subject, RunSide& side) {
  if (!side.converged) return;
  side.error = truthError(*subject.loaded, subject.camera_from_station);
  if (!side.error) return;
  const SessionCase& session_case = subject.loaded->source;
  const Matrix6d truth_covariance = session_case.truth_covariance.value_or(Matrix6d::Zero());
  if (sigmaExcessText(truth_covariance, session_case.camera_from_end_effector, subject.requirement)
          .empty())
    side.error_share = requirementShare(*side.error, subject.requirement);
}

RunSide sideOf(const ReadRun& run) {
  RunSide side;
  side.digest = run.record->digest;
  side.time = run.record->time;
  side.status = run.record->status;
  side.converged = run.subject.run->converged();
  side.iterations = static_cast<int>(run.subject.run->iterations.size());
  side.inliers = lastInliers(*run.subject.run);
  side.checks_passed = countOf(run.checks, CheckState::kPassed);
  side.checks_failed = countOf(run.checks, CheckState::kFailed);
  takeError(run.subject, side);
  return side;
}

std::vector<CheckChange> changedChecks(const std::vector<Check>& before,
                                       const std::vector<Check>& after) {
  std::vector<CheckChange> changed;
  for (const Check& check : before) {
    const auto found = std::ranges::find(after, check.id, &Check::id);
    if (found != after.end() && found->state != check.state)
      changed.push_back({check.title, check.state, found->state});
  }
  return changed;
}

/// The hashes of a run's inputs are known where these are what the case has now.
OnboardRecord recordOfRun(const ReadRun& run) {
  const LoadedCase& loaded = *run.subject.loaded;
  const bool as_now = run.record->inputs_sha256 == inputsDigest(loaded.source);
  const LocalizationProblem given = loaded.problem();
  return recordOf(*run.subject.run, as_now ? &given : nullptr);
}

/// Smaller is better.
int rankByTruth(const RunSide& side) {
  if (!side.converged) return 1;
  return !side.wrong_mesh && side.error_share.value_or(0.0) <= 1.0 ? 0 : 2;
}

std::string truthText(const RunSide& side) {
  if (!side.converged) return "failed";
  if (side.wrong_mesh) return "accepted on a wrong mesh";
  return "error " + fixedText(100.0 * side.error_share.value_or(0.0), 0) + " % of the requirement";
}

std::string checksText(const RunSide& side) {
  if (!side.converged) return "the run failed";
  if (side.checks_failed == 0) return "all checks passed";
  return countText(side.checks_failed, "check") + " failed";
}

RunChange changeOf(double before, double after) {
  if (after < before) return RunChange::kBetter;
  return after > before ? RunChange::kWorse : RunChange::kSame;
}

RunChange judgedByTruth(const RunDifference& difference) {
  const int before = rankByTruth(difference.before);
  const int after = rankByTruth(difference.after);
  if (before != after || before != 2) return changeOf(before, after);
  if (!difference.before.error_share || !difference.after.error_share) return RunChange::kSame;
  const double nearer = *difference.before.error_share - *difference.after.error_share;
  if (std::abs(nearer) < kTelling) return RunChange::kSame;
  return nearer > 0.0 ? RunChange::kBetter : RunChange::kWorse;
}

RunChange judgedByChecks(const RunDifference& difference) {
  const auto rank = [](const RunSide& side) {
    return side.converged ? static_cast<double>(side.checks_failed) : 1e9;
  };
  return changeOf(rank(difference.before), rank(difference.after));
}

std::string errorText(const RunSide& side) {
  if (!side.error) return "-";
  return fixedText(side.error->normal_mm, 2) + " mm, " + fixedText(side.error->lateral_mm, 2) +
         " mm, " + fixedText(side.error->rotation_mrad, 2) + " mrad";
}

std::string endText(const RunSide& side) {
  return side.status + ", " + std::to_string(side.iterations) + " iterations";
}

std::string inliersText(const RunSide& side) {
  return side.inliers ? std::to_string(*side.inliers) : "-";
}

std::string checkText(const RunSide& side) {
  return std::to_string(side.checks_passed) + " passed, " + std::to_string(side.checks_failed) +
         " failed";
}

/// "pnp.min_inliers 12 -> 100"; more than three are counted.
std::string optionChangesText(std::span<const OptionChangeText> changes) {
  constexpr std::size_t kMostNamed = 3;
  const std::size_t named = changes.size() <= kMostNamed ? changes.size() : kMostNamed - 1;
  std::vector<std::string> texts;
  for (const auto& [name, before, after] : changes.first(named))
    texts.push_back(name + " " + before + " -> " + after);
  return joined(texts) + (named < changes.size()
                              ? " and " + std::to_string(changes.size() - named) + " other options"
                              : "");
}

}  // namespace

std::vector<OptionChangeText> optionChanges(const LocalizerOptions& before,
                                            const LocalizerOptions& after) {
  const auto value = listOptions(before);
  const auto other = listOptions(after);
  std::vector<OptionChangeText> changed;
  for (std::size_t i = 0; i < value.size(); ++i)
    if (!(value[i].value == other[i].value))
      changed.push_back({value[i].name, valueText(value[i], value[i].value),
                         valueText(other[i], other[i].value)});
  return changed;
}

PoseDistance poseDistance(const LoadedCase& loaded, const Pose& camera_from_station,
                          const Pose& other_camera_from_station) {
  const PoseComparer comparer(loaded);
  const PoseError error = comparer.difference(camera_from_station, other_camera_from_station);
  return {std::hypot(error.normal_mm, error.lateral_mm), error.geodesic_mrad / kMradPerDegree,
          comparer.projection_px(camera_from_station, other_camera_from_station)};
}

std::string poseDistanceText(const PoseDistance& distance) {
  std::string text = fixedText(distance.translation_mm, 2) + " mm, " +
                     fixedText(distance.rotation_deg, 3) + " deg";
  if (distance.projection_px) text += ", " + fixedText(*distance.projection_px, 1) + " px";
  return text;
}

std::vector<RunListLine> runListLines(std::span<const RunRecord> runs, const LoadedCase& loaded,
                                      const std::stop_token& stop) {
  std::vector<RunListLine> lines(runs.size());
  std::optional<LocalizationTrace> before;
  for (std::size_t i = 0; i < runs.size() && !stop.stop_requested(); ++i) {
    std::optional<LocalizationTrace> after;
    try {
      after = loadRun(runs[i]);
    } catch (const InputError&) {
      // Its lines stay empty.
    }
    RunListLine& line = lines[i];
    if (i > 0 && runs[i - 1].inputs_sha256 != runs[i].inputs_sha256) line.changed = "inputs";
    if (before && after) {
      const std::string options =
          optionChangesText(optionChanges(before->lastOptions(), after->lastOptions()));
      line.changed += (line.changed.empty() || options.empty() ? "" : ", ") + options;
      if (before->converged() && after->converged())
        line.moved = poseDistance(loaded, before->lastPose(), after->lastPose());
    }
    before = std::move(after);
  }
  return lines;
}

const char* runChangeText(RunChange change) {
  constexpr const char* kTexts[] = {"better", "worse", "same"};
  return kTexts[static_cast<std::size_t>(change)];
}

std::optional<RunPair> lastTwoRuns(const Session& session, const std::string& case_id) {
  const std::vector<const RunRecord*> runs = session.runs.findAll(case_id);
  if (runs.size() < 2) return std::nullopt;
  RunPair pair;
  pair.before = runs[runs.size() - 2];
  pair.after = runs.back();
  return pair;
}

void judgeChange(RunDifference& difference) {
  const bool truth = difference.before.error_share || difference.after.error_share ||
                     difference.before.wrong_mesh || difference.after.wrong_mesh;
  const auto text = [truth](const RunSide& side) {
    return truth ? truthText(side) : checksText(side);
  };
  const std::string before = text(difference.before);
  const std::string after = text(difference.after);
  difference.change = truth ? judgedByTruth(difference) : judgedByChecks(difference);
  if (difference.before.digest == difference.after.digest)
    difference.why = "bit for bit";
  else
    difference.why = before == after ? after + " before and now" : before + " before, now " + after;
}

RunDifference compareRuns(const Session& session, const std::string& before_digest,
                          const std::string& after_digest,
                          std::shared_ptr<const LoadedCase> loaded) {
  const ReadRun before = readRun(session, before_digest, loaded);
  const ReadRun after = readRun(session, after_digest, loaded);
  RunDifference difference;
  difference.case_id = loaded->source.id;
  difference.before = sideOf(before);
  difference.after = sideOf(after);
  difference.inputs_differ = before.record->inputs_sha256 != after.record->inputs_sha256;
  difference.options = optionChanges(before.subject.run->options, after.subject.run->options);
  difference.checks = changedChecks(before.checks, after.checks);
  difference.comparison =
      compareRecords(recordOfRun(before), recordOfRun(after), comparisonLimits(*loaded));
  judgeChange(difference);
  return difference;
}

std::vector<DifferenceLine> differenceLines(const RunDifference& difference) {
  std::vector<DifferenceLine> lines = {
      {"Status", endText(difference.before), endText(difference.after)},
      {"Inliers", inliersText(difference.before), inliersText(difference.after)},
      {"Checks", checkText(difference.before), checkText(difference.after)}};
  if (difference.before.error || difference.after.error)
    lines.push_back({"Error: along, across, rotation", errorText(difference.before),
                     errorText(difference.after)});
  for (const CheckChange& check : difference.checks)
    lines.push_back({check.title, checkStateText(check.before), checkStateText(check.after)});
  for (const OptionChangeText& option : difference.options)
    lines.push_back({option.name, option.before, option.after});
  return lines;
}

std::string changeText(const RunDifference& difference) {
  std::string text =
      asSentence(std::string(runChangeText(difference.change)) + ": " + difference.why);
  if (difference.inputs_differ) text += " The inputs of the runs differ.";
  if (difference.comparison.first)
    text += " First difference: " + std::string(runPartText(difference.comparison.first->part)) +
            ": " + difference.comparison.first->text + ".";
  return text;
}

std::string differenceText(const RunDifference& difference) {
  TextTable table({difference.case_id, "before", "now"});
  for (const DifferenceLine& line : differenceLines(difference))
    table.add({line.label, line.before, line.after});
  std::string apart;
  if (difference.before.converged && difference.after.converged)
    apart = "Final poses " + fixedText(difference.comparison.translation_mm, 3) + " mm and " +
            fixedText(difference.comparison.rotation_mrad, 3) + " mrad apart at the camera.\n";
  return table.text() + apart + plainLine(changeText(difference));
}

}  // namespace boresight::sessions
