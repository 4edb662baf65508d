// SPDX-License-Identifier: Apache-2.0
// Reviewing in the whole window: from a run to a decision, and what takes it away again.
#include <QtWidgets>

#include "tests/ui/review/review_fixture.h"
#include "tests/ui/window_test.h"
#include "ui/models/cases_model.h"
#include "ui/panels/banner.h"
#include "ui/review/review_panel.h"

namespace boresight::ui {
namespace {

using test::RunExample;

class ReviewWindowTest : public test::WindowTest {
 protected:
  bool checked() {
    return wait([this] {
      return panel().controller().isCurrent() && !panel().controller().isBusy() &&
             !window_.tasks().isBusy() && window_.run().state() != RunState::kWorking;
    });
  }
  ReviewPanel& panel() { return *window_.findChild<ReviewPanel*>(); }
  test::ReviewHands hands() { return test::ReviewHands(panel()); }
  QString banner() { return panel().findChild<Banner*>()->text(); }
  /// As the list of cases names the state of the example's first case.
  QString listed() {
    const auto* table = window_.findChild<QTableView*>(QStringLiteral("cases"));
    for (int row = 0; row < table->model()->rowCount(); ++row)
      if (table->model()->index(row, CasesModel::kCase).data().toString().toStdString() ==
          RunExample::get().id)
        return table->model()->index(row, CasesModel::kState).data().toString();
    return {};
  }
  void runAndValidate() {
    open(RunExample::get().session);
    QTest::keyClick(&window_, Qt::Key_F9);
    EXPECT_TRUE(hands().labelled("emptyHint").contains(QStringLiteral("F5")));
    QTest::keyClick(&window_, Qt::Key_F5);
    ASSERT_TRUE(checked());
    ASSERT_GT(hands().table().model()->rowCount(), 5) << "checks appear by themselves";
    hands().passOverAll(QStringLiteral("known"));
    hands().sign(QStringLiteral("Ada"), QStringLiteral("looked at it"));
    hands().click("validate");
    ASSERT_TRUE(listed().contains(QStringLiteral("validated"))) << listed().toStdString();
  }
};

TEST_F(ReviewWindowTest, FromARunToAValidationAndBack) {
  runAndValidate();
  window_.setFocus();
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_TRUE(listed().contains(QStringLiteral("converged"))) << listed().toStdString();
  QTest::keySequence(&window_, QKeySequence::Redo);
  EXPECT_TRUE(listed().contains(QStringLiteral("validated")));
  ASSERT_TRUE(window_.document().save());
  const auto file = window_.document().file();
  window_.document().close();
  ASSERT_TRUE(window_.openSession(file));
  ASSERT_TRUE(checked());
  EXPECT_TRUE(banner().contains(QStringLiteral("Validated by Ada"))) << banner().toStdString();
}

TEST_F(ReviewWindowTest, AnotherSeedDropsTheValidationAndItIsSaidWhy) {
  runAndValidate();
  Pose moved = window_.state().currentCase()->source.camera_from_station_seed;
  moved.translation_m.x() += 0.001;
  window_.cases().useAsSeed(moved);
  EXPECT_FALSE(panel().controller().isCurrent()) << "stale at once";
  EXPECT_TRUE(listed().contains(QStringLiteral("converged"))) << listed().toStdString();
  EXPECT_TRUE(banner().contains(QStringLiteral("no longer holds: the image, camera, mesh, seed")))
      << banner().toStdString();
  ASSERT_TRUE(checked());
  hands().passOverAll(QStringLiteral("known"));
  hands().sign(QStringLiteral("Ada"), QStringLiteral("again"));
  EXPECT_FALSE(hands().button("validate")->isEnabled()) << "the run is of the former seed";
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_TRUE(listed().contains(QStringLiteral("validated"))) << "what was judged is back";
}

}  // namespace
}  // namespace boresight::ui
