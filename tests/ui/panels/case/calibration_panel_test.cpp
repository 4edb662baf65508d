// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/calibration_panel.h"

#include "tests/support/calibration_session.h"
#include "tests/ui/window_test.h"

namespace boresight::ui {
namespace {

class CalibrationPanelTest : public test::WindowTest {
 protected:
  void calibrate() {
    window_.dock(QStringLiteral("calibration"))->show();
    find<QPushButton>("calibrate").click();
    ASSERT_TRUE(rests());
  }
  QString summary() {
    const auto& panel = *window_.findChild<CalibrationPanel*>();
    return panel.findChild<QLabel*>(QStringLiteral("summary"))->text();
  }
};

TEST_F(CalibrationPanelTest, FindsALongerLensAndUsesItForItsCases) {
  open(test::sessionOfALongerLens(8));
  calibrate();
  EXPECT_TRUE(test::has(summary(), "8 image"));
  const auto& table = find<QTableWidget>("calibrationParameters");
  ASSERT_EQ(table.rowCount(), 3);
  EXPECT_EQ(table.item(0, 0)->text(), QStringLiteral("Focal length, px"));
  EXPECT_TRUE(test::has(summary(), "The focal length changes by"));
  const double before = window_.document().session().cases[0]->camera.fx;
  ASSERT_TRUE(find<QPushButton>("use").isEnabled());
  find<QPushButton>("use").click();
  ASSERT_TRUE(rests());
  for (const auto& session_case : window_.document().session().cases) {
    EXPECT_NEAR(session_case->camera.fx / before, test::kLongerFocalLength, 1e-3);
    EXPECT_TRUE(session_case->calibration_sigma);
  }
  EXPECT_EQ(table.rowCount(), 3) << "the result stays";
  QTest::keySequence(&window_, QKeySequence::Undo);
  EXPECT_EQ(window_.document().session().cases[0]->camera.fx, before);
  EXPECT_EQ(table.rowCount(), 3) << "it is of this camera";
  EXPECT_TRUE(find<QPushButton>("use").isEnabled());
}

TEST_F(CalibrationPanelTest, ResultForAnotherCase_IsNotShown) {
  open(test::sessionOfALongerLens(8));
  window_.dock(QStringLiteral("calibration"))->show();
  find<QPushButton>("calibrate").click();
  const std::string other = window_.document().session().cases[1]->id;
  window_.cases().chooseCase(QString::fromStdString(other));
  ASSERT_TRUE(showsCase(other));
  EXPECT_EQ(find<QTableWidget>("calibrationParameters").rowCount(), 0);
  EXPECT_FALSE(find<QPushButton>("use").isEnabled());
}

/// It was written to all cases of the other camera.
TEST_F(CalibrationPanelTest, ResultForAnotherCamera_IsDropped) {
  sessions::Session session = test::sessionOfALongerLens(8);
  sessions::SessionCase other = *session.cases[0];
  other.id = "other";
  other.camera.fx *= 2.0;
  other.camera.fy *= 2.0;
  session = sessions::withCase(session, other);
  const auto other_camera = [&other](sessions::SessionCase& changed) {
    changed.camera = other.camera;
  };
  const std::string id = session.cases[0]->id;
  for (const bool ended : {true, false}) {
    open(session);
    window_.dock(QStringLiteral("calibration"))->show();
    find<QPushButton>("calibrate").click();
    ASSERT_TRUE(!ended || rests());
    ASSERT_TRUE(window_.document().edit(
        sessions::withChanged(window_.document().session(), id, other_camera),
        QStringLiteral("Use other.json")));
    EXPECT_TRUE(test::has(summary(), "The camera of the case has changed"));
    ASSERT_TRUE(rests());
    EXPECT_EQ(find<QTableWidget>("calibrationParameters").rowCount(), 0);
    EXPECT_FALSE(find<QPushButton>("use").isEnabled());
  }
}

TEST_F(CalibrationPanelTest, SaysWhyItCannot) {
  openExample();
  calibrate();
  EXPECT_TRUE(test::has(summary(), "Not calibrated: there are no images with observations"));
  EXPECT_FALSE(find<QPushButton>("use").isEnabled());
  EXPECT_TRUE(find<QPushButton>("calibrate").isEnabled());
}

}  // namespace
}  // namespace boresight::ui
