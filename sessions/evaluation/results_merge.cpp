// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// A file that is made beside the one that it becomes, and goes away unless it does.
class Draft {
 public:
  explicit Draft(const fs::path& file) : file_(file) {
    file_ += ".merging-" + std::to_string(::getpid());
    remove();
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() { remove(); }
  const fs::path& file() const { return file_; }

 private:
  void remove() const {
    std::error_code error;
    fs::remove(file_, error);
    fs::remove(file_.string() + "-journal", error);
  }
  fs::path file_;
};

/// Rows of one table that belong to a run, from one file into another.
class RowCopy {
 public:
  RowCopy(SqlDatabase& from, SqlDatabase& to, const std::string& table,
          std::vector<std::string> columns)
      : rows_(from, "SELECT ?2, " + joined(columns) + " FROM " + table + " WHERE run = ?1"),
        insertion_(to, insertSql(table, withFirst("run", std::move(columns)))) {}

  void copy(std::int64_t id, std::int64_t new_id) {
    const SqlValue ids[] = {id, new_id};
    rows_.bind(ids);
    while (rows_.step()) insertion_.run(rows_.row());
  }

  static std::vector<std::string> withFirst(const char* first, std::vector<std::string> names) {
    names.insert(names.begin(), first);
    return names;
  }

 private:
  SqlStatement rows_;
  SqlStatement insertion_;
};

/// How a run ended, as far as two of the same must agree.
const std::vector<std::string> kEnding = {"status", "success", "false_positive", "digest"};

class Merge {
 public:
  Merge(const fs::path& draft, const ResultsFacts& first)
      : first_(first.file), out_(draft, SqlAccess::kWrite) {
    out_.execute("PRAGMA synchronous = OFF");  // it is synchronized before it gets its name
    out_.execute("PRAGMA journal_mode = MEMORY");
    makeResultsTables(out_, first.dataset);
    dataset_ = first.dataset;
  }

  void take(const fs::path& file) {
    SqlDatabase input(file, SqlAccess::kRead);
    const ResultsFacts facts = factsOf(input);
    out_.execute("BEGIN");
    takeFacts(facts);
    takeSittings(facts);
    takeRuns(input);
    out_.execute("COMMIT");
  }
  const MergeCounts& counts() const { return counts_; }

 private:
  void takeFacts(const ResultsFacts& facts) {
    if (const auto wrong = contradiction(dataset_, facts.dataset))
      refuse(facts.file, first_, *wrong);
    for (const MethodFacts& method : facts.methods) {
      const auto found = methods_.find(method.method);
      if (found == methods_.end()) {
        methods_[method.method] = {method, facts.file};
        addMethodFacts(out_, method);
      } else if (const auto wrong = contradiction(found->second.facts, method)) {
        refuse(facts.file, found->second.file, *wrong);
      }
    }
  }

  void takeSittings(const ResultsFacts& facts) {
    sitting_of_.clear();
    for (Sitting sitting : facts.sittings) {
      const std::int64_t before = sitting.id;
      const std::string key =
          sitting.machine + '\n' + sitting.began + '\n' + sitting.command + '\n' + sitting.shard;
      const auto known = sittings_.find(key);
      if (known == sittings_.end()) {
        addSitting(out_, sitting);
        sittings_[key] = sitting.id;
      }
      sitting_of_[before] = sittings_[key];
    }
  }

  void takeRuns(SqlDatabase& input) {
    const std::vector<std::string> names = runTable().names();
    SqlStatement runs(input, "SELECT id, sitting, " + joined(names) + " FROM run ORDER BY id");
    SqlStatement held(out_, "SELECT id, " + joined(kEnding) +
                                ", camera_from_station FROM run WHERE case_id = ?1 AND reseed = ?2 "
                                "AND method = ?3");
    SqlStatement insertion(out_, insertSql("run", RowCopy::withFirst("sitting", names)));
    RowCopy copies[] = {{input, out_, "tag", {"tag"}},
                        {input, out_, "iteration", stepTable().names()},
                        {input, out_, "match", RowCopy::withFirst("step", matchTable().names())}};
    while (runs.step()) {
      std::vector<SqlValue> row = runs.row();
      const std::int64_t id = integerOf(row.front());
      row.erase(row.begin());
      row.front() = sitting_of_[integerOf(row.front())];
      const RunResult run =
          runTable().read(input.file(), names, std::vector<SqlValue>(row.begin() + 1, row.end()));
      if (!isNew(run, held, input)) continue;
      insertion.run(row);
      const std::int64_t new_id = out_.lastId();
      for (RowCopy& copy : copies) copy.copy(id, new_id);
      ++counts_.runs;
    }
  }

  /// Whether a run is to be added; it is not when the same is held. Throws when they contradict.
  bool isNew(const RunResult& run, SqlStatement& held, const SqlDatabase& input) {
    const SqlValue key[] = {run.case_id, std::int64_t{run.reseed}, run.method};
    held.bind(key);
    if (!held.step()) return true;
    const std::vector<SqlValue> before = held.row();
    const std::string status = textOf(before[1]);
    if (run.inputFailed()) {
      counts_.equal += status == run.status ? 1 : 0;
      return false;
    }
    if (status == "input_error") {
      remove(integerOf(before[0]));
      return true;
    }
    const std::vector<SqlValue> after = ending(run);
    const bool same_pose = !run.digest.empty() || samePose(run, before.back(), input.file());
    if (!same_pose || !std::equal(after.begin(), after.end(), before.begin() + 1))
      throw InputError(input.file(), "run of " + run.case_id,
                       "seed " + std::to_string(run.reseed) + ", method " + run.method +
                           " ended otherwise in another of the files (" + status + ", here " +
                           run.status + "): only equal runs can be merged");
    ++counts_.equal;
    return false;
  }

  static std::vector<SqlValue> ending(const RunResult& run) {
    const std::vector<SqlValue> values = runTable().values(run);
    const std::vector<std::string> names = runTable().names();
    std::vector<SqlValue> made;
    for (const std::string& name : kEnding)
      made.push_back(values[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) -
                                                     names.begin())]);
    return made;
  }

  static bool samePose(const RunResult& run, const SqlValue& held, const fs::path& file) {
    const RunResult other = runTable().read(file, {"camera_from_station"}, {held});
    return (run.camera_from_station.rotation.coeffs() - other.camera_from_station.rotation.coeffs())
                   .norm() < 1e-12 &&
           (run.camera_from_station.translation_m - other.camera_from_station.translation_m)
                   .norm() < 1e-12;
  }

  void remove(std::int64_t id) {
    for (const char* sql :
         {"DELETE FROM run WHERE id = ?1", "DELETE FROM tag WHERE run = ?1",
          "DELETE FROM iteration WHERE run = ?1", "DELETE FROM match WHERE run = ?1"}) {
      SqlStatement removal(out_, sql);
      const SqlValue value = id;
      removal.run({&value, 1});
    }
    --counts_.runs;
  }

  [[noreturn]] static void refuse(const fs::path& file, const fs::path& held,
                                  const std::string& wrong) {
    throw InputError(held, wrong + ", as those of " + file.string());
  }

  struct KnownMethod {
    MethodFacts facts;
    fs::path file;
  };
  fs::path first_;
  SqlDatabase out_;
  DatasetFacts dataset_;
  std::map<std::string, KnownMethod> methods_;
  std::map<std::string, std::int64_t> sittings_;
  std::map<std::int64_t, std::int64_t> sitting_of_;  ///< of the file at hand
  MergeCounts counts_;
};

}  // namespace

MergeCounts mergeResults(const fs::path& out, const std::vector<fs::path>& inputs) {
  requireWritable(out, FileUse::kResults);
  std::vector<fs::path> files;
  std::error_code error;
  if (fs::exists(out, error)) files.push_back(out);
  for (const fs::path& input : inputs)
    if (!fs::equivalent(input, out, error)) files.push_back(input);
  const Draft draft(out);
  std::optional<MergeCounts> counts;
  {
    Merge merge(draft.file(), readResultsFacts(files.front()));
    for (const fs::path& file : files) merge.take(file);
    counts = merge.counts();
  }
  moveIntoPlace(draft.file(), out, FileUse::kResults);
  return *counts;
}

}  // namespace boresight::sessions
