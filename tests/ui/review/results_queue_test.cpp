// SPDX-License-Identifier: Apache-2.0
// A results file in the window: dropped, gone through, one of its runs repeated.
#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/results_writer.h"
#include "sessions/session/session_of_results.h"
#include "tests/ui/window_test.h"
#include "ui/review/queue_panel.h"

namespace boresight::ui {
namespace {

/// The example, each case from two seeds, by options under which none converges.
class ResultsQueueTest : public test::WindowTest {
 protected:
  ResultsQueueTest() {
    writeResults();
    window_.activateWindow();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&window_));
  }
  ~ResultsQueueTest() override {
    const auto file = window_.document().file();
    window_.document().close();
    std::filesystem::remove(file);
  }

  void writeResults() {
    const std::filesystem::path dataset = test::exampleFolder() / "dataset.json";
    sessions::BatchOptions options;
    options.localizer = defaultProfile();
    options.localizer.loop.max_iterations = 1;
    options.reseeds = 1;
    runs_ = sessions::runBatch(sessions::readDataset(dataset), options, {});
    sessions::ResultsWriter writer(results_,
                                   sessions::datasetFacts(sessions::readDataset(dataset)));
    writer.admit(sessions::methodFacts("whs", "default", options.localizer));
    writer.begin(sessions::Sitting{});
    for (const sessions::RunResult& run : runs_) writer.add(run);
  }
  std::filesystem::path results_ = folder_.path() / "results.sqlite";
  std::vector<sessions::RunResult> runs_;
};

TEST_F(ResultsQueueTest, RunsAreListedChosenAndRepeatedToTheBit) {
  drop(results_);
  ASSERT_TRUE(wait([&] { return window_.state().currentCase() != nullptr && resting(); }))
      << window_.lastMessage().toStdString();
  EXPECT_EQ(window_.document().session().cases.size(), 4u);
  EXPECT_FALSE(window_.dock(QStringLiteral("queue"))->visibleRegion().isEmpty())
      << "the queue comes to the front";
  auto* panel = window_.findChild<QueuePanel*>();
  auto* table = panel->findChild<QTableView*>(QStringLiteral("queue"));
  ASSERT_TRUE(wait([&] { return table->model()->rowCount() == 4 && resting(); }));
  const auto trouble = [table] {
    return table->model()->index(3, QueueModel::kTrouble).data().toString();
  };
  // The rows are there at once, what they say once the queue has been gone through.
  ASSERT_TRUE(wait([&] {
    return trouble().contains(QStringLiteral("iteration_limit")) && resting();
  })) << trouble().toStdString();
  const QModelIndex last = table->model()->index(3, 0);
  table->setFocus();
  table->setCurrentIndex(last);
  QTest::keyClick(table, Qt::Key_Return);
  ASSERT_TRUE(
      wait([&] { return window_.cases().caseId() == last.data().toString() && resting(); }));
  QTest::keyClick(&window_, Qt::Key_F5);
  const std::string id = last.data().toString().toStdString();
  ASSERT_TRUE(
      wait([&] { return window_.document().session().lastRunOf(id) != nullptr && resting(); }));
  for (const sessions::RunResult& run : runs_) {
    if (sessions::resultCaseId(run) != id) continue;
    EXPECT_EQ(window_.document().session().lastRunOf(id)->digest, run.digest);
  }
}

TEST_F(ResultsQueueTest, WhatIsNoResultsFileIsToldAndNothingIsLost) {
  folder_.write("no.sqlite", "no");
  drop(folder_.path() / "no.sqlite");
  ASSERT_TRUE(wait([&] { return resting() && !window_.lastMessage().isEmpty(); }));
  EXPECT_TRUE(window_.lastMessage().contains(QStringLiteral("no.sqlite")))
      << window_.lastMessage().toStdString();
  EXPECT_FALSE(window_.document().isOpen());
}

}  // namespace
}  // namespace boresight::ui
