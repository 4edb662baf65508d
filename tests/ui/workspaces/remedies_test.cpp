// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies.h"

#include "tests/ui/window_test.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/widgets/widgets.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/uncertainty_dialog.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// The shipped case whose seed is turned by 40 deg, where 2.2 deg are stated; it has been run.
class RemediesTest : public test::WindowTest {
 protected:
  void SetUp() override {
    const auto file = sessions::examplesFolder() / "turned.boresight.json";
    open(sessions::SessionDocument::open(file, sessions::Access::kReadOnly).session());
    QTest::keyClick(&window_, Qt::Key_F5);
    ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 1 && resting(); }));
    ASSERT_FALSE(window_.state().snapshot()->converged());
    ASSERT_TRUE(wait([&] { return bar().verdict().tone == VerdictTone::kBad; }));
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

TEST_F(RemediesTest, DiagnoseSaysWhyInFull) {
  window_.workspaces().show(Workspace::kDiagnose);
  EXPECT_TRUE(test::has(find<Banner>("runStatus").text(), "Did not converge."));
}

TEST_F(RemediesTest, MaskAndAnnotateBringTheirTools) {
  press(Step::kAnnotate);
  ASSERT_TRUE(wait([&] { return window_.workspaces().current() == Workspace::kAnnotate; }));
  EXPECT_EQ(window_.annotation().mode(), PlaceMode::kPoint);
  press(Step::kMask);
  ASSERT_TRUE(wait([&] { return window_.dock(QStringLiteral("mask"))->isVisible(); }));
}

TEST_F(RemediesTest, NudgeShowsTheSeed) {
  press(Step::kNudgeSeed);
  ASSERT_TRUE(wait([&] { return window_.state().cursor().iteration == -1; }));
}

TEST_F(RemediesTest, StatedUncertaintyRunsAgain) {
  QTimer::singleShot(200, [&] {
    auto* dialog = qobject_cast<UncertaintyDialog*>(QApplication::activeModalWidget());
    ASSERT_NE(dialog, nullptr);
    const auto boxes = dialog->findChildren<QDoubleSpinBox*>();
    ASSERT_EQ(boxes.size(), 6);
    boxes.back()->setValue(45.0);  // about z
    dialog->accept();
  });
  press(Step::kUncertainty);
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 2 && resting(); }));
  EXPECT_TRUE(window_.state().snapshot()->converged());
}

}  // namespace
}  // namespace boresight::ui
