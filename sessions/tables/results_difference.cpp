// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/results_difference.h"

#include <map>
#include <tuple>

#include "sessions/evaluation/pose_error.h"

namespace boresight::sessions {
namespace {

RunSide sideOf(const RunResult& run) {
  RunSide side;
  side.digest = run.digest;
  side.status = run.status;
  side.converged = run.completed;
  side.iterations = run.iterations;
  side.inliers = run.inliers;
  if (run.completed && run.error && run.requirement) {
    side.error = run.error;
    side.error_share = requirementShare(*run.error, *run.requirement);
  }
  return side;
}

/// Without truth: whether it completed.
void judgeByEnding(RunPairing& pair) {
  const bool before = pair.before.completed;
  const bool after = pair.after.completed;
  if (before != after) pair.change = after ? RunChange::kBetter : RunChange::kWorse;
  pair.why = pair.before.status == pair.after.status
                 ? pair.before.status + " before and now"
                 : pair.before.status + " before, now " + pair.after.status;
}

RunPairing paired(const RunResult& before, const RunResult& after) {
  RunPairing pair{before, after, RunChange::kSame, {}};
  RunDifference judged;
  judged.before = sideOf(before);
  judged.after = sideOf(after);
  if (!judged.before.error_share && !judged.after.error_share) {
    judgeByEnding(pair);
    return pair;
  }
  judgeChange(judged);
  pair.change = judged.change;
  pair.why = judged.why;
  return pair;
}

bool equalBits(const RunPairing& pair) {
  return !pair.before.digest.empty() && pair.before.digest == pair.after.digest;
}

void count(const RunPairing& pair, ResultsDifference& made) {
  made.better += pair.change == RunChange::kBetter ? 1 : 0;
  made.worse += pair.change == RunChange::kWorse ? 1 : 0;
  made.same += pair.change == RunChange::kSame ? 1 : 0;
  made.equal += equalBits(pair) ? 1 : 0;
}

std::optional<double> shareCell(const RunResult& run) {
  if (!run.completed || !run.error || !run.requirement) return std::nullopt;
  return 100.0 * requirementShare(*run.error, *run.requirement);
}

}  // namespace

ResultsDifference compareResults(const ResultsSet& before, const ResultsSet& after) {
  const bool by_method = before.methodNames().size() > 1 || after.methodNames().size() > 1;
  using Key = std::tuple<std::string, std::int32_t, std::string>;
  const auto keyOf = [by_method](const RunResult& run) {
    return Key(run.case_id, run.reseed, by_method ? run.method : std::string());
  };
  std::map<Key, const RunResult*> others;
  for (const RunResult& run : after.runs) others[keyOf(run)] = &run;
  ResultsDifference made;
  for (const RunResult& run : before.runs) {
    const auto other = others.find(keyOf(run));
    if (other == others.end()) {
      ++made.only_before;
      continue;
    }
    made.pairs.push_back(paired(run, *other->second));
    count(made.pairs.back(), made);
    others.erase(other);
  }
  made.only_after = static_cast<std::int64_t>(others.size());
  return made;
}

Table differenceTable(const ResultsDifference& difference, bool all) {
  Table table{"difference",
              "Run by run, before and after",
              {{"case"},
               {"seed"},
               {"method"},
               {"change"},
               {"before"},
               {"after"},
               {"before % of requirement", {}, 1},
               {"after % of requirement", {}, 1},
               {"why"}},
              {},
              {}};
  for (const RunPairing& pair : difference.pairs) {
    if (!all && pair.change == RunChange::kSame && pair.before.status == pair.after.status)
      continue;
    const std::string method = pair.before.method == pair.after.method
                                   ? pair.before.method
                                   : pair.before.method + " / " + pair.after.method;
    table.rows.push_back({pair.before.case_id, std::int64_t{pair.before.reseed}, method,
                          runChangeText(pair.change), pair.before.status, pair.after.status,
                          shareCell(pair.before), shareCell(pair.after), pair.why});
  }
  return table;
}

std::string differenceSentence(const ResultsDifference& difference) {
  std::string text = std::to_string(difference.pairs.size()) +
                     " runs in both: " + std::to_string(difference.better) + " better, " +
                     std::to_string(difference.worse) + " worse, " +
                     std::to_string(difference.same) + " the same (" +
                     std::to_string(difference.equal) + " bit for bit)";
  if (difference.only_before > 0)
    text += "; " + std::to_string(difference.only_before) + " only before";
  if (difference.only_after > 0)
    text += "; " + std::to_string(difference.only_after) + " only after";
  return text + ".";
}

}  // namespace boresight::sessions
