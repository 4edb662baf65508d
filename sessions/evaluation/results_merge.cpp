// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// A temporary file next to the one that it becomes; removed unless it does.
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

/// The runs of the attached file `other` that are held already.
constexpr const char* kCommon =
    " FROM other.run o JOIN main.run h ON h.case_id = o.case_id AND h.reseed = o.reseed AND "
    "h.method = o.method ";

/// How far the poses of the same run are apart, number by number of their matrices.
constexpr const char* kPosesApart =
    "(SELECT max(abs(a.atom - b.atom)) FROM json_tree(o.camera_from_station) a JOIN "
    "json_tree(h.camera_from_station) b ON a.fullkey = b.fullkey WHERE a.atom IS NOT NULL)";

class Merge {
 public:
  Merge(const fs::path& draft, const ResultsFacts& first)
      : first_(first.file), dataset_(first.dataset), out_(draft, SqlAccess::kWrite) {
    out_.execute("PRAGMA synchronous = OFF");  // it is synchronized before it gets its name
    out_.execute("PRAGMA journal_mode = MEMORY");
    makeResultsTables(out_, dataset_);
  }

  void take(const fs::path& file) {
    const ResultsFacts facts = readResultsFacts(file);
    out_.run("ATTACH ?1 AS other", {file.string()});
    out_.execute("BEGIN");
    takeMethods(facts);
    refuseContradictions(file);
    refuseOtherInputs(facts);
    equal_ += integerOf(out_.value(std::string("SELECT count(*)") + kCommon +
                                   "WHERE (o.status = 'input_error') = (h.status = "
                                   "'input_error')"));
    removeRefused();
    takeBatchRuns();
    takeRuns(facts.format_version);
    out_.execute("COMMIT; DETACH other");
  }

  MergeCounts counts() { return {integerOf(out_.value("SELECT count(*) FROM run")), equal_}; }

 private:
  void takeMethods(const ResultsFacts& facts) {
    if (const auto wrong = contradiction(dataset_, facts.dataset))
      refuse(facts.file, first_, *wrong);
    for (const MethodFacts& method : facts.methods) {
      const auto [found, is_new] =
          methods_.try_emplace(method.method, KnownMethod{method, facts.file});
      if (is_new) {
        addMethodFacts(out_, method);
      } else if (const auto wrong = contradiction(found->second.facts, method)) {
        refuse(facts.file, found->second.file, *wrong);
      }
    }
  }

  void refuseContradictions(const fs::path& file) {
    SqlStatement statement(
        out_, std::string("SELECT o.case_id, o.reseed, o.method, h.status, o.status") + kCommon +
                  "WHERE o.status <> 'input_error' AND h.status <> 'input_error' AND (o.status <> "
                  "h.status OR o.success IS NOT h.success OR o.false_positive <> h.false_positive "
                  "OR o.digest <> h.digest OR (o.digest = '' AND NOT " +
                  kPosesApart + " < 1e-12)) LIMIT 1");
    if (!statement.step()) return;
    throw InputError(file, "run of " + textOf(statement.cell(0)),
                     "seed " + std::to_string(integerOf(statement.cell(1))) + ", method " +
                         textOf(statement.cell(2)) + " has another result in another file (" +
                         textOf(statement.cell(3)) + ", here " + textOf(statement.cell(4)) +
                         "); only equal runs can be merged");
  }

  /// Equal results of other inputs; unknown inputs are equal to any.
  void refuseOtherInputs(const ResultsFacts& facts) {
    if (facts.format_version != kResultsVersion) return;
    SqlStatement statement(
        out_, std::string("SELECT o.case_id") + kCommon +
                  "WHERE o.inputs_sha256 <> '' AND h.inputs_sha256 <> '' AND o.inputs_sha256 <> "
                  "h.inputs_sha256 LIMIT 1");
    if (!statement.step()) return;
    throw InputError(facts.file, "run of " + textOf(statement.cell(0)),
                     "it has other inputs in another file; only equal runs can be merged");
  }

  /// Runs whose input was rejected, while the other file has the completed run.
  void removeRefused() {
    const std::string ids = std::string("(SELECT h.id") + kCommon +
                            "WHERE h.status = 'input_error' AND o.status <> 'input_error')";
    for (const char* table : {"tag", "iteration", "match"})
      out_.execute(std::string("DELETE FROM main.") + table + " WHERE run IN " + ids);
    out_.execute("DELETE FROM main.run WHERE id IN " + ids);
  }

  /// A batch run that several files have is taken once.
  void takeBatchRuns() {
    const std::string names = joined(batchRunTable().names());
    const std::string same =
        "h.machine = o.machine AND h.began = o.began AND h.command = o.command AND h.shard = "
        "o.shard";
    out_.execute("INSERT INTO main.batch_run (" + names + ") SELECT " + names +
                 " FROM other.batch_run o WHERE NOT EXISTS (SELECT 1 FROM main.batch_run h WHERE " +
                 same + ") ORDER BY id");
    out_.execute(
        "DROP TABLE IF EXISTS temp.batch_run_of;"
        "CREATE TEMP TABLE batch_run_of AS SELECT o.id AS old, min(h.id) AS new FROM "
        "other.batch_run "
        "o JOIN main.batch_run h ON " +
        same + " GROUP BY o.id");
  }

  /// Those that are not held, each with an id of its own.
  void takeRuns(std::int64_t version) {
    out_.execute(
        std::string("DROP TABLE IF EXISTS temp.added;"
                    "CREATE TEMP TABLE added AS SELECT id AS old, (SELECT coalesce(max(id), 0) "
                    "FROM main.run) + row_number() OVER (ORDER BY id) AS new FROM other.run WHERE "
                    "id NOT IN (SELECT o.id") +
        kCommon + ")");
    const auto copy = [this](const std::string& table, const std::string& names) {
      out_.execute("INSERT INTO main." + table + " (run, " + names + ") SELECT new, " + names +
                   " FROM other." + table + " JOIN added ON old = run");
    };
    const std::string names = joined(runTableOf(version).names());
    const bool has_inputs = version == kResultsVersion;
    out_.execute(
        "INSERT INTO main.run (id, batch_run, " + names + (has_inputs ? "" : ", inputs_sha256") +
        ") SELECT a.new, s.new, " + names + (has_inputs ? "" : ", ''") +
        " FROM other.run JOIN added a ON a.old = id JOIN batch_run_of s ON s.old = batch_run "
        "ORDER BY a.new");
    copy("tag", "tag");
    copy("iteration", joined(stepTableOf(version).names()));
    copy("match", "step, " + joined(matchTable().names()));
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
  DatasetFacts dataset_;
  SqlDatabase out_;
  std::map<std::string, KnownMethod> methods_;
  std::int64_t equal_ = 0;
};

}  // namespace

std::optional<MergeCounts> mergeResults(const fs::path& out, const std::vector<fs::path>& inputs,
                                        const std::stop_token& stop) {
  requireWritable(out, FileUse::kResults);
  const std::unique_ptr<FileLock> lock = lockResults(out);  // from before `out` is read
  std::vector<fs::path> files;
  std::error_code error;
  if (fs::exists(out, error)) files.push_back(out);
  for (const fs::path& input : inputs)
    if (!fs::equivalent(input, out, error)) files.push_back(input);
  const Draft draft(out);
  MergeCounts counts;
  {
    Merge merge(draft.file(), readResultsFacts(files.front()));
    for (const fs::path& file : files) {
      if (stop.stop_requested()) return std::nullopt;
      merge.take(file);
    }
    counts = merge.counts();
  }
  if (stop.stop_requested()) return std::nullopt;
  moveIntoPlace(draft.file(), out, FileUse::kResults);
  return counts;
}

}  // namespace boresight::sessions
