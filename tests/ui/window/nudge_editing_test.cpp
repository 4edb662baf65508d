// SPDX-License-Identifier: Apache-2.0
// Nudging by keys as edits of the document: one window, real events.
#include "tests/ui/window_test.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

class NudgeEditingTest : public test::SharedWindowTest {
 protected:
  void SetUp() override {
    SharedWindowTest::SetUp();
    window_.workspaces().reveal(QStringLiteral("pose"));
    id_ = window_.state().currentCase()->source.id;
  }
  const sessions::SessionCase& edited() { return *window_.document().session().findCase(id_); }
  const std::optional<Pose>& nudged() { return window_.state().nudgedPose(); }
  void nudge(Qt::Key key) {
    auto& pad = find<QLabel>("nudgePad");
    pad.setFocus();
    QTest::keyClick(&pad, key);
  }
  /// Once the views have a case with this seed.
  bool seedIs(const Pose& seed) {
    return wait([&] {
      return resting() && window_.state().currentCase()->source.camera_from_station_seed == seed;
    });
  }
  bool shows(const std::string& id) {
    window_.cases().chooseCase(QString::fromStdString(id));
    return showsCase(id);
  }
  void undo() { QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier); }

  std::string id_;
};

TEST_F(NudgeEditingTest, EachGestureIsOneEntryThatUndoAndRedoWalkThrough) {
  nudge(Qt::Key_Right);
  const Pose first = nudged().value();
  nudge(Qt::Key_Up);
  const Pose second = nudged().value();
  EXPECT_EQ(edited().camera_from_station_working, second);
  const auto other = sessions::SessionDocument::open(file_, sessions::Access::kReadOnly);
  ASSERT_TRUE(other.recovery());
  EXPECT_EQ(other.recovery()->edits.size(), 2u);
  EXPECT_EQ(other.recovery()->session.findCase(id_)->camera_from_station_working, second);
  undo();
  EXPECT_EQ(nudged(), first);
  undo();
  EXPECT_FALSE(nudged());
  EXPECT_FALSE(window_.document().canUndo());
  ASSERT_TRUE(window_.document().redo());
  EXPECT_EQ(nudged(), first);
  ASSERT_TRUE(window_.document().redo());
  EXPECT_EQ(nudged(), second);
}

TEST_F(NudgeEditingTest, DropGestureUnderWayAndUseAsSeed_AreEachOneUndoStep) {
  nudge(Qt::Key_Right);
  const Pose first = nudged().value();
  QTest::mouseClick(&find<QPushButton>("dropNudged"), Qt::LeftButton);
  EXPECT_FALSE(nudged());
  EXPECT_FALSE(edited().camera_from_station_working);
  undo();
  EXPECT_EQ(nudged(), first);
  find<QDoubleSpinBox>("moveX").stepUp();
  EXPECT_NE(nudged(), first);
  EXPECT_EQ(edited().camera_from_station_working, first) << "not yet ended";
  undo();
  EXPECT_EQ(nudged(), first);
  const Pose seed = edited().camera_from_station_seed;
  QTest::mouseClick(&find<QPushButton>("useAsSeed"), Qt::LeftButton);
  EXPECT_EQ(edited().camera_from_station_seed, first);
  EXPECT_FALSE(nudged());
  ASSERT_TRUE(seedIs(first));
  undo();
  ASSERT_TRUE(seedIs(seed));
  EXPECT_EQ(nudged(), first);
}

TEST_F(NudgeEditingTest, Nudging_ReloadsNothingAndKeepsRunsCurrent) {
  const auto before = window_.state().currentCase();
  const std::string digest = sessions::inputsDigest(edited());
  nudge(Qt::Key_Right);
  EXPECT_TRUE(wait([&] { return resting(); }));
  EXPECT_EQ(window_.state().currentCase(), before);
  EXPECT_EQ(sessions::inputsDigest(edited()), digest);
  // A run ends in the middle of it: the document changes, the nudged pose stays.
  const auto pose = nudged();
  ASSERT_TRUE(runToTheEnd(1));
  EXPECT_EQ(nudged(), pose);
}

TEST_F(NudgeEditingTest, NudgedPose_IsStoredPerCaseAndRestoredOnOpening) {
  nudge(Qt::Key_Right);
  const auto pose = nudged();
  const std::string other = window_.document().session().cases[1]->id;
  ASSERT_TRUE(shows(other));
  EXPECT_FALSE(nudged());
  ASSERT_TRUE(shows(id_));
  EXPECT_EQ(nudged(), pose);
  ASSERT_TRUE(window_.document().save());
  ASSERT_TRUE(reopen());
  EXPECT_EQ(nudged(), pose);
}

}  // namespace
}  // namespace boresight::ui
