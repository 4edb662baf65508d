// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/frames_panel.h"

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "ui/state/view_state.h"

namespace boresight::ui {
namespace {

/// Of the end effector in another frame.
sessions::FrameTransform transformTo(const sessions::FrameName& target, double z_m) {
  sessions::FrameTransform transform;
  transform.target = target;
  transform.source = sessions::kEndEffectorFrame;
  transform.target_from_source.translation_m = {0.0, 0.0, z_m};
  transform.origin = sessions::TransformSource::kTelemetry;
  transform.comment = "sol 12";
  return transform;
}

class FramesPanelTest : public testing::Test {
 protected:
  FramesPanelTest() {
    auto loaded = std::make_shared<sessions::LoadedCase>();
    sessions::FrameTransform hand_eye = transformTo(sessions::kCameraFrame, 0.39);
    hand_eye.covariance = 1e-6 * Matrix6d::Identity();
    loaded->source.frames = {hand_eye, transformTo({"ARM_BASE", {}}, 1.0)};
    loaded->source.camera_reference.emplace().frame = {"ROVER", {}};
    state_.setCase(loaded);
    panel_.show();
  }
  QTreeWidget& tree() { return *panel_.findChild<QTreeWidget*>(QStringLiteral("frames")); }

  ViewState state_;
  FramesPanel panel_{state_};
  QPushButton& remove_ = *panel_.findChild<QPushButton*>(QStringLiteral("removeFrame"));
};

TEST_F(FramesPanelTest, ShowsTheTreeWithPlacesAndSigmas_NarrowItHidesColumns) {
  ASSERT_EQ(tree().topLevelItemCount(), 1);
  const QTreeWidgetItem* camera = tree().topLevelItem(0);
  EXPECT_EQ(camera->text(0), QStringLiteral("CAMERA"));
  ASSERT_EQ(camera->childCount(), 2) << "the camera model's frame and the end effector";
  const QTreeWidgetItem* end_effector = camera->child(1);
  EXPECT_EQ(end_effector->text(0), QStringLiteral("END_EFFECTOR"));
  EXPECT_TRUE(end_effector->text(1).endsWith(QStringLiteral("390.0")));
  EXPECT_EQ(end_effector->text(2), QStringLiteral("1.00"));
  EXPECT_EQ(end_effector->text(4), QStringLiteral("telemetry"));
  ASSERT_EQ(end_effector->childCount(), 1);
  EXPECT_EQ(end_effector->child(0)->text(2), QStringLiteral("exact"));
  panel_.resize(1200, 300);
  QCoreApplication::processEvents();
  EXPECT_FALSE(tree().isColumnHidden(5));
  panel_.resize(380, 300);
  QCoreApplication::processEvents();
  EXPECT_TRUE(tree().isColumnHidden(5)) << "the comment";
  EXPECT_FALSE(tree().isColumnHidden(1)) << "the place";
  EXPECT_EQ(tree().horizontalScrollBar()->maximum(), 0);
}

TEST_F(FramesPanelTest, RemovesWhatIsTheCasesOwn) {
  QList<sessions::FrameTransform> removed;
  QObject::connect(&panel_, &FramesPanel::removeRequested,
                   [&](const sessions::FrameTransform& transform) { removed << transform; });
  EXPECT_FALSE(remove_.isEnabled());
  tree().setCurrentItem(tree().topLevelItem(0)->child(0));
  EXPECT_FALSE(remove_.isEnabled()) << "of the camera model";
  tree().setCurrentItem(tree().topLevelItem(0)->child(1));
  ASSERT_TRUE(remove_.isEnabled());
  remove_.click();
  ASSERT_EQ(removed.size(), 1);
  EXPECT_EQ(removed[0].source, sessions::kEndEffectorFrame);
  state_.setCase(nullptr);
  EXPECT_EQ(tree().topLevelItemCount(), 0);
  EXPECT_FALSE(panel_.findChild<QPushButton*>(QStringLiteral("addFrames"))->isEnabled());
}

}  // namespace
}  // namespace boresight::ui
