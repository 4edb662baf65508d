// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/results_set.h"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

constexpr std::array<const char*, 6> kPaperOrder = {"seed", "orb",     "ssd",
                                                    "ncc",  "loftr-r", "loftr-s"};

/// Where a method stands: its place in the paper, then others, then WHS.
std::size_t rankOf(const std::string& name) {
  const std::string method = name.substr(0, name.find(' '));
  if (method == "whs") return kPaperOrder.size() + 1;
  const auto* found = std::find(kPaperOrder.begin(), kPaperOrder.end(), method);
  return static_cast<std::size_t>(found - kPaperOrder.begin());
}

bool selects(const std::vector<std::string>& filter, const std::string& value) {
  return filter.empty() || std::find(filter.begin(), filter.end(), value) != filter.end();
}

/// Everything but the note decides whether runs belong into one row.
auto settingsOf(const MethodFacts& facts) {
  return std::tie(facts.profile, facts.options_sha256, facts.reseed_scale, facts.mesh_of,
                  facts.mirror, facts.note);
}

/// The names of a method's variants: by the method alone, with the profile, with the file.
std::string shownName(const std::vector<ResultsFacts>& files, const ResultsFacts& file,
                      const MethodFacts& method) {
  bool others = false;
  bool others_of_profile = false;
  for (const ResultsFacts& other : files)
    for (const MethodFacts& facts : other.methods) {
      if (facts.method != method.method || settingsOf(facts) == settingsOf(method)) continue;
      others = true;
      others_of_profile = others_of_profile || facts.profile == method.profile;
    }
  if (!others) return method.method;
  return method.method + " " + (others_of_profile ? file.file.stem().string() : method.profile);
}

/// Which file holds a run, so that none counts twice.
class SeenRuns {
 public:
  void note(const ResultsFacts& file, const RunResult& run) {
    const auto [at, is_new] = seen_.emplace(
        std::tuple(file.dataset.dataset_sha256, run.case_id, run.reseed, run.method), &file);
    if (!is_new)
      throw InputError(file.file, "run of " + run.case_id,
                       "it is also in " + at->second->file.string() +
                           ": give one of the files, or join them with `whs merge`");
  }

 private:
  std::map<std::tuple<std::string, std::string, std::int32_t, std::string>, const ResultsFacts*>
      seen_;
};

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
  SeenRuns seen;
  for (const ResultsFacts& file : set.files) {
    std::map<std::string, std::string> shown;
    for (const MethodFacts& method : file.methods) {
      shown[method.method] = shownName(set.files, file, method);
      set.methods[shown[method.method]] = method;
    }
    forEachRun(file.file, [&](const RunResult& run) {
      if (!filter.takes(run)) return;
      set.runs.push_back(run);
      if (const auto name = shown.find(run.method); name != shown.end())
        set.runs.back().method = name->second;
      seen.note(file, set.runs.back());
    });
  }
  return set;
}

}  // namespace boresight::sessions
