// SPDX-License-Identifier: Apache-2.0
// A session's cases in the order of review.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/checks/review_subject.h"
#include "sessions/decision/check.h"
#include "sessions/review/review_status.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Group of a case by the action that it needs; the first sort key of the queue.
enum class QueueGroup {
  kNoPose,   ///< the last run failed, is of other inputs, or cannot be read: nothing to accept
  kOpen,     ///< a pose that waits for a decision
  kNotRun,   ///< there is no run yet
  kAwaits,   ///< validated by one person where two are required
  kDecided,  ///< validated or rejected, and the decision holds
};

/// How far a pose is from its seed, about the pivot of the seed's uncertainty.
struct SeedDistance {
  double translation_mm = 0.0;
  double rotation_mrad = 0.0;
  /// The largest share of the uncertainty, over its nonzero axes; 1: on its border.
  double share = 0.0;
};
SeedDistance seedDistance(const Pose& camera_from_station_seed, const Pose& camera_from_station,
                          const SeedUncertainty& uncertainty);

/// Margin of a check's figure to its limit, as a share of the limit; negative when the check fails.
/// Empty without a figure or limit, or when the limit is zero.
std::optional<double> checkMargin(const Check& check);

/// One case as the queue lists it: its last run, checked.
struct QueueRow {
  std::string case_id;
  QueueGroup group = QueueGroup::kNotRun;
  ReviewState review_state = ReviewState::kNew;
  std::string review_status_text;  ///< reviewStatusText()
  bool outdated = false;           ///< a validation of a run with other options
  std::string run_digest;          ///< empty without a run
  std::vector<Check> checks;       ///< of the last run, as checkPose orders them
  int passed = 0;
  int failed = 0;
  /// Margin of the failed check that is farthest beyond its limit; when none failed, of the passed
  /// check nearest to its limit. Empty when none of them has a margin, or the run failed.
  std::optional<double> margin;
  std::string margin_of;  ///< the title of that check
  std::optional<SeedDistance> from_seed;
  std::optional<std::int32_t> inliers;  ///< lastInliers()
  int iterations = 0;
  /// Index of the iteration to open first: the one that failed, else the last; -1: none.
  int opens_at = -1;
  std::string trouble;  ///< why there is no pose to accept; empty otherwise
  /// Data for a decision: the pose and the outcome of its run, without pixels, mesh and iterations.
  std::shared_ptr<const ReviewSubject> subject;
};

/// Checks a case's last run with the current inputs. Reads its files and its trace; failures to
/// read are reported in `trouble`. std::invalid_argument when there is no such case.
QueueRow queueRow(const Session& session, const std::string& case_id);
/// The same for inputs that were read already (nullptr: they could not be read, for `reason`).
QueueRow queueRow(const Session& session, const std::string& case_id,
                  std::shared_ptr<const LoadedCase> loaded, const std::string& reason = {});

/// Updates the row after decisions: group, review status and its text.
void takeReviewStatus(const Session& session, QueueRow& row);

/// Key of all inputs of a row except decisions: a row of another key is stale.
std::string queueKey(const Session& session, const std::string& case_id);

/// Whether `a` comes before `b`. A strict total order over rows of different cases: by group; more
/// failed checks first; then the smaller margin (no margin counts as the worst where checks failed,
/// as the best where none did); then the farther from the seed; last by the case's id.
bool moreTrouble(const QueueRow& a, const QueueRow& b);

/// "2 checks failed: Coverage, Clutter", "the run failed: ...", "20 checks passed, margin 8 %:
/// Inliers".
std::string troubleText(const QueueRow& row);

/// Called after each case, one call at a time, from any thread.
using QueueProgress = std::function<void(const QueueRow& row, std::size_t done, std::size_t of)>;

/// All cases, sorted. `jobs` are checked at a time. A stop leaves out those not begun.
std::vector<QueueRow> queueRows(const Session& session, int jobs = 1,
                                const std::stop_token& stop = {},
                                const QueueProgress& progress = {});

/// Rows for the runs of a results file that become cases of its session (session_of_results.h), as
/// in that session's queue. Reads only the file: neither dataset nor images. InputError.
std::vector<QueueRow> resultsQueue(const std::filesystem::path& results_file);

/// A readable table, in the order of the rows.
std::string queueText(const std::vector<QueueRow>& rows);
/// The same for programs: a header and one line per case (RFC 4180), with a dot as decimal point
/// and empty fields for unknown values.
std::string queueCsv(const std::vector<QueueRow>& rows);

}  // namespace boresight::sessions
