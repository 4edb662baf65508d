// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/results_set.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <tuple>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

constexpr std::array<const char*, 6> kPaperOrder = {"seed", "orb",     "ssd",
                                                    "ncc",  "loftr-r", "loftr-s"};

/// Rank of a method: the order of the paper, then others, then WHS.
std::size_t rankOf(const std::string& name) {
  const std::string method = name.substr(0, name.find(' '));
  if (method == "whs") return kPaperOrder.size() + 1;
  const auto* found = std::find(kPaperOrder.begin(), kPaperOrder.end(), method);
  return static_cast<std::size_t>(found - kPaperOrder.begin());
}

bool selects(const std::vector<std::string>& filter, const std::string& value) {
  return filter.empty() || std::find(filter.begin(), filter.end(), value) != filter.end();
}

/// A method of a file, with everything that decides whether runs belong into one row.
struct Variant {
  MethodFacts facts;
  std::string version;  ///< of the program
  std::string file;     ///< without its ending, of the first file that has it
  std::string shown;

  auto settings() const {
    return std::tie(facts.method, facts.profile, facts.options_sha256, facts.reseed_scale,
                    facts.mesh_of, facts.mirror, facts.note);
  }
  bool same(const Variant& other) const {
    return settings() == other.settings() && version == other.version;
  }
};

/// The variants of all methods, each once.
std::vector<Variant> variantsOf(const std::vector<ResultsFacts>& files) {
  std::vector<Variant> variants;
  for (const ResultsFacts& file : files)
    for (const MethodFacts& facts : file.methods) {
      const Variant variant{facts, file.dataset.version, file.file.stem().string(), {}};
      if (std::ranges::none_of(variants, [&](const Variant& other) { return other.same(variant); }))
        variants.push_back(variant);
    }
  return variants;
}

/// By the method alone; where it has variants, with what sets the variant apart from the others:
/// its profile, its version of the program, or else its file.
std::string nameOf(const Variant& variant, const std::vector<Variant>& variants) {
  bool alone = true;
  bool profile_tells = true;
  bool version_tells = true;
  for (const Variant& other : variants) {
    if (other.facts.method != variant.facts.method || other.same(variant)) continue;
    alone = false;
    profile_tells = profile_tells && other.facts.profile != variant.facts.profile;
    version_tells = version_tells && other.version != variant.version;
  }
  const std::string& method = variant.facts.method;
  if (alone) return method;
  if (profile_tells) return method + " " + variant.facts.profile;
  return method + " " + (version_tells ? variant.version : variant.file);
}

/// Names them; equal names are numbered, because files in several folders may have one name.
std::vector<Variant> namedVariants(const std::vector<ResultsFacts>& files) {
  std::vector<Variant> variants = variantsOf(files);
  std::set<std::string> taken;
  for (Variant& variant : variants) {
    const std::string name = nameOf(variant, variants);
    variant.shown = name;
    for (int number = 2; !taken.insert(variant.shown).second; ++number)
      variant.shown = name + " (" + std::to_string(number) + ")";
  }
  return variants;
}

/// The iterations of runs that ended at the limit of iterations: tables judge their last pose.
void readStepsAtLimit(const std::filesystem::path& file, std::span<RunResult> runs) {
  std::vector<RunResult*> at_limit;
  for (RunResult& run : runs)
    if (run.status == localizationStatusText(LocalizationStatus::kIterationLimit))
      at_limit.push_back(&run);
  readSteps(file, at_limit);
}

RunSide sideOf(const RunResult& run) {
  RunSide side;
  side.digest = run.digest;
  side.status = run.status;
  side.converged = run.completed;
  side.iterations = run.iterations;
  side.wrong_mesh = run.wrong_mesh;
  if (const PoseError* error = run.completedError(); error != nullptr && run.requirement) {
    side.error = *error;
    side.error_share = requirementShare(*error, *run.requirement);
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
  const bool judgeable = judged.before.error_share || judged.after.error_share || before.wrong_mesh;
  if (!judgeable) {
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
  const PoseError* error = run.completedError();
  if (error == nullptr || !run.requirement) return std::nullopt;
  return 100.0 * requirementShare(*error, *run.requirement);
}

std::set<std::string> datasetsOf(const ResultsSet& set) {
  std::set<std::string> datasets;
  for (const ResultsFacts& file : set.files) datasets.insert(file.dataset.dataset_sha256);
  return datasets;
}

std::string meshText(const MethodFacts& facts) {
  if (!facts.mesh_of.empty()) return "the wrong mesh of " + facts.mesh_of;
  if (!facts.mirror.empty()) return "the wrong mesh mirrored across " + facts.mirror;
  return "the right mesh";
}

/// The first file of a set, for messages.
std::filesystem::path fileOf(const ResultsSet& set) {
  return set.files.empty() ? std::filesystem::path() : set.files.front().file;
}

/// InputError unless runs of these methods start from equal meshes and seeds.
void requireEqualTask(const ResultsSet& before, const std::string& before_method,
                      const ResultsSet& after, const std::string& after_method) {
  const auto earlier = before.methods.find(before_method);
  const auto later = after.methods.find(after_method);
  if (earlier == before.methods.end() || later == after.methods.end()) return;
  const MethodFacts& a = earlier->second;
  const MethodFacts& b = later->second;
  if (std::tie(a.mesh_of, a.mirror) != std::tie(b.mesh_of, b.mirror))
    throw InputError(fileOf(after), "its runs of " + after_method + " have " + meshText(b) +
                                        ", those before have " + meshText(a) +
                                        ": they cannot be compared");
  const bool drawn =
      std::ranges::any_of(before.runs, [](const RunResult& run) { return run.reseed > 0; });
  if (drawn && a.reseed_scale != b.reseed_scale)
    throw InputError(fileOf(after),
                     "its further seeds are drawn at another distance than those "
                     "before: they cannot be compared");
}

void requireComparable(const ResultsSet& before, const ResultsSet& after, bool by_method) {
  if (datasetsOf(before) != datasetsOf(after))
    throw InputError(fileOf(after), "its runs are of another dataset than those of " +
                                        fileOf(before).string() + ": they cannot be compared");
  const std::vector<std::string> names = before.methodNames();
  const std::vector<std::string> others = after.methodNames();
  if (names.empty() || others.empty()) return;
  if (!by_method) return requireEqualTask(before, names.front(), after, others.front());
  for (const std::string& name : names) requireEqualTask(before, name, after, name);
}

}  // namespace

bool methodBefore(const std::string& a, const std::string& b) {
  return std::tuple(rankOf(a), a) < std::tuple(rankOf(b), b);
}

std::vector<std::string> ResultsSet::methodNames() const {
  std::set<std::string> names;
  for (const RunResult& run : runs) names.insert(run.method);
  std::vector<std::string> ordered(names.begin(), names.end());
  std::sort(ordered.begin(), ordered.end(), methodBefore);
  return ordered;
}

bool ResultsFilter::takes(const RunResult& run) const {
  const bool tagged = tags.empty() || std::any_of(tags.begin(), tags.end(),
                                                  [&](const auto& tag) { return run.hasTag(tag); });
  return tagged && selects(stations, run.station) && selects(methods, run.method);
}

ResultsSet readResultsSet(const std::vector<std::filesystem::path>& files,
                          const ResultsFilter& filter) {
  ResultsSet set;
  for (const std::filesystem::path& file : files) set.files.push_back(readResultsFacts(file));
  const std::vector<Variant> variants = namedVariants(set.files);
  // Which file holds a run, so that none counts twice.
  std::map<std::tuple<std::string, std::string, std::int32_t, std::string>, const ResultsFacts*>
      seen;
  for (const ResultsFacts& file : set.files) {
    std::map<std::string, std::string> shown;
    for (const MethodFacts& method : file.methods) {
      const Variant wanted{method, file.dataset.version, {}, {}};
      const auto variant =
          std::ranges::find_if(variants, [&](const Variant& other) { return other.same(wanted); });
      shown[method.method] = variant->shown;
      set.methods[variant->shown] = method;
    }
    const std::size_t first = set.runs.size();
    forEachRun(file.file, [&](RunResult&& run) {
      if (filter.takes(run)) set.runs.push_back(std::move(run));
    });
    const std::span<RunResult> added = std::span(set.runs).subspan(first);
    readStepsAtLimit(file.file, added);
    for (RunResult& run : added) {
      if (const auto name = shown.find(run.method); name != shown.end()) run.method = name->second;
      const auto [at, is_new] = seen.emplace(
          std::tuple(file.dataset.dataset_sha256, run.case_id, run.reseed, run.method), &file);
      if (!is_new)
        throw InputError(file.file, "run of " + run.case_id,
                         "it is also in " + at->second->file.string() +
                             ": give one of the files, or join them with `whs merge`");
    }
  }
  return set;
}

ResultsDifference compareResults(const ResultsSet& before, const ResultsSet& after) {
  const bool by_method = before.methodNames().size() > 1 || after.methodNames().size() > 1;
  requireComparable(before, after, by_method);
  using Key = std::tuple<std::string, std::int32_t, std::string>;
  const auto keyOf = [by_method](const RunResult& run) {
    return Key(run.case_id, run.reseed, by_method ? run.method : std::string());
  };
  std::map<Key, const RunResult*> others;
  for (const RunResult& run : after.runs)
    if (!others.emplace(keyOf(run), &run).second)
      throw InputError(fileOf(after), "run of " + run.case_id,
                       "the case is in several datasets: compare one dataset at a time");
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
