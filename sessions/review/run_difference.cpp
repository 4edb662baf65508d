// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/run_difference.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/option_value.h"
#include "sessions/record/onboard_record.h"
#include "sessions/review/checks.h"
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
  ReadRun made;
  made.record = findRun(session, loaded->source.id, digest);
  if (made.record == nullptr)
    throw std::invalid_argument("case " + loaded->source.id + " has no run with digest " + digest);
  made.subject = reviewSubject(session, loaded, PoseSource::kRun, digest);
  made.checks = checkPose(made.subject, checkLimits(session.review.preset, session.review.limits));
  return made;
}

void takeError(const ReviewSubject& subject, RunSide& side) {
  if (!side.converged) return;
  side.error = truthError(*subject.loaded, subject.camera_from_station);
  if (!side.error) return;
  const SessionCase& one = subject.loaded->source;
  const Matrix6d truth_covariance = one.truth_covariance.value_or(Matrix6d::Zero());
  if (sigmaExcessText(truth_covariance, one.camera_from_end_effector, subject.requirement).empty())
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
    const auto found = std::find_if(after.begin(), after.end(),
                                    [&](const Check& other) { return other.id == check.id; });
    if (found != after.end() && found->state != check.state)
      changed.push_back({check.title, check.state, found->state});
  }
  return changed;
}

std::vector<OptionChangeText> changedOptions(const LocalizerOptions& before,
                                             const LocalizerOptions& after) {
  const auto one = listOptions(before);
  const auto other = listOptions(after);
  std::vector<OptionChangeText> changed;
  for (std::size_t i = 0; i < one.size(); ++i)
    if (!(one[i].value == other[i].value))
      changed.push_back(
          {one[i].name, valueText(one[i], one[i].value), valueText(other[i], other[i].value)});
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
  return side.error_share.value_or(0.0) <= 1.0 ? 0 : 2;
}

std::string truthText(const RunSide& side) {
  if (!side.converged) return "failed";
  return "error " + fixedText(100.0 * side.error_share.value_or(0.0), 0) + " % of the requirement";
}

std::string checksText(const RunSide& side) {
  if (!side.converged) return "the run failed";
  if (side.checks_failed == 0) return "all checks passed";
  return std::to_string(side.checks_failed) +
         (side.checks_failed == 1 ? " check failed" : " checks failed");
}

RunChange changeOf(double before, double after) {
  if (after < before) return RunChange::kBetter;
  return after > before ? RunChange::kWorse : RunChange::kSame;
}

RunChange judgedByTruth(const RunDifference& made) {
  const int before = rankByTruth(made.before);
  const int after = rankByTruth(made.after);
  if (before != after || before != 2) return changeOf(before, after);
  const double nearer = *made.before.error_share - *made.after.error_share;
  if (std::abs(nearer) < kTelling) return RunChange::kSame;
  return nearer > 0.0 ? RunChange::kBetter : RunChange::kWorse;
}

RunChange judgedByChecks(const RunDifference& made) {
  const auto rank = [](const RunSide& side) {
    return side.converged ? static_cast<double>(side.checks_failed) : 1e9;
  };
  return changeOf(rank(made.before), rank(made.after));
}

std::string errorText(const RunSide& side) {
  if (!side.error) return "-";
  return fixedText(side.error->normal_mm, 2) + " mm, " + fixedText(side.error->lateral_mm, 2) +
         " mm, " + fixedText(side.error->rotation_mrad, 2) + " mrad";
}

std::string endText(const RunSide& side) {
  return side.status + ", " + std::to_string(side.iterations) + " iterations";
}

std::string checkText(const RunSide& side) {
  return std::to_string(side.checks_passed) + " passed, " + std::to_string(side.checks_failed) +
         " failed";
}

std::string sentence(std::string clause) {
  if (!clause.empty())
    clause[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(clause[0])));
  return clause + ".";
}

}  // namespace

const char* runChangeText(RunChange change) {
  constexpr const char* kTexts[] = {"better", "worse", "same"};
  return kTexts[static_cast<std::size_t>(change)];
}

std::optional<RunPair> lastTwoRuns(const Session& session, const std::string& case_id) {
  RunPair pair;
  for (auto run = session.runs.rbegin(); run != session.runs.rend() && !pair.before; ++run)
    if (run->case_id == case_id) (pair.after ? pair.before : pair.after) = &*run;
  return pair.before ? std::optional(pair) : std::nullopt;
}

void judgeChange(RunDifference& made) {
  const bool truth = made.before.error_share || made.after.error_share;
  const std::string before = truth ? truthText(made.before) : checksText(made.before);
  const std::string after = truth ? truthText(made.after) : checksText(made.after);
  made.change = truth ? judgedByTruth(made) : judgedByChecks(made);
  if (made.before.digest == made.after.digest)
    made.why = "bit for bit";
  else
    made.why = before == after ? after + " before and now" : before + " before, now " + after;
}

RunDifference compareRuns(const Session& session, const std::string& before_digest,
                          const std::string& after_digest,
                          std::shared_ptr<const LoadedCase> loaded) {
  const ReadRun before = readRun(session, before_digest, loaded);
  const ReadRun after = readRun(session, after_digest, loaded);
  RunDifference made;
  made.case_id = loaded->source.id;
  made.before = sideOf(before);
  made.after = sideOf(after);
  made.inputs_differ = before.record->inputs_sha256 != after.record->inputs_sha256;
  made.options = changedOptions(before.subject.run->options, after.subject.run->options);
  made.checks = changedChecks(before.checks, after.checks);
  made.comparison = compareRecords(recordOfRun(before), recordOfRun(after));
  judgeChange(made);
  return made;
}

std::vector<DifferenceLine> differenceLines(const RunDifference& made) {
  std::vector<DifferenceLine> lines = {
      {"Status", endText(made.before), endText(made.after)},
      {"Inliers", std::to_string(made.before.inliers), std::to_string(made.after.inliers)},
      {"Checks", checkText(made.before), checkText(made.after)}};
  if (made.before.error || made.after.error)
    lines.push_back(
        {"Error: along, across, rotation", errorText(made.before), errorText(made.after)});
  for (const CheckChange& check : made.checks)
    lines.push_back({check.title, checkStateText(check.before), checkStateText(check.after)});
  for (const OptionChangeText& option : made.options)
    lines.push_back({option.name, option.before, option.after});
  return lines;
}

std::string changeText(const RunDifference& made) {
  std::string text = sentence(std::string(runChangeText(made.change)) + ": " + made.why);
  if (made.inputs_differ) text += " The inputs of the runs differ.";
  if (made.comparison.first)
    text += " First difference: " + std::string(runPartText(made.comparison.first->part)) + ": " +
            made.comparison.first->text + ".";
  return text;
}

std::string differenceText(const RunDifference& made) {
  TextTable table({made.case_id, "before", "now"});
  for (const DifferenceLine& line : differenceLines(made))
    table.add({line.label, line.before, line.after});
  std::string apart;
  if (made.before.converged && made.after.converged)
    apart = "Final poses " + fixedText(made.comparison.translation_mm, 3) + " mm and " +
            fixedText(made.comparison.rotation_mrad, 3) + " mrad apart at the camera.\n";
  return table.text() + apart + plainLine(changeText(made));
}

}  // namespace boresight::sessions
