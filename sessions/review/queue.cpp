// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/queue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/localizer/localizer.h"
#include "sessions/checks/checks.h"
#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/review_status.h"
#include "sessions/run/worker_pool.h"
#include "sessions/session/rig_links.h"
#include "sessions/session/session_of_results.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

QueueGroup groupOf(const ReviewStatus& status, const QueueRow& row) {
  if (status.awaits_approval) return QueueGroup::kAwaits;
  if (status.holds()) return QueueGroup::kDecided;
  if (!row.trouble.empty()) return QueueGroup::kNoPose;
  return row.run_digest.empty() ? QueueGroup::kNotRun : QueueGroup::kOpen;
}

/// Of the failed checks when there are any, else of the passed ones.
void takeMargin(QueueRow& row) {
  const CheckState state = row.failed > 0 ? CheckState::kFailed : CheckState::kPassed;
  for (const Check& check : row.checks) {
    const std::optional<double> margin = check.state == state ? checkMargin(check) : std::nullopt;
    if (!margin || (row.margin && *row.margin <= *margin)) continue;
    row.margin = margin;
    row.margin_of = check.title;
  }
}

void takeRun(const ReviewSubject& subject, QueueRow& row) {
  const LocalizationTrace& run = *subject.run;
  row.iterations = static_cast<int>(run.iterations.size());
  row.inliers = lastInliers(run);
  row.opens_at = iterationToOpen(run);
  if (!run.converged()) return;
  const Pose& seed = run.camera_from_station_seed;
  row.from_seed = seedDistance(seed, subject.comparer().equivalent(run.camera_from_station, seed),
                               run.uncertainty);
}

std::shared_ptr<const ReviewSubject> withoutData(const ReviewSubject& subject) {
  auto loaded = std::make_shared<LoadedCase>();
  loaded->source = subject.loaded->source;
  auto result = std::make_shared<ReviewSubject>(subject);
  result->loaded = std::move(loaded);
  result->run->iterations.clear();
  result->run->edges.reset();
  return result;
}

void checkRun(const Session& session, std::shared_ptr<const LoadedCase> loaded, QueueRow& row) {
  const ReviewSubject subject = reviewSubject(session, std::move(loaded), PoseSource::kRun);
  takeRun(subject, row);
  const CheckLimits limits = checkLimits(session.review.preset, session.review.limits);
  row.checks = checkPose(subject, limits);
  row.passed = countOf(row.checks, CheckState::kPassed);
  row.failed = countOf(row.checks, CheckState::kFailed);
  if (subject.run->converged()) takeMargin(row);  // else the seed replaces the pose
  row.subject = withoutData(subject);
  row.trouble = subject.run->converged() ? validationConcern(session, subject)
                                         : "the run failed: " + explanation(*subject.run);
}

/// How a case that was not run here ended in results.
void takeListedResult(const ListedResult& listed, QueueRow& row) {
  if (!listed.completed) {
    row.trouble = "not run in this session; in the results: " + listed.status;
  } else if (listed.error_share) {
    row.margin = 1.0 - *listed.error_share;
    row.margin_of = "Requirement, in the results";
  }
}

QueueRow rowOfResult(const RunResult& run) {
  QueueRow row;
  row.case_id = resultCaseId(run);
  takeListedResult(listedResult(run), row);
  const ReviewStatus undecided;
  row.review_status_text = reviewStatusText(undecided);
  row.group = groupOf(undecided, row);
  return row;
}

/// For comparing: no margin is the worst where checks failed, and the best where none did.
double comparableMargin(const QueueRow& row) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return row.margin.value_or(row.failed > 0 ? -kInfinity : kInfinity);
}

constexpr double kPercent = 100.0;

std::string marginText(const QueueRow& row) {
  return row.margin ? fixedText(kPercent * *row.margin, 0) + " %" : "-";
}

/// For programs: all digits that a double has, or nothing.
std::string field(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? formatText("%.9g", *value) : "";
}

}  // namespace

SeedDistance seedDistance(const Pose& camera_from_station_seed, const Pose& camera_from_station,
                          const SeedUncertainty& uncertainty) {
  const Vector6d offset = offsetAboutPivot(camera_from_station_seed, camera_from_station,
                                           uncertainty.pivot_in_camera_m);
  Vector6d allowed;
  allowed << uncertainty.rotation_rad, uncertainty.translation_m;
  SeedDistance distance;
  distance.rotation_mrad = kMilliradians * offset.head<3>().norm();
  distance.translation_mm = kMillimetres * offset.tail<3>().norm();
  for (int i = 0; i < 6; ++i)
    if (allowed[i] > 0.0)
      distance.share = std::max(distance.share, std::abs(offset[i]) / allowed[i]);
  return distance;
}

std::optional<double> checkMargin(const Check& check) {
  if (!check.figure || !check.limit || *check.limit == 0.0) return {};
  const double beyond = (*check.figure - *check.limit) / std::abs(*check.limit);
  const double margin = check.side == LimitSide::kAtMost ? -beyond : beyond;
  return std::isfinite(margin) ? std::optional(margin) : std::nullopt;
}

QueueRow queueRow(const Session& session, const std::string& case_id) {
  const SessionCase* session_case = session.findCase(case_id);
  if (session_case == nullptr) throw std::invalid_argument("there is no case '" + case_id + "'");
  if (session.lastRunOf(case_id) == nullptr) return queueRow(session, case_id, nullptr);
  try {
    return queueRow(session, case_id, loadCase(*session_case));
  } catch (const FileError& error) {
    return queueRow(session, case_id, nullptr, error.what());
  }
}

QueueRow queueRow(const Session& session, const std::string& case_id,
                  std::shared_ptr<const LoadedCase> loaded, const std::string& reason) {
  QueueRow row;
  row.case_id = case_id;
  row.trouble = reason;
  if (const RunRecord* run = session.lastRunOf(case_id)) {
    row.run_digest = run->digest;
    try {
      if (loaded != nullptr) checkRun(session, std::move(loaded), row);
    } catch (const FileError& error) {
      row.trouble = error.what();
    }
  } else if (const SessionCase* session_case = session.findCase(case_id)) {
    const auto listed = reason.empty() ? listedResult(*session_case) : std::nullopt;
    if (listed) takeListedResult(*listed, row);
  }
  takeReviewStatus(session, row);
  return row;
}

void takeReviewStatus(const Session& session, QueueRow& row) {
  const ReviewStatus status = reviewStatusOf(session, row.case_id);
  row.review_state = status.state;
  row.review_status_text = reviewStatusText(status);
  row.outdated = !status.outdated.empty();
  row.group = groupOf(status, row);
}

std::string queueKey(const Session& session, const std::string& case_id) {
  const RunRecord* run = session.lastRunOf(case_id);
  std::string key = run == nullptr ? std::string() : run->digest + run->inputs_sha256;
  for (const auto& [name, sha256] : inputFingerprint(session, case_id, run ? run->digest : ""))
    key += ' ' + name + ' ' + sha256;
  for (const std::string& other : casesOfRig(session, case_id))
    if (const RunRecord* theirs = session.lastRunOf(other)) key += ' ' + theirs->digest;
  return key;
}

bool moreTrouble(const QueueRow& a, const QueueRow& b) {
  const auto key = [](const QueueRow& row) {
    const double share = row.from_seed ? row.from_seed->share : 0.0;
    return std::tuple(row.group, -row.failed, comparableMargin(row), -share);
  };
  if (key(a) != key(b)) return key(a) < key(b);
  return a.case_id < b.case_id;
}

std::string troubleText(const QueueRow& row) {
  if (row.group == QueueGroup::kAwaits) return "a second person must approve";
  if (row.group == QueueGroup::kDecided) return row.review_status_text;
  if (!row.trouble.empty()) return row.trouble;
  if (row.group == QueueGroup::kNotRun && row.margin)
    return "not run in this session; in the results: error " +
           fixedText(100.0 * (1.0 - *row.margin), 0) + " % of the requirement";
  if (row.group == QueueGroup::kNotRun) return "not run yet";
  if (row.failed > 0) {
    std::vector<std::string> failed;
    for (const Check& check : row.checks)
      if (check.state == CheckState::kFailed) failed.push_back(check.title);
    return countText(row.failed, "check") + " failed: " + joined(failed);
  }
  std::string text = std::to_string(row.passed) + " checks passed";
  if (row.margin) text += ", margin " + marginText(row) + ": " + row.margin_of;
  return text;
}

std::vector<QueueRow> queueRows(const Session& session, int jobs, const std::stop_token& stop,
                                const QueueProgress& progress) {
  std::vector<std::optional<QueueRow>> found(session.cases.size());
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr fault;
  const auto work = [&](int task, int) {
    const auto i = static_cast<std::size_t>(task);
    try {
      found[i] = queueRow(session, session.cases[i]->id);
      const std::lock_guard lock(mutex);
      if (progress) progress(*found[i], ++done, found.size());
    } catch (...) {
      const std::lock_guard lock(mutex);
      fault = std::current_exception();
    }
  };
  WorkerPool(std::max(jobs, 1)).run(static_cast<int>(found.size()), work, stop);
  if (fault) std::rethrow_exception(fault);
  std::vector<QueueRow> rows;
  for (std::optional<QueueRow>& row : found)
    if (row) rows.push_back(std::move(*row));
  std::sort(rows.begin(), rows.end(), moreTrouble);
  return rows;
}

std::vector<QueueRow> resultsQueue(const std::filesystem::path& results_file) {
  std::vector<QueueRow> rows;
  forEachRun(results_file, [&rows](const RunResult& run) {
    if (run.method == "whs" && !run.inputFailed()) rows.push_back(rowOfResult(run));
  });
  if (rows.empty()) throw InputError(results_file, "it has no runs of the method whs that began");
  std::sort(rows.begin(), rows.end(), moreTrouble);
  return rows;
}

std::string queueText(const std::vector<QueueRow>& rows) {
  TextTable table({"case", "state", "failed", "passed", "margin", "mm", "mrad", "of seed's",
                   "inliers", "iteration"});
  for (const QueueRow& row : rows) {
    const SeedDistance from = row.from_seed.value_or(SeedDistance{NAN, NAN, NAN});
    const std::string share = row.from_seed ? fixedText(kPercent * from.share, 0) + " %" : "-";
    table.add({row.case_id, reviewStateText(row.review_state), std::to_string(row.failed),
               std::to_string(row.passed), marginText(row), fixedText(from.translation_mm, 2),
               fixedText(from.rotation_mrad, 2), share,
               row.inliers ? std::to_string(*row.inliers) : "-",
               row.opens_at < 0
                   ? "-"
                   : std::to_string(row.opens_at + 1) + "/" + std::to_string(row.iterations)});
  }
  std::string text = table.text() + "\n";
  for (const QueueRow& row : rows) text += plainLine(row.case_id + ": " + troubleText(row));
  return text;
}

std::string queueCsv(const std::vector<QueueRow>& rows) {
  std::string text =
      "case,state,checks_failed,checks_passed,margin,margin_of,from_seed_mm,from_seed_mrad,"
      "from_seed_share,inliers,iterations,look_at_iteration,run,trouble\r\n";
  for (const QueueRow& row : rows) {
    const SeedDistance from = row.from_seed.value_or(SeedDistance{NAN, NAN, NAN});
    const std::string fields[] = {row.case_id,
                                  reviewStateText(row.review_state),
                                  std::to_string(row.failed),
                                  std::to_string(row.passed),
                                  field(row.margin),
                                  row.margin_of,
                                  field(from.translation_mm),
                                  field(from.rotation_mrad),
                                  field(from.share),
                                  row.inliers ? std::to_string(*row.inliers) : "",
                                  std::to_string(row.iterations),
                                  row.opens_at < 0 ? "" : std::to_string(row.opens_at + 1),
                                  row.run_digest,
                                  troubleText(row)};
    for (const std::string& each : fields) text += (&each == fields ? "" : ",") + csvField(each);
    text += "\r\n";
  }
  return text;
}

}  // namespace boresight::sessions
