// SPDX-License-Identifier: Apache-2.0
// Repeats the run from the shown iteration with other options.
#include <algorithm>

#include "sessions/session/case_run.h"
#include "sessions/session/views_run.h"
#include "tests/support/example_run.h"
#include "tests/support/turned_view.h"
#include "tests/ui/window_test.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kFrom = 2;

class RerunTest : public test::WindowTest {
 protected:
  /// A session of one case with its whole run; the cursor stands on an iteration of it.
  void openAndRun() {
    open(test::withoutSearch(sessions::makeSession(test::exampleFolder() / "dataset.json")));
    ASSERT_TRUE(runToTheEnd(1));
    first_ = window_.state().snapshot();
    window_.state().setCursor({kFrom, Stage::kFinished});
  }

  decltype(sessions::Session::runs) const& runs() { return window_.document().session().runs; }

  LocalizerOptions otherOptions(double render_again_px = 5.0) {
    LocalizerOptions options = first_->options;
    options.templates.feature_size_m = 0.0;  // the case's own
    options.loop.render_again_px = render_again_px;
    return options;
  }
  void setOptions(const LocalizerOptions& options) {
    window_.cases().setOptions(QStringLiteral("default"), options);
  }

  void rerun() {
    QTest::keyClick(&window_, Qt::Key_F5, Qt::ShiftModifier);
    ASSERT_TRUE(rests());
  }

  ViewState::SnapshotPtr first_;
};

TEST_F(RerunTest, KeepsEarlierIterationsOfAStoredRunAndEqualsTheHeadlessRun) {
  openAndRun();
  ASSERT_TRUE(window_.document().save());
  ASSERT_TRUE(reopen());
  ASSERT_TRUE(wait([&] { return window_.state().snapshot() != nullptr; }));
  window_.state().setCursor({kFrom, Stage::kFinished});
  setOptions(otherOptions());
  rerun();
  ASSERT_EQ(runs().size(), 2u);
  const ViewState::SnapshotPtr current = window_.state().snapshot();
  ASSERT_TRUE(current->finished);
  const auto pose = [](const ViewState::SnapshotPtr& run, std::size_t iteration) {
    return run->iterations[iteration]->camera_from_station;
  };
  for (std::size_t i = 0; i < kFrom; ++i) EXPECT_EQ(pose(current, i), pose(first_, i)) << i;
  EXPECT_NE(pose(current, kFrom + 1), pose(first_, kFrom + 1));
  EXPECT_EQ(window_.cases().staleness(), QString());

  const sessions::RunRecord& record = runs()[1];
  ASSERT_TRUE(record.rerun.has_value());
  EXPECT_EQ(record.rerun->from, first_->digest);
  EXPECT_EQ(record.rerun->changes.front().iteration, kFrom);
  EXPECT_EQ(record.digest, current->digest);
  const auto plan = sessions::planOf(record, window_.document().session(), "session");
  EXPECT_EQ(sessions::runCase(*window_.state().currentCase(), plan).digest, record.digest);
  // And on from that one, which leaves the first change in place.
  setOptions(otherOptions(2.0));
  window_.state().setCursor({kFrom + 1, Stage::kFinished});
  rerun();
  ASSERT_EQ(runs().size(), 3u);
  EXPECT_EQ(runs()[2].rerun->changes.size(), 2u);
}

TEST_F(RerunTest, WithTheSameOptionsItIsTheSameRun_OnTheSeedANewOne) {
  openAndRun();
  rerun();
  ASSERT_EQ(runs().size(), 1u);
  EXPECT_EQ(window_.state().snapshot()->digest, first_->digest);
  EXPECT_NE(window_.state().snapshot(), first_);
  // On the seed, with other options, it is a new run.
  setOptions(otherOptions());
  window_.state().setCursor({-1, Stage::kFinished});
  rerun();
  ASSERT_EQ(runs().size(), 2u);
  EXPECT_FALSE(runs()[1].rerun.has_value());
  EXPECT_EQ(runs()[1].digest,
            sessions::runCase(window_.document().session(), runs()[1].case_id).digest);
}

TEST_F(RerunTest, SaysWhichOptionHoldsForAWholeRun_AndRefusesIterationsOfAnotherVersion) {
  openAndRun();
  LocalizerOptions options = otherOptions();
  options.edges.gaussian_sigma_px += 0.5;
  setOptions(options);
  rerun();
  EXPECT_EQ(runs().size(), 1u);
  EXPECT_TRUE(test::has(window_.lastMessage(), "edges.gaussian_sigma_px"));
  EXPECT_EQ(window_.state().snapshot(), first_) << "what was shown stays";
  // Iterations that are not those of the record.
  setOptions(otherOptions(first_->options.loop.render_again_px));
  auto other = std::make_shared<sessions::LocalizationTrace>(*first_);
  test::editIteration(*other, 0,
                      [](auto& moved) { moved.camera_from_station.translation_m.x() += 1e-9; });
  window_.state().setSnapshot(other);
  window_.state().setCursor({kFrom, Stage::kFinished});
  rerun();
  EXPECT_TRUE(test::has(window_.lastMessage(), "another version"));
  EXPECT_EQ(runs().size(), 1u);
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kFinished; }));
  EXPECT_EQ(window_.state().snapshot()->digest, first_->digest)
      << "a run from the start still goes";
}

class ViewsRunWindowTest : public test::WindowTest {
 protected:
  QAction* together() {
    for (QAction* each : window_.findChildren<QAction*>())
      if (each->text().remove(QLatin1Char('&')) == QStringLiteral("Run all cameras of this rig"))
        return each;
    return nullptr;
  }
  /// Of the second case.
  bool showsRun(const std::function<bool(const sessions::LocalizationTrace&)>& is) {
    window_.cases().chooseCase(QString::fromStdString(session().cases[1]->id));
    return wait([&] { return window_.state().snapshot() && is(*window_.state().snapshot()); });
  }
  const sessions::Session& session() { return window_.document().session(); }
  QString banner() { return find<Banner>("runStatus").text(); }
  sessions::Session twoViews() const {
    return test::withoutSearch(test::sessionOfTwoViews(folder_.path()));
  }
};

TEST_F(ViewsRunWindowTest, EveryViewGetsARunThatIsTheSameHeadless_AlsoAfterAStop) {
  open(twoViews());
  ASSERT_TRUE(together() && together()->isEnabled());
  std::size_t most = 0;
  QObject::connect(&window_.state(), &ViewState::changed, [&] {
    const auto& shown = window_.state().snapshot();
    if (shown && !shown->finished) most = std::max(most, shown->iterations.size());
  });
  together()->trigger();
  window_.cases().stop();
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kHalted; }));
  EXPECT_TRUE(session().runs.empty());
  ASSERT_TRUE(runToTheEnd(2)) << window_.lastMessage().toStdString();
  EXPECT_GT(most, 1u) << "iterations show as they come";
  const auto expected = sessions::runViews(session(), session().cases[0]->id);
  for (std::size_t v = 0; v < 2; ++v) {
    EXPECT_EQ(session().runs[v].digest, expected[v].digest);
    EXPECT_EQ(session().runs[v].case_id, session().cases[v]->id);
    EXPECT_EQ(session().runs[v].together->views, expected[v].views);
  }
  EXPECT_TRUE(banner().startsWith(QStringLiteral("Together with "))) << banner().toStdString();
  EXPECT_TRUE(test::has(banner(), "Converged in"));
  EXPECT_EQ(window_.cases().staleness(), QString());
  window_.state().setCursor({2, Stage::kFinished});
  QTest::keyClick(&window_, Qt::Key_F5, Qt::ShiftModifier);
  ASSERT_TRUE(rests());
  EXPECT_TRUE(test::has(window_.lastMessage(), "made with other views"));
  EXPECT_EQ(session().runs.size(), 2u) << "it does not continue from an iteration";

  // The other case shows its own run of it, with everything in between.
  ASSERT_TRUE(showsRun([&](const auto& run) { return run.digest == expected[1].digest; }));
  EXPECT_EQ(window_.state().snapshot()->own_view, 1u);
  EXPECT_FALSE(window_.state().snapshot()->iterations.front()->templates.empty());
  EXPECT_TRUE(banner().startsWith(QStringLiteral("Together with "))) << banner().toStdString();
}

TEST_F(ViewsRunWindowTest, AViewThatIsLeftOutSaysWhy) {
  open(test::withBlackSecond(twoViews(), folder_.path()));
  together()->trigger();
  ASSERT_TRUE(wait([&] { return session().runs.size() == 2 && resting(); }));
  EXPECT_TRUE(test::has(banner(), "left out: too few of its"));
  ASSERT_TRUE(showsRun([](const auto& run) { return run.own_view == 1; }));
  EXPECT_TRUE(test::has(banner(), "This view was left out: too few of its"));
}

TEST_F(ViewsRunWindowTest, WithoutOthersItSaysWhy) {
  const sessions::Session two = test::sessionOfTwoViews(folder_.path());
  open(sessions::withoutRigLink(two, two.cases[0]->id));
  EXPECT_FALSE(together()->isEnabled());
  EXPECT_TRUE(test::has(together()->toolTip(), "has no rig"));
  window_.document().edit(two, QStringLiteral("Link"));
  EXPECT_TRUE(together()->isEnabled());
  EXPECT_FALSE(together()->toolTip().contains(QStringLiteral("has no rig")));
}

}  // namespace
}  // namespace boresight::ui
