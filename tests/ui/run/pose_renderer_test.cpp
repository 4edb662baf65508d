// SPDX-License-Identifier: Apache-2.0
#include "ui/run/pose_renderer.h"

#include <gtest/gtest.h>
#include <QTest>

#include <vector>

#include "core/base/math.h"
#include "sessions/trace/scene_render.h"
#include "tests/support/loaded_example.h"

namespace boresight::ui {
namespace {

/// A renderer of the example's first station, and what comes out of it.
struct Drawn {
  PoseRenderer renderer;
  std::shared_ptr<const sessions::LoadedCase> one = test::loadedExample("bc");
  std::vector<std::pair<PoseRenderer::RenderPtr, int>> renders;
  QStringList failures;

  Drawn() {
    renderer.setCase(one);
    QObject::connect(&renderer, &PoseRenderer::rendered, [this](const auto& render, int level) {
      renders.emplace_back(render, level);
    });
    QObject::connect(&renderer, &PoseRenderer::failed,
                     [this](const QString& message) { failures.append(message); });
  }

  /// The seed, moved along the camera's axis.
  Pose pose(double forward_m) const {
    Pose moved = one->source.camera_from_station_seed;
    moved.translation_m.z() += forward_m;
    return moved;
  }
  bool fullArrives() {
    return QTest::qWaitFor([this] { return !renders.empty() && renders.back().second == 0; },
                           20000);
  }
  /// All that arrived is what the core draws of this pose.
  void expectRenders(const Pose& camera_from_station) const {
    for (const auto& [render, level] : renders) {
      sessions::RenderTrace expected;
      ASSERT_EQ(sessions::renderScene(cameraAtLevel(one->source.camera, level), one->scene.view(),
                                      camera_from_station, expected),
                Status::kOk);
      EXPECT_EQ(render->edges.words, expected.edges.words);
      EXPECT_EQ(render->edges.width, one->source.camera.width >> level);
    }
  }
};

TEST(PoseRenderer, DrawsWhatTheCoreDrawsOnceThePoseRests) {
  Drawn drawn;
  drawn.renderer.setPose(drawn.pose(0.01));
  ASSERT_TRUE(drawn.fullArrives());
  drawn.expectRenders(drawn.pose(0.01));
}

TEST(PoseRenderer, LeavesOutPosesThatANewerOneOvertakes) {
  Drawn drawn;
  for (int i = 1; i <= 50; ++i) drawn.renderer.setPose(drawn.pose(1e-3 * i));  // no event between
  ASSERT_TRUE(drawn.fullArrives());
  EXPECT_LT(drawn.renders.size(), 50u);
  double last_m = 0.0;
  for (const auto& [render, level] : drawn.renders) {
    EXPECT_GE(render->camera_from_station.translation_m.z(), last_m);
    last_m = render->camera_from_station.translation_m.z();
  }
  EXPECT_EQ(drawn.renders.back().first->camera_from_station.translation_m,
            drawn.pose(0.05).translation_m);
}

TEST(PoseRenderer, OutdatedRequestsAndThoseWithoutACase_AreDropped) {
  PoseRenderer without_case;
  without_case.setPose(Pose());
  Drawn drawn;
  drawn.renderer.setPose(drawn.pose(0.0));
  drawn.renderer.clear();
  QTest::qWait(3 * PoseRenderer::kRest_ms);
  EXPECT_TRUE(drawn.renders.empty());
}

TEST(PoseRenderer, DrawsTheNewCaseAfterTheOldOneIsGone) {
  Drawn drawn;
  drawn.renderer.setPose(drawn.pose(0.0));
  drawn.one = test::loadedExample("os");
  drawn.renderer.setCase(drawn.one);
  drawn.renderer.setPose(drawn.pose(0.0));
  ASSERT_TRUE(drawn.fullArrives());
  drawn.renders.erase(drawn.renders.begin(), drawn.renders.end() - 1);
  drawn.expectRenders(drawn.pose(0.0));
}

TEST(PoseRenderer, SaysWhyAPoseCannotBeDrawn) {
  Drawn drawn;
  Pose broken = drawn.pose(0.0);
  broken.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  drawn.renderer.setPose(broken);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !drawn.failures.empty(); }, 20000));
  EXPECT_TRUE(drawn.failures.front().contains(QStringLiteral("cannot be drawn")));
}

}  // namespace
}  // namespace boresight::ui
