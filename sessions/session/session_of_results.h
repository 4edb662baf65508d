// SPDX-License-Identifier: Apache-2.0
// A results file as a session: its runs become cases to look at and to run again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sessions/evaluation/run_result.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// How a case's run ended in the results that its session was made of.
struct ListedResult {
  std::string status;  ///< as RunResult has it
  bool completed = false;
  /// The part of the requirement that its error took up, see requirementShare; nothing without
  /// truth or requirement.
  std::optional<double> error_share;
};
ListedResult listedResult(const RunResult& run);

/// As one of a case's tags, "result:converged:0.37" or "result:pnp_failed", and back; nothing when
/// there is no such tag.
std::string resultTag(const ListedResult& result);
std::optional<ListedResult> listedResult(const SessionCase& session_case);

/// "bc-000012", or "bc-000012 seed 3" for a further seed.
std::string resultCaseId(const RunResult& run);

/// A session of the cases of a results file's runs of WHS, each with the seed that its run began
/// from and a tag of how it ended; profile and options are theirs, so that a run here repeats the
/// one listed, to the bit. The most troubled come first: failed runs, then by error share; refused
/// inputs are left out. InputError when the file or the dataset that it names cannot be read, the
/// dataset is not the one any more, there are no such runs, or their meshes were deliberately
/// wrong.
Session sessionOfResults(const std::filesystem::path& results_file);

}  // namespace boresight::sessions
