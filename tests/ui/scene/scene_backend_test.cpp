// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_canvas.h"

#include <gtest/gtest.h>

namespace boresight::ui {
namespace {

TEST(SceneBackend, IsVtkWhereAContextCanBeHad) {
  int asked = 0;
  const auto works = [&asked] {
    ++asked;
    return true;
  };
  EXPECT_EQ(decideSceneBackend(QStringLiteral("xcb"), {}, works), SceneBackend::kVtk);
  EXPECT_EQ(asked, 1);
}

TEST(SceneBackend, IsThePictureWithoutAContext) {
  EXPECT_EQ(decideSceneBackend(QStringLiteral("xcb"), {}, [] { return false; }),
            SceneBackend::kPicture);
}

TEST(SceneBackend, DoesNotAskWhereTheAnswerIsPlain) {
  const auto never = [] {
    ADD_FAILURE() << "asked for a context";
    return true;
  };
  for (const char* platform : {"offscreen", "minimal", "wayland", "vnc", ""})
    EXPECT_EQ(decideSceneBackend(QString::fromUtf8(platform), {}, never), SceneBackend::kPicture);
  EXPECT_EQ(decideSceneBackend(QStringLiteral("xcb"), QStringLiteral("picture"), never),
            SceneBackend::kPicture);
}

TEST(SceneBackend, IsThePictureInThisTest) {
  EXPECT_EQ(sceneBackend(), SceneBackend::kPicture);
  EXPECT_TRUE(sceneIsDrawnInSoftware());
}

}  // namespace
}  // namespace boresight::ui
