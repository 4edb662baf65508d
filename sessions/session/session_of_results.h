// SPDX-License-Identifier: Apache-2.0
// A results file as a session: its runs become cases to review and to run again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sessions/evaluation/run_result.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Outcome of a case's run in the results from which its session was made.
struct ListedResult {
  std::string status;  ///< RunResult::status
  bool completed = false;
  /// requirementShare() of its error; empty without truth or requirement.
  std::optional<double> error_share;
};
ListedResult listedResult(const RunResult& run);

/// As one of a case's tags, "result:converged:0.37" or "result:pnp_failed", and back; empty when
/// there is no such tag.
std::string resultTag(const ListedResult& result);
std::optional<ListedResult> listedResult(const SessionCase& session_case);

/// "bc-000012", or "bc-000012 seed 3" for a further seed.
std::string resultCaseId(const RunResult& run);

/// A session of a results file's runs of WHS, one case per run, with the run's seed and a tag with
/// its outcome. Profile and options are those of the runs: a new run repeats the listed one bit for
/// bit. The worst come first: failed runs, then by error share; rejected inputs are left out.
/// InputError when the file or the dataset that it names cannot be read, the dataset or an input of
/// a run has changed,
/// there are no such runs, or their meshes were deliberately wrong.
Session sessionOfResults(const std::filesystem::path& results_file);

}  // namespace boresight::sessions
