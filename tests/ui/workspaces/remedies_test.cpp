// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies.h"

#include <algorithm>

#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "tests/ui/workspaces/desk.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/widgets/widgets.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/uncertainty_dialog.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// The case whose run failed.
class RemediesTest : public test::WindowTest {
 protected:
  void SetUp() override {
    open(test::Desk::failed().withItsRun(file_));
    ASSERT_TRUE(wait([&] { return bar().verdict().tone == VerdictTone::kBad && resting(); }));
    ASSERT_FALSE(window_.state().snapshot()->converged());
  }
  VerdictBar& bar() { return window_.frame().verdict(); }
  void press(Step step) {
    window_.workspaces().show(Workspace::kDiagnose);
    for (auto* button : window_.dock(QStringLiteral("remedies"))->findChildren<QPushButton*>())
      if (button->property("step") == static_cast<int>(step)) return button->click();
    ADD_FAILURE() << "no such remedy";
  }
};

TEST_F(RemediesTest, OneClickOnTheVerdictMendsATurnedSeed) {
  ASSERT_EQ(bar().verdict().step, Step::kWiderSearch) << bar().text().toStdString();
  QTest::mouseClick(&bar().action(), Qt::LeftButton);
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 2 && resting(); }));
  EXPECT_TRUE(window_.state().snapshot()->converged());
  EXPECT_EQ(window_.document().session().cases.front()->uncertainty.rotation_deg.z(), 180.0);
  EXPECT_TRUE(window_.document().canUndo()) << "it is an edit";
}

TEST_F(RemediesTest, DiagnoseSaysWhyInFullAndBringsTheTools) {
  press(Step::kNudgeSeed);
  EXPECT_TRUE(test::has(find<Banner>("runStatus").text(), "Did not converge."));
  ASSERT_TRUE(wait([&] { return window_.state().cursor().iteration == -1; }));
  press(Step::kAnnotate);
  ASSERT_TRUE(wait([&] { return window_.workspaces().current() == Workspace::kAnnotate; }));
  EXPECT_EQ(window_.annotation().mode(), PlaceMode::kPoint);
  press(Step::kMask);
  ASSERT_TRUE(wait([&] { return window_.dock(QStringLiteral("mask"))->isVisible(); }));
}

TEST_F(RemediesTest, NextToALongButton_CausesAreWhole) {
  auto run = std::make_shared<sessions::LocalizationTrace>(*window_.state().snapshot());
  run->probability = 0.095;
  window_.state().setSnapshot(run);
  window_.workspaces().show(Workspace::kDiagnose);
  const auto causes =
      window_.dock(QStringLiteral("remedies"))->findChild<QScrollArea*>()->findChildren<QLabel*>();
  ASSERT_GE(causes.size(), 6);
  EXPECT_TRUE(wait([&] {
    return std::ranges::all_of(causes, [](const QLabel* cause) {
      return cause->height() >= cause->heightForWidth(cause->width());
    });
  }));
}

TEST_F(RemediesTest, StatedUncertaintyRunsAgain) {
  const test::ModalAnswer<UncertaintyDialog> answer([](UncertaintyDialog& dialog) {
    const auto boxes = dialog.findChildren<QDoubleSpinBox*>();
    ASSERT_EQ(boxes.size(), 6);
    boxes.back()->setValue(45.0);  // about z
    dialog.accept();
  });
  press(Step::kUncertainty);
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 2 && resting(); }));
  EXPECT_TRUE(window_.state().snapshot()->converged());
}

}  // namespace
}  // namespace boresight::ui
