// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_of_results.h"

#include <gtest/gtest.h>

#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/queue.h"
#include "sessions/session/case_run.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/run_batch.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::runBatch;

using std::string_literals::operator""s;

/// The example, run with two seeds a case.
class SessionOfResults : public testing::Test {
 protected:
  SessionOfResults() {
    options_.localizer = defaultProfile();
    options_.localizer.search.enabled = false;
    options_.localizer.loop.max_attempts = 1;
    options_.localizer.loop.max_iterations = 1;
    options_.reseeds = 1;
    static const std::vector<RunResult> runs = runBatch(readDataset(dataset_file_), options_, {});
    runs_ = runs;
    // How the runs ended is made up: what matters is who comes first.
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      runs_[i].completed = i > 0;
      runs_[i].status = i > 0 ? "converged" : "pnp_failed";
      runs_[i].error->normal_mm = 0.1 * static_cast<double>(i);
      runs_[i].error->lateral_mm = 0.0;
      runs_[i].error->rotation_mrad = 0.0;
      runs_[i].requirement = Requirement{0.4, 0.4, 0.25, std::nullopt};
    }
  }
  void write(const std::string& method = "whs", const std::string& mirror = {}) const {
    ResultsWriter writer(file_, datasetFacts(readDataset(dataset_file_)));
    MethodFacts facts = methodFacts(method, "default", options_.localizer);
    facts.mirror = mirror;
    writer.admit(facts);
    writer.begin(BatchRun{});
    for (RunResult run : runs_) {
      run.method = method;
      writer.add(run);
    }
  }

  std::string message() const {
    return folder_.message([this] { (void)sessionOfResults(file_); });
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "r.sqlite";
  const std::filesystem::path dataset_file_ = test::exampleFolder() / "dataset.json";
  BatchOptions options_;
  std::vector<RunResult> runs_;
};

TEST_F(SessionOfResults, WorstRuns_AreListedFirstAsInTheQueue) {
  write();
  const Session session = sessionOfResults(file_);
  std::vector<std::string> expected;
  for (const std::size_t i : {0U, 3U, 2U, 1U}) expected.push_back(resultCaseId(runs_[i]));
  std::vector<std::string> listed;
  for (const auto& session_case : session.cases) listed.push_back(session_case->id);
  EXPECT_EQ(listed, expected);
  std::vector<std::string> queued;
  const std::vector<QueueRow> rows = queueRows(session);
  for (const QueueRow& row : rows) queued.push_back(row.case_id);
  EXPECT_EQ(queued, expected);
  EXPECT_EQ(troubleText(rows[0]), "not run in this session; in the results: pnp_failed");
  EXPECT_EQ(troubleText(rows[1]),
            "not run in this session; in the results: error 75 % of the requirement");
}

TEST_F(SessionOfResults, TheQueueOfTheResultsIsThatOfTheirSession) {
  runs_.back().status = "input_error";
  runs_.back().completed = false;
  runs_[1].requirement.reset();
  write();
  const std::vector<QueueRow> of_session = queueRows(sessionOfResults(file_));
  const std::vector<QueueRow> rows = resultsQueue(file_);
  EXPECT_EQ(rows.size(), runs_.size() - 1);
  EXPECT_EQ(queueText(rows), queueText(of_session));
  EXPECT_EQ(queueCsv(rows), queueCsv(of_session));
}

TEST_F(SessionOfResults, RepeatsARunByItsOwnSeedAndOptions) {
  write();
  const Session session = sessionOfResults(file_);
  for (const RunResult& run : runs_) {
    const SessionCase* session_case = session.findCase(resultCaseId(run));
    ASSERT_NE(session_case, nullptr) << resultCaseId(run);
    EXPECT_EQ(runCase(session, session_case->id, RecordLevel::kSummary).digest, run.digest)
        << "bit for bit what `whs evaluate` ran";
  }
}

TEST_F(SessionOfResults, RefusesWhatItCannotShow) {
  EXPECT_THROW(sessionOfResults(file_), InputError);
  write("ncc");
  EXPECT_THAT(folder_.message([&] { (void)resultsQueue(file_); }),
              HasSubstr("no runs of the method whs"));
  EXPECT_THAT(message(), HasSubstr("no runs of the method whs"));
  write("whs", "x");
  EXPECT_THAT(message(), HasSubstr("deliberately wrong"));
}

TEST_F(SessionOfResults, RefusesABopFolderAndADatasetThatHasChanged) {
  const std::string bop = folder_.path().string();
  for (const auto& [dataset, text] : {std::pair(bop, "BOP folder " + bop),
                                      std::pair(dataset_file_.string(), "has changed since"s)}) {
    std::filesystem::remove(file_);
    ResultsWriter writer(file_, {dataset, "another", 2, "1"});
    writer.admit(methodFacts("whs", "default", options_.localizer));
    EXPECT_THAT(message(), HasSubstr(text));
  }
}

TEST(ResultTag, IsReadBack) {
  SessionCase session_case;
  session_case.tags = {"far", resultTag({"converged", true, 0.375})};
  EXPECT_EQ(session_case.tags[1], "result:converged:0.3750");
  ASSERT_TRUE(listedResult(session_case));
  EXPECT_TRUE(listedResult(session_case)->completed);
  EXPECT_DOUBLE_EQ(*listedResult(session_case)->error_share, 0.375);
  session_case.tags = {resultTag({"pnp_failed", false, std::nullopt})};
  EXPECT_EQ(listedResult(session_case)->status, "pnp_failed");
  EXPECT_FALSE(listedResult(session_case)->error_share);
  session_case.tags = {"far"};
  EXPECT_FALSE(listedResult(session_case));
}

}  // namespace
}  // namespace boresight::sessions
