// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/station_snapper.h"

#include <gtest/gtest.h>

#include <QtTest>

#include "tests/support/loaded_example.h"

namespace boresight::ui {
namespace {

class StationSnapperTest : public ::testing::Test {
 protected:
  void takeCase(const ViewState::CasePtr& one) {
    state_.setCase(one);
    ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, 60000));
  }

  ViewState state_;
  StationSnapper snapper_{state_};
};

/// Where a corner of the mesh projects, the corner is the likeliest: the edges that meet there are
/// just as near.
TEST_F(StationSnapperTest, ACornerComesBeforeTheEdgesThatMeetInIt) {
  takeCase(test::loadedExample("bc"));
  const auto& source = state_.currentCase()->source;
  const Pose& pose = *source.camera_from_station_truth;
  int corners = 0;
  for (std::size_t i = 0; i < snapper_.mesh()->edges().size(); i += 41) {
    const Eigen::Vector3d corner = snapper_.mesh()->edges()[i].start_in_station_m;
    Eigen::Vector2d pixel;
    if (!project(source.camera, pose * corner, pixel)) continue;
    const auto snaps = snapper_.near(source.camera, pose, pixel, 3.0);
    const bool seen = !snaps.empty() && snaps[0].kind == sessions::MeshSnapKind::kVertex &&
                      snaps[0].point_in_station_m == corner;
    if (!seen) continue;  // something hides it
    ++corners;
    const auto nearby = snapper_.near(source.camera, pose, pixel + Eigen::Vector2d(0.4, 0.3), 3.0);
    ASSERT_FALSE(nearby.empty());
    EXPECT_NE(nearby[0].kind, sessions::MeshSnapKind::kEdge);
  }
  EXPECT_GT(corners, 5);
}

TEST_F(StationSnapperTest, AnotherCasesMeshIsNotGivenForThisOne) {
  EXPECT_TRUE(snapper_.near(Camera(), Pose(), {0.0, 0.0}, 1e6).empty()) << "there is no case";
  takeCase(test::loadedExample("bc"));
  const auto before = snapper_.mesh();
  state_.setCase(test::loadedExample("os"));
  EXPECT_EQ(snapper_.mesh(), nullptr) << "until it is searched";
  ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, 60000));
  EXPECT_NE(snapper_.mesh()->edges().front(), before->edges().front());
  state_.setCase(nullptr);
  EXPECT_EQ(snapper_.mesh(), nullptr);
}

TEST_F(StationSnapperTest, AnEditOfTheMaskLeavesItAlone) {
  const auto one = test::loadedExample("bc");
  takeCase(one);
  const auto before = snapper_.mesh();
  sessions::SessionCase edited = one->source;
  edited.ignore_strokes.emplace_back();
  edited.ignore_strokes.back().kind = sessions::StrokeKind::kSaturation;
  QSignalSpy changes(&snapper_, &StationSnapper::meshChanged);
  state_.replaceCase(sessions::reloadCase(*one, edited));
  EXPECT_EQ(snapper_.mesh(), before);
  EXPECT_EQ(changes.count(), 0);
}

}  // namespace
}  // namespace boresight::ui
