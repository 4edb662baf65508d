// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/input_sheet_panel.h"
#include "ui/workspaces/uncertainty_dialog.h"

#include <gtest/gtest.h>
#include <QtTest/QTest>
#include <QtWidgets>

namespace boresight::ui {
namespace {

sessions::InputSheet someSheet() {
  sessions::InputSheet sheet;
  sheet.lines = {{"image", "1280 x 1024 px, 8 bit"}, {"seed distance", "0.412 m"}};
  return sheet;
}

class InputSheetPanelTest : public testing::Test {
 protected:
  InputSheetPanelTest() { panel_.show(); }
  QString flags() const { return panel_.findChild<QLabel*>(QStringLiteral("flags"))->text(); }

  InputSheetPanel panel_;
};

TEST_F(InputSheetPanelTest, ShowsTheLinesOfASheet_ChosenOnesAreCopied) {
  EXPECT_EQ(flags(), QStringLiteral("No case is open."));
  panel_.setSheet(someSheet());
  auto* table = panel_.findChild<QTableWidget*>();
  ASSERT_EQ(table->rowCount(), 2);
  EXPECT_EQ(table->item(1, 0)->text(), QStringLiteral("seed distance"));
  EXPECT_EQ(table->item(1, 1)->text(), QStringLiteral("0.412 m"));
  EXPECT_TRUE(flags().startsWith(QStringLiteral("✓")));
  panel_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&panel_));
  table->selectRow(1);
  table->setFocus();
  QTest::keyClick(table, Qt::Key_C, Qt::ControlModifier);
  EXPECT_EQ(QApplication::clipboard()->text(), QStringLiteral("seed distance\t0.412 m\n"));
  panel_.setSheet(std::nullopt);
  EXPECT_EQ(table->rowCount(), 0);
}

TEST_F(InputSheetPanelTest, RedFlags_AreListedInPlainSentences) {
  sessions::InputSheet sheet = someSheet();
  sheet.flags = {{"station_size", "the station is 1000 times too large"}, {"other", "also this"}};
  panel_.setSheet(sheet);
  EXPECT_EQ(flags(), QStringLiteral("⚠ the station is 1000 times too large\n⚠ also this"));
}

TEST_F(InputSheetPanelTest, UncertaintyButton_OpensTheDialog) {
  auto* button = panel_.findChild<QPushButton*>(QStringLiteral("inputSigmas"));
  EXPECT_FALSE(button->isEnabled());
  panel_.setSheet(someSheet());
  int asked = 0;
  QObject::connect(&panel_, &InputSheetPanel::sigmasRequested, [&asked] { ++asked; });
  button->click();
  EXPECT_EQ(asked, 1);
}

TEST(InputSigmasDialogTest, Dialog_ShowsAssumedAndReturnsStatedSigmas) {
  sessions::SessionCase session_case;
  session_case.camera.width = session_case.camera.height = 2048;
  session_case.mesh_scale_sigma = 0.001;
  InputSigmasDialog dialog(session_case, nullptr);
  EXPECT_EQ(dialog.meshScaleSigma(), 0.001);
  EXPECT_FALSE(dialog.calibrationSigma());
  auto* focal = dialog.findChild<QDoubleSpinBox*>(QStringLiteral("focal"));
  EXPECT_NEAR(focal->value(), 0.02, 1e-12) << "what is assumed, in percent";
  dialog.findChild<QGroupBox*>(QStringLiteral("cameraStated"))->setChecked(true);
  EXPECT_EQ(dialog.calibrationSigma(), (sessions::StatedCalibration{2e-4, 0.5}))
      << "both as shown, by the group alone";
  focal->setValue(0.05);
  ASSERT_TRUE(dialog.calibrationSigma());
  EXPECT_NEAR(dialog.calibrationSigma()->focal_relative.value_or(0.0), 5e-4, 1e-12);
  EXPECT_EQ(dialog.calibrationSigma()->principal_point_px, 0.5);
}

TEST(InputSigmasDialogTest, UnchangedMember_KeepsItsExactValueAndStaysAssumed) {
  sessions::SessionCase session_case;
  session_case.camera.width = session_case.camera.height = 2048;
  session_case.mesh_scale_sigma = 1.0 / 3000.0;
  session_case.calibration_sigma = sessions::StatedCalibration{std::nullopt, 1.0 / 3.0};
  InputSigmasDialog dialog(session_case, nullptr);
  EXPECT_EQ(dialog.meshScaleSigma(), session_case.mesh_scale_sigma);
  EXPECT_EQ(dialog.calibrationSigma(), session_case.calibration_sigma);
  auto* centre = dialog.findChild<QDoubleSpinBox*>(QStringLiteral("principalPoint"));
  const double shown = centre->value();
  centre->setValue(0.75);
  EXPECT_EQ(dialog.calibrationSigma(), (sessions::StatedCalibration{std::nullopt, 0.75}));
  centre->setValue(shown);
  dialog.findChild<QDoubleSpinBox*>(QStringLiteral("focal"))->setValue(0.25);
  EXPECT_EQ(dialog.calibrationSigma(), (sessions::StatedCalibration{0.0025, 1.0 / 3.0}));
}

TEST(InputSigmasDialogTest, TickingTheGroupAgain_StatesTheAssumedMemberAsShown) {
  sessions::SessionCase session_case;
  session_case.camera.width = session_case.camera.height = 2048;
  session_case.calibration_sigma = sessions::StatedCalibration{std::nullopt, 1.0 / 3.0};
  InputSigmasDialog dialog(session_case, nullptr);
  EXPECT_TRUE(dialog.findChild<QDoubleSpinBox*>(QStringLiteral("focal"))
                  ->toolTip()
                  .startsWith(QStringLiteral("Assumed")));
  auto* group = dialog.findChild<QGroupBox*>(QStringLiteral("cameraStated"));
  group->setChecked(false);
  EXPECT_FALSE(dialog.calibrationSigma());
  group->setChecked(true);
  EXPECT_EQ(dialog.calibrationSigma(), (sessions::StatedCalibration{2e-4, 1.0 / 3.0}));
}

TEST(JudgementDialogTest, StatesPlaceAndRequirementAndKeepsTheRest) {
  sessions::SessionCase session_case;
  session_case.requirement.emplace().projection_px = 5.0;
  const Pose exact{Eigen::Quaterniond(0.8, 0.6, 0.0, 0.0), {0.0, 1.0 / 3.0, 0.39}};
  session_case.camera_from_end_effector = exact;
  JudgementDialog dialog(session_case, *session_case.requirement, nullptr);
  EXPECT_EQ(dialog.cameraFromEndEffector(), exact) << "unchanged to the bit";
  EXPECT_EQ(dialog.requirement(), session_case.requirement);
  dialog.findChild<QDoubleSpinBox*>(QStringLiteral("endEffectorZ"))->setValue(410.0);
  EXPECT_NEAR(dialog.cameraFromEndEffector()->translation_m.z(), 0.41, 1e-12);
  EXPECT_EQ(dialog.cameraFromEndEffector()->translation_m.y(), 1.0 / 3.0);
  EXPECT_EQ(dialog.cameraFromEndEffector()->rotation.w(), 0.8);
  dialog.findChild<QDoubleSpinBox*>(QStringLiteral("lateral"))->setValue(0.4);
  EXPECT_EQ(dialog.requirement(), (sessions::Requirement{{}, 0.4, {}, 5.0}))
      << "the other limits stay without";
  dialog.findChild<QGroupBox*>(QStringLiteral("endEffectorStated"))->setChecked(false);
  EXPECT_FALSE(dialog.cameraFromEndEffector());
}

TEST(JudgementDialogTest, LimitsThatAreNotChanged_KeepTheirExactValuesOrStayNoLimits) {
  sessions::SessionCase session_case;
  session_case.requirement = {1.0 / 3.0, std::nullopt, 0.0004, std::nullopt};
  JudgementDialog dialog(session_case, *session_case.requirement, nullptr);
  auto* lateral = dialog.findChild<QDoubleSpinBox*>(QStringLiteral("lateral"));
  EXPECT_EQ(lateral->text(), QStringLiteral("no limit"));
  EXPECT_EQ(dialog.requirement(), session_case.requirement);
  lateral->setValue(0.5);
  EXPECT_EQ(dialog.requirement(), (sessions::Requirement{1.0 / 3.0, 0.5, 0.0004, {}}));
  lateral->setValue(0.0);
  dialog.findChild<QDoubleSpinBox*>(QStringLiteral("normal"))->setValue(0.0);
  EXPECT_EQ(dialog.requirement(), (sessions::Requirement{{}, {}, 0.0004, {}})) << "withdrawn";
  auto* rotation = dialog.findChild<QDoubleSpinBox*>(QStringLiteral("rotation"));
  EXPECT_EQ(rotation->text(), QStringLiteral("0.0004 deg")) << "not rounded to no limit";
  rotation->setValue(0.0);
  EXPECT_FALSE(dialog.requirement()) << "that of the preset applies";
}

/// A requirement of a case replaces that of the preset as a whole.
TEST(JudgementDialogTest, FirstChangedLimit_StatesAllThatAppliedBefore) {
  const sessions::Requirement preset{0.4, 1.0 / 3.0, 0.25, 5.0};
  JudgementDialog dialog(sessions::SessionCase(), preset, nullptr);
  auto* normal = dialog.findChild<QDoubleSpinBox*>(QStringLiteral("normal"));
  EXPECT_EQ(normal->value(), 0.4) << "as it applies";
  EXPECT_TRUE(dialog.findChild<QGroupBox*>(QStringLiteral("requirement"))
                  ->title()
                  .contains(QStringLiteral("assumed")));
  EXPECT_FALSE(dialog.requirement()) << "nothing is changed";
  normal->setValue(0.3);
  EXPECT_EQ(dialog.requirement(), (sessions::Requirement{0.3, 1.0 / 3.0, 0.25, 5.0}));
  normal->setValue(0.4);
  EXPECT_FALSE(dialog.requirement());
}

TEST(UncertaintyDialogTest, FiguresThatAreNotChanged_KeepTheirExactValues) {
  sessions::DeclaredUncertainty stated;
  stated.translation_m = {1.0 / 300.0, 12.5, 0.0};
  stated.rotation_deg = {1.0 / 3.0, 5.0, 180.0};
  UncertaintyDialog dialog(stated, nullptr);
  EXPECT_EQ(dialog.uncertainty(), stated);
  dialog.findChild<QDoubleSpinBox*>(QStringLiteral("zAlong"))->setValue(2.0);
  stated.translation_m.z() = 0.002;
  EXPECT_EQ(dialog.uncertainty(), stated);
}

TEST(JudgementDialogTest, SymmetriesAreReadFromText_AndStayExactWhereItIsUnchanged) {
  sessions::SessionCase session_case;
  session_case.symmetries = sessions::symmetriesIn("z at 0.1 0 0");
  session_case.symmetries.continuous[0].point_m.y() = 1e-12;  // not in the text
  JudgementDialog dialog(session_case, sessions::Requirement(), nullptr);
  EXPECT_EQ(dialog.symmetries(), session_case.symmetries);
  auto* text = dialog.findChild<QLineEdit*>(QStringLiteral("symmetries"));
  const QPushButton* accept = dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
  text->setText(QStringLiteral("z 100"));
  EXPECT_FALSE(accept->isEnabled());
  EXPECT_TRUE(dialog.findChild<QLabel*>(QStringLiteral("problem"))
                  ->text()
                  .contains(QStringLiteral("not a part of a whole turn")));
  text->setText(QStringLiteral("z; x 180"));
  EXPECT_TRUE(accept->isEnabled());
  EXPECT_EQ(dialog.symmetries(), sessions::symmetriesIn("z; x 180"));
}

}  // namespace
}  // namespace boresight::ui
