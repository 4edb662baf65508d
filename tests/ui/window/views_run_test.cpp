// SPDX-License-Identifier: Apache-2.0
// The images of a rig run as one from the window.
#include <algorithm>

#include "sessions/session/views_run.h"
#include "tests/support/turned_view.h"
#include "tests/ui/window_test.h"
#include "ui/panels/banner.h"

namespace boresight::ui {
namespace {

class ViewsRunWindowTest : public test::WindowTest {
 protected:
  QAction* together() {
    for (QAction* each : window_.findChildren<QAction*>())
      if (each->text().remove(QLatin1Char('&')) == QStringLiteral("Run with the other views"))
        return each;
    return nullptr;
  }
  const sessions::Session& session() { return window_.document().session(); }
  QString banner() { return find<Banner>("runStatus").text(); }
};

TEST_F(ViewsRunWindowTest, EveryViewGetsARunThatIsTheSameHeadless) {
  open(test::sessionOfTwoViews(folder_.path()));
  ASSERT_TRUE(together() && together()->isEnabled());
  std::size_t most = 0;
  QObject::connect(&window_.state(), &ViewState::changed, [&] {
    const auto& shown = window_.state().snapshot();
    if (shown && !shown->finished) most = std::max(most, shown->iterations.size());
  });
  together()->trigger();
  ASSERT_TRUE(wait([&] { return session().runs.size() == 2; }))
      << window_.lastMessage().toStdString();
  ASSERT_TRUE(rests());
  EXPECT_GT(most, 1u) << "iterations show as they come";
  const auto expected = sessions::runViews(session(), session().cases[0]->id);
  for (std::size_t v = 0; v < 2; ++v) {
    EXPECT_EQ(session().runs[v].digest, expected[v].digest);
    EXPECT_EQ(session().runs[v].case_id, session().cases[v]->id);
    EXPECT_EQ(session().runs[v].together->views, expected[v].views);
  }
  EXPECT_TRUE(banner().startsWith(QStringLiteral("Together with ")) &&
              banner().contains(QStringLiteral("Converged in")))
      << banner().toStdString();
  EXPECT_EQ(window_.cases().staleness(), QString());

  // The other case shows its own run of it, with everything in between.
  window_.cases().chooseCase(QString::fromStdString(session().cases[1]->id));
  ASSERT_TRUE(wait([&] {
    const auto& shown = window_.state().snapshot();
    return shown && shown->digest == expected[1].digest;
  }));
  EXPECT_EQ(window_.state().snapshot()->own_view, 1u);
  EXPECT_FALSE(window_.state().snapshot()->iterations.front()->templates.empty());
  EXPECT_TRUE(banner().startsWith(QStringLiteral("Together with "))) << banner().toStdString();
}

TEST_F(ViewsRunWindowTest, AViewThatIsLeftOutSaysWhy) {
  open(test::withBlackSecond(test::sessionOfTwoViews(folder_.path()), folder_.path()));
  together()->trigger();
  ASSERT_TRUE(wait([&] { return session().runs.size() == 2; }));
  ASSERT_TRUE(rests());
  EXPECT_TRUE(test::has(banner(), "left out: too few of its templates"));
  window_.cases().chooseCase(QString::fromStdString(session().cases[1]->id));
  ASSERT_TRUE(wait([&] {
    const auto& shown = window_.state().snapshot();
    return shown && shown->own_view == 1;
  }));
  EXPECT_TRUE(test::has(banner(), "This view was left out: too few of its"));
}

TEST_F(ViewsRunWindowTest, WithoutOthersItSaysWhy) {
  const sessions::Session two = test::sessionOfTwoViews(folder_.path());
  open(sessions::withoutRigLink(two, two.cases[0]->id));
  EXPECT_FALSE(together()->isEnabled());
  EXPECT_TRUE(test::has(together()->toolTip(), "of no rig"));
  window_.document().edit(two, QStringLiteral("Link"));
  EXPECT_TRUE(together()->isEnabled());
  EXPECT_FALSE(together()->toolTip().contains(QStringLiteral("of no rig")));
}

TEST_F(ViewsRunWindowTest, AStopHaltsItAndItGoesOn) {
  open(test::sessionOfTwoViews(folder_.path()));
  together()->trigger();
  window_.cases().stop();
  ASSERT_TRUE(wait([&] { return window_.run().state() == RunState::kHalted; }));
  EXPECT_TRUE(session().runs.empty());
  QTest::keyClick(&window_, Qt::Key_F5);
  ASSERT_TRUE(wait([&] { return session().runs.size() == 2; }));
  ASSERT_TRUE(rests());
  EXPECT_EQ(session().runs[0].digest,
            sessions::runViews(session(), session().cases[0]->id)[0].digest);
}

TEST_F(ViewsRunWindowTest, ItIsNotGoneOnFromAnIteration) {
  open(test::sessionOfTwoViews(folder_.path()));
  together()->trigger();
  ASSERT_TRUE(wait([&] { return session().runs.size() == 2; }));
  ASSERT_TRUE(rests());
  window_.state().setCursor({2, Stage::kFinished});
  QTest::keyClick(&window_, Qt::Key_F5, Qt::ShiftModifier);
  ASSERT_TRUE(rests());
  EXPECT_TRUE(test::has(window_.lastMessage(), "made with other views"));
  EXPECT_EQ(session().runs.size(), 2u);
}

}  // namespace
}  // namespace boresight::ui
