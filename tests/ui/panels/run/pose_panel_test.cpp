// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/pose_panel.h"

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/evaluation/pose_error.h"
#include "tests/support/example_run.h"
#include "tests/support/loaded_example.h"
#include "tests/support/random_pose.h"
#include "tests/ui/window/desktop.h"
#include "ui/panels/run/nudge_box.h"

namespace boresight::ui {
namespace {

using test::poseNear;

Pose movedBy(Pose pose, const Eigen::Vector3d& by_m) {
  pose.translation_m += by_m;
  return pose;
}

class PosePanelTest : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto example = test::loadedExample("os");
    state_.setCase(example);
    state_.setSnapshot(test::exampleRun());
    QObject::connect(
        &panel_.nudgeController(), &NudgeController::gestureFinished,
        [this](const Pose& before, const Pose& after) { gestures_.emplace_back(before, after); });
    panel_.resize(700, 900);
    panel_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&panel_));
  }

  template <class Widget>
  Widget& find(const char* name) {
    return *panel_.findChild<Widget*>(QString::fromUtf8(name));
  }
  enum Row { kX = 0, kZ = 2, kRotationX = 3, kQuaternionW = 6 };
  QString cell(Row row, PoseRole role) {
    return find<QTableWidget>("poses").item(row, 1 + static_cast<int>(role))->text();
  }
  QWidget& pad() {
    auto& found = find<QLabel>("nudgePad");
    found.setFocus();
    return found;
  }
  void press(const char* button) { QTest::mouseClick(&find<QPushButton>(button), Qt::LeftButton); }
  const Pose& truth() const { return *state_.currentCase()->source.camera_from_station_truth; }

  ViewState state_;
  PosePanel panel_{state_};
  std::vector<std::pair<Pose, Pose>> gestures_;
};

TEST_F(PosePanelTest, APoseIsShownInTheFramesThatHaveNames) {
  EXPECT_FALSE(find<QLabel>("namedPoses").isVisibleTo(&panel_)) << "none has a name";
  sessions::SessionCase session_case = state_.currentCase()->source;
  const Pose camera_from_rover{Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX())),
                               {1.0, 2.0, 3.0}};
  session_case.camera_reference =
      sessions::CameraReference{camera_from_rover, {"ROVER_FRAME", {7}}};
  state_.setCase(sessions::loadCase(session_case));
  find<QComboBox>("copiedRole").setCurrentIndex(static_cast<int>(PoseRole::kSeed));
  const QStringList lines = find<QLabel>("namedPoses").text().split(QLatin1Char('\n'));
  ASSERT_EQ(lines.size(), 4);
  EXPECT_EQ(lines[0], QStringLiteral("reference_from_station in ROVER_FRAME (7)"));
  const Pose expected = camera_from_rover.inverse() * session_case.camera_from_station_seed;
  for (int row = 0; row < 3; ++row)
    EXPECT_NEAR(lines[row + 1].simplified().split(QLatin1Char(' ')).last().toDouble(),
                expected.translation_m[row], 1e-6);
}

TEST_F(PosePanelTest, ShowsEveryPoseInEveryForm_ZeroWithoutASign) {
  EXPECT_NEAR(cell(kZ, PoseRole::kTruth).toDouble(), 1e3 * truth().translation_m.z(), 1e-4);
  const Eigen::Vector3d deg = rotationLog(truth().rotation) / kDegree_rad;
  EXPECT_NEAR(cell(kRotationX, PoseRole::kTruth).toDouble(), deg.x(), 1e-5);
  EXPECT_GE(cell(kQuaternionW, PoseRole::kTruth).toDouble(), 0.0);
  find<QComboBox>("copiedRole").setCurrentIndex(static_cast<int>(PoseRole::kTruth));
  const QStringList rows = find<QLabel>("matrix").text().split(QLatin1Char('\n'));
  ASSERT_EQ(rows.size(), 4);
  const QStringList row = rows[1].split(QLatin1Char(' '), Qt::SkipEmptyParts);
  ASSERT_EQ(row.size(), 4);
  EXPECT_NEAR(row[1].toDouble(), truth().matrix()(1, 1), 1e-6);
  EXPECT_NEAR(row[3].toDouble(), truth().translation_m.y(), 1e-7);
  EXPECT_EQ(cell(kX, PoseRole::kNudged), QString(QChar(0x2013)));
  state_.setNudgedPose(Pose{Eigen::Quaterniond::Identity(), {-1e-9, 0.0, 0.0}});
  EXPECT_EQ(cell(kX, PoseRole::kNudged), QStringLiteral("0.0000"));
}

TEST_F(PosePanelTest, FollowsTheCursor_OneSigmaIsThatOfASolvedPose) {
  EXPECT_TRUE(find<QLabel>("sigma").text().contains(QStringLiteral("mrad")));
  state_.setCursor({0, Stage::kFinished});
  const Pose& first = test::exampleRun()->iterations.front()->camera_from_station;
  EXPECT_NEAR(cell(kX, PoseRole::kEstimate).toDouble(), 1e3 * first.translation_m.x(), 1e-4);
  state_.setCursor({0, Stage::kMatch});
  EXPECT_TRUE(find<QLabel>("sigma").text().startsWith(QStringLiteral("No covariance")));
}

TEST_F(PosePanelTest, CopiedPose_CanBePasted) {
  find<QComboBox>("copiedRole").setCurrentIndex(static_cast<int>(PoseRole::kTruth));
  for (const char* button : {"copyRotationVector", "copyQuaternion", "copyMatrix"}) {
    press(button);
    const std::string text = QGuiApplication::clipboard()->text().toStdString();
    const auto parsed = sessions::parsePose(text, sessions::guessReading(text));
    ASSERT_TRUE(parsed.valid) << text;
    EXPECT_THAT(parsed.camera_from_station, poseNear(truth(), 1e-12, 1e-12));
  }
}

TEST_F(PosePanelTest, PastesAsOneGesture) {
  panel_.copyPose(PoseRole::kTruth, sessions::PoseForm::kQuaternion);
  const test::ModalAnswer<QDialog> accepts([](QDialog& dialog) { dialog.accept(); });
  const Pose before = state_.shownPose();
  panel_.pastePose();
  ASSERT_TRUE(state_.nudgedPose());
  EXPECT_THAT(*state_.nudgedPose(), poseNear(truth(), 1e-12, 1e-12));
  ASSERT_EQ(gestures_.size(), 1u);
  EXPECT_EQ(gestures_[0].first, before);
}

TEST_F(PosePanelTest, AKeyHeldDownIsOneGesture) {
  QWidget& field = pad();
  const Pose before = state_.shownPose();
  QTest::keyPress(&field, Qt::Key_Right);
  for (int i = 0; i < 4; ++i)
    for (const auto type : {QEvent::KeyPress, QEvent::KeyRelease}) {
      QKeyEvent repeated(type, Qt::Key_Right, Qt::NoModifier, QString(), true);
      QApplication::sendEvent(&field, &repeated);
    }
  EXPECT_TRUE(gestures_.empty());
  QTest::keyRelease(&field, Qt::Key_Right);
  ASSERT_EQ(gestures_.size(), 1u);
  EXPECT_EQ(gestures_[0].first, before);
  EXPECT_THAT(gestures_[0].second, poseNear(movedBy(before, {5e-3, 0, 0}), 1e-12, 1e-12));
  EXPECT_NEAR(find<QDoubleSpinBox>("moveX").value(), 5.0, 1e-9);
}

TEST_F(PosePanelTest, ModifiersTurnAndChangeTheStep) {
  QWidget& field = pad();
  const Pose before = state_.shownPose();
  const auto angle_deg = [&] {
    return rotationLog(state_.shownPose().rotation * before.rotation.conjugate()).norm() /
           kDegree_rad;
  };
  for (const auto& [modifier, expected_deg] :
       {std::pair(Qt::NoModifier, 0.2), std::pair(Qt::ShiftModifier, 2.2),
        std::pair(Qt::AltModifier, 2.22)}) {
    QTest::keyClick(&field, Qt::Key_PageUp, Qt::ControlModifier | modifier);
    EXPECT_NEAR(angle_deg(), expected_deg, 1e-9);
  }
  EXPECT_NEAR(find<QDoubleSpinBox>("turnZ").value(), 2.22, 1e-4);
  // About the station's centre, which therefore stays.
  const Eigen::Vector3d centre_m = panel_.nudgeController().frame().centre_in_station_m;
  EXPECT_LT((state_.shownPose() * centre_m - before * centre_m).norm(), 1e-9);
  EXPECT_EQ(gestures_.size(), 3u);
}

TEST_F(PosePanelTest, AValueTypedIsOneGestureAndMovesNothingElse) {
  auto& box = find<QDoubleSpinBox>("moveZ");
  const Pose before = state_.shownPose();
  box.setFocus();
  box.selectAll();
  QTest::keyClicks(&box, QStringLiteral("12.5"));
  EXPECT_FALSE(state_.nudgedPose()) << "half a number must not move anything";
  QTest::keyClick(&box, Qt::Key_Return);
  ASSERT_TRUE(state_.nudgedPose());
  EXPECT_THAT(*state_.nudgedPose(), poseNear(movedBy(before, {0, 0, 0.0125}), 1e-12, 1e-12));
  EXPECT_EQ(gestures_.size(), 1u);
}

TEST_F(PosePanelTest, StepsOfASpinBoxInOneGoAreOneGesture) {
  auto& box = find<QDoubleSpinBox>("turnX");
  box.setFocus();
  for (int i = 0; i < 5; ++i) box.stepUp();
  EXPECT_TRUE(gestures_.empty());
  ASSERT_TRUE(QTest::qWaitFor([&] { return !gestures_.empty(); }, 10000));
  EXPECT_EQ(gestures_.size(), 1u);
  EXPECT_NEAR(box.value(), 1.0, 1e-9);
}

TEST_F(PosePanelTest, BackDiscardAndUndo_ResetTheNudgedPose) {
  const Pose estimate = state_.shownPose();
  const auto& move_x = find<QDoubleSpinBox>("moveX");
  QTest::keyClick(&pad(), Qt::Key_Left);
  press("backToEstimate");
  EXPECT_EQ(state_.nudgedPose(), estimate);
  EXPECT_EQ(move_x.value(), 0.0);
  QTest::keyClick(&pad(), Qt::Key_Left);
  press("dropNudged");
  EXPECT_FALSE(state_.nudgedPose());
  EXPECT_EQ(gestures_.size(), 4u);
  EXPECT_EQ(gestures_.back().second, estimate);
  EXPECT_FALSE(find<QPushButton>("useAsSeed").isEnabled());
  QTest::keyClick(&pad(), Qt::Key_Right);
  EXPECT_NEAR(move_x.value(), 1.0, 1e-9);
  state_.setNudgedPose(estimate);  // as an undo command does
  EXPECT_EQ(move_x.value(), 0.0);
}

TEST_F(PosePanelTest, NudgesAlongStationAxesWhenAsked) {
  find<QComboBox>("axes").setCurrentIndex(static_cast<int>(NudgeAxes::kStation));
  const Pose before = state_.shownPose();
  QTest::keyClick(&pad(), Qt::Key_Right);
  const Eigen::Vector3d moved_m =
      before.rotation.conjugate() * (state_.shownPose().translation_m - before.translation_m);
  EXPECT_LT((moved_m - Eigen::Vector3d(1e-3, 0, 0)).norm(), 1e-12);
}

TEST_F(PosePanelTest, ComparesAnyTwoPosesAgainstTheRequirement) {
  PoseJudgement judgement;
  judgement.requirement.emplace();
  judgement.requirement->normal_mm = 1e-6;
  judgement.requirement->lateral_mm = 1e6;
  panel_.setJudgement(judgement);
  auto& label = find<QLabel>("difference");
  const auto error = sessions::poseError(truth(), state_.shownPose(), std::nullopt);
  for (const QString& part :
       {QString::number(error.normal_mm, 'f', 4), QString::number(error.geodesic_mrad, 'f', 4),
        QStringLiteral("beyond"), QStringLiteral("within")})
    EXPECT_TRUE(label.text().contains(part)) << part.toStdString();
  find<QComboBox>("differenceOf").setCurrentIndex(static_cast<int>(PoseRole::kNudged));
  EXPECT_TRUE(label.text().contains(QStringLiteral("no pose")));
}

TEST_F(PosePanelTest, ComparesToTheEquivalentPoseByDeclaredSymmetries) {
  sessions::SessionCase one = state_.currentCase()->source;
  one.symmetries = sessions::symmetriesIn("0.6 0 0.8");
  PoseJudgement judgement;
  judgement.comparer = sessions::PoseComparer(one, state_.currentCase()->scene.view());
  panel_.setJudgement(judgement);
  const auto error = judgement.comparer.difference(truth(), state_.shownPose());
  const auto plain = sessions::poseError(truth(), state_.shownPose(), one.camera_from_end_effector);
  EXPECT_NE(error.geodesic_mrad, plain.geodesic_mrad);
  EXPECT_TRUE(
      find<QLabel>("difference").text().contains(QString::number(error.geodesic_mrad, 'f', 4)));
  EXPECT_TRUE(find<QGroupBox>("apart").title().contains(QStringLiteral("declared symmetries")));
}

TEST_F(PosePanelTest, SurvivesTheCaseBeingClosed) {
  QTest::keyClick(&pad(), Qt::Key_Right);
  state_.setCase(nullptr);
  EXPECT_FALSE(find<QDoubleSpinBox>("moveX").isEnabled());
  EXPECT_EQ(cell(kX, PoseRole::kSeed), QString(QChar(0x2013)));
  QTest::keyClick(&find<QLabel>("nudgePad"), Qt::Key_Right);
  EXPECT_FALSE(state_.nudgedPose());
  panel_.pastePose();
}

TEST(PastePoseDialog, RefusesWhatIsNoRotationInASentence) {
  PastePoseDialog dialog(QStringLiteral("1.1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1"));
  EXPECT_FALSE(dialog.parsed().valid);
  const auto* verdict = dialog.findChild<QLabel*>(QStringLiteral("verdict"));
  EXPECT_TRUE(verdict->text().contains(QStringLiteral("not a rotation")));
  for (const QPushButton* button : dialog.findChildren<QPushButton*>())
    EXPECT_NE(button->isEnabled(), button->text().startsWith(QStringLiteral("Nudge")));
}

TEST(PastePoseDialog, Guess_CanBeCorrected) {
  PastePoseDialog dialog(QStringLiteral("0 1 0 0  -1 0 0 0  0 0 1 0  0.1 0.2 0.3 1"));
  ASSERT_TRUE(dialog.parsed().valid);
  EXPECT_EQ(dialog.parsed().camera_from_station.translation_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  dialog.findChild<QComboBox*>(QStringLiteral("direction"))->setCurrentIndex(1);
  const Eigen::Vector3d given_m = dialog.parsed().camera_from_station.inverse().translation_m;
  EXPECT_LT((given_m - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  dialog.findChild<QComboBox*>(QStringLiteral("matrixOrder"))->setCurrentIndex(0);
  EXPECT_FALSE(dialog.parsed().valid);
}

NudgeFrame frameOf(NudgeAxes axes, NudgePivot pivot) { return {axes, pivot, {0.1, -0.2, 0.05}}; }

TEST(Nudge, GoesBetweenAnyTwoPosesAndTurnsAboutAPivotThatStays) {
  Random random = test::randomFor("Nudge");
  for (const NudgeAxes axes : {NudgeAxes::kCamera, NudgeAxes::kStation})
    for (const NudgePivot pivot : {NudgePivot::kStationCentre, NudgePivot::kCameraCentre}) {
      const NudgeFrame frame = frameOf(axes, pivot);
      for (int i = 0; i < 30; ++i) {
        const Pose from = test::randomPose(random);
        const Pose to = test::randomPose(random);
        EXPECT_THAT(nudged(from, nudgeBetween(from, to, frame), frame), poseNear(to, 1e-9, 1e-9));
      }
      const Pose before = test::randomPose(random);
      Vector6d turn = Vector6d::Zero();
      turn.head<3>() = test::randomVector(random, 0.5);
      const Pose after = nudged(before, turn, frame);
      const Eigen::Vector3d pivot_in_station_m = pivot == NudgePivot::kStationCentre
                                                     ? frame.centre_in_station_m
                                                     : before.inverse().translation_m;
      EXPECT_LT((after * pivot_in_station_m - before * pivot_in_station_m).norm(), 1e-12);
      EXPECT_NEAR(rotationLog(after.rotation * before.rotation.conjugate()).norm(),
                  turn.head<3>().norm(), 1e-12);
    }
}

TEST(Nudge, MovesAlongTheAxesThatAreChosen) {
  Random random = test::randomFor("MovesAlong");
  const Pose before = test::randomPose(random);
  for (int axis = 0; axis < 3; ++axis) {
    Vector6d move = Vector6d::Zero();
    move[3 + axis] = 0.01;
    const auto moved_m = [&](NudgeAxes axes) -> Eigen::Vector3d {
      return nudged(before, move, frameOf(axes, NudgePivot::kStationCentre)).translation_m -
             before.translation_m;
    };
    EXPECT_LT((moved_m(NudgeAxes::kCamera) - move.tail<3>()).norm(), 1e-12);
    EXPECT_LT((moved_m(NudgeAxes::kStation) - before.rotation * move.tail<3>()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace boresight::ui
