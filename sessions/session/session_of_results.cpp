// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_of_results.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
#include <tuple>

#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_inputs.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/session/session_maker.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr std::string_view kTag = "result:";
constexpr int kShareDecimals = 4;

/// The one method that a session can run.
const MethodFacts& whsOf(const ResultsFacts& facts) {
  const auto found = std::ranges::find(facts.methods, "whs", &MethodFacts::method);
  if (found == facts.methods.end())
    throw InputError(facts.file, "it has no runs of the method whs; only these can be repeated");
  if (!found->mesh_of.empty() || !found->mirror.empty())
    throw InputError(facts.file,
                     "its runs used deliberately wrong meshes, which sessions do not support");
  return *found;
}

void requireSameDataset(const ResultsFacts& facts) {
  if (std::filesystem::is_directory(facts.dataset.dataset))
    throw InputError(facts.file, "its runs are of the BOP folder " + facts.dataset.dataset +
                                     ", but sessions need a dataset.json");
  const std::string current = sha256Text(readFileBytes(facts.dataset.dataset, kMaxJsonBytes));
  if (current != facts.dataset.dataset_sha256)
    throw InputError(facts.file, "its dataset " + facts.dataset.dataset +
                                     " has changed since: evaluate again into a new file");
}

void requireSameInputs(const ResultsFacts& facts, const std::vector<RunResult>& runs) {
  const Dataset dataset = readDataset(facts.dataset.dataset);
  RunInputs inputs(dataset);
  for (const RunResult& run : runs)
    if (const Case* dataset_case = dataset.findCase(run.case_id))
      inputs.requireUnchanged(*dataset_case, run.inputs_sha256, facts.file);
}

/// The runs that began, the worst first.
std::vector<RunResult> troubledFirst(const std::filesystem::path& file) {
  std::vector<RunResult> runs;
  forEachRun(file, [&](const RunResult& run) {
    if (run.method == "whs" && !run.inputFailed()) runs.push_back(run);
  });
  std::stable_sort(runs.begin(), runs.end(), [](const RunResult& a, const RunResult& b) {
    const auto key = [](const RunResult& run) {
      return std::tuple(run.completed, -listedResult(run).error_share.value_or(0.0));
    };
    return key(a) < key(b);
  });
  return runs;
}

/// The flight profile has the default's options, and no memory of its own in a session.
Session withOptionsOf(const Session& session, const ResultsFacts& facts,
                      const MethodFacts& method) {
  const JsonDocument document(facts.file, method.options);
  const std::string profile = profileOptions(method.profile) ? method.profile : "default";
  LocalizerOptions options = *profileOptions(profile);
  applyConfig(options, Config{facts.file, profile, readOptions(document.root())});
  return withOptions(session, profile, options);
}

}  // namespace

ListedResult listedResult(const RunResult& run) {
  ListedResult result{run.status, run.completed, std::nullopt};
  if (const PoseError* error = run.completedError(); error != nullptr && run.requirement)
    result.error_share = requirementShare(*error, *run.requirement);
  return result;
}

std::string resultTag(const ListedResult& result) {
  std::string tag = std::string(kTag) + result.status;
  if (result.error_share) tag += ":" + fixedText(*result.error_share, kShareDecimals);
  return tag;
}

std::optional<ListedResult> listedResult(const SessionCase& session_case) {
  for (const std::string& tag : session_case.tags) {
    if (!std::string_view(tag).starts_with(kTag)) continue;
    ListedResult result;
    const std::size_t colon = tag.find(':', kTag.size());
    result.status = tag.substr(kTag.size(), colon - kTag.size());
    result.completed = result.status == "converged";
    if (colon != std::string::npos)
      result.error_share = numberIn<double>(std::string_view(tag).substr(colon + 1));
    return result;
  }
  return std::nullopt;
}

std::string resultCaseId(const RunResult& run) {
  return run.case_id + (run.reseed > 0 ? " seed " + std::to_string(run.reseed) : "");
}

Session sessionOfResults(const std::filesystem::path& results_file) {
  const ResultsFacts facts = readResultsFacts(results_file);
  const MethodFacts& method = whsOf(facts);
  requireSameDataset(facts);
  const std::vector<RunResult> runs = troubledFirst(results_file);
  std::vector<std::string> ids;
  for (const RunResult& run : runs) ids.push_back(run.case_id);
  if (ids.empty()) throw InputError(results_file, "none of its runs could start");
  requireSameInputs(facts, runs);
  Session session = makeSession(facts.dataset.dataset, ids);
  std::map<std::string, SharedValue<SessionCase>> by_id;
  for (const auto& session_case : session.cases) by_id.emplace(session_case->id, session_case);
  session.cases.clear();
  for (const RunResult& run : runs) {
    const auto found = by_id.find(run.case_id);
    if (found == by_id.end()) continue;
    SessionCase session_case = *found->second;
    session_case.id = resultCaseId(run);
    if (run.reseed > 0) setSeed(session_case, run.camera_from_station_seed);
    session_case.tags.push_back(resultTag(listedResult(run)));
    session.cases.push_back(std::move(session_case));
  }
  return withOptionsOf(session, facts, method);
}

}  // namespace boresight::sessions
