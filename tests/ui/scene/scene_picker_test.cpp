// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_aim.h"

#include <gtest/gtest.h>

#include "tests/support/random_pose.h"

namespace boresight::ui {
namespace {

/// Two squares behind each other, seen from straight ahead: the near one is smaller.
struct Stack {
  SceneContent content;
  Viewpoint view;

  Stack() {
    auto one = std::make_shared<sessions::LoadedCase>();
    for (const float z : {0.0F, 0.1F}) {
      const auto first = static_cast<std::int32_t>(one->scene.vertices_in_station_m.size());
      const float half = z == 0.0F ? 0.05F : 0.1F;
      for (const auto& [x, y] :
           {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}})
        one->scene.vertices_in_station_m.emplace_back(x, y, z);
      one->scene.faces.push_back({{first, first + 1, first + 2}});
      one->scene.faces.push_back({{first, first + 2, first + 3}});
    }
    one->scene.part_of_face.assign(4, 0);
    one->scene.parts.resize(1);
    content.one = one;
    content.bounds.minimum_m = {-0.1, -0.1, 0.0};
    content.bounds.maximum_m = {0.1, 0.1, 0.1};
    view.view_from_station.translation_m = {0.0, 0.0, 0.5};
    view.camera = test::makePinhole(400, 400, 500.0);
  }

  void addTemplate(const Eigen::Vector3d& at_m) {
    ScenePoint point;
    point.at_m = at_m;
    point.template_index = static_cast<int>(content.points.size());
    content.points.push_back(point);
  }
  QPointF at(const Eigen::Vector3d& at_m) const { return view.toCanvas(at_m).value(); }
};

TEST(PickTemplate, TakesTheNearestWithinReach) {
  Stack stack;
  stack.addTemplate({0.01, 0.0, 0.0});
  stack.addTemplate({0.02, 0.0, 0.0});
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.012, 0.0, 0.0})), 0);
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.018, 0.0, 0.0})), 1);
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.0, 0.03, 0.0})), -1);
}

TEST(PickTemplate, SeesNoneBehindAFace) {
  Stack stack;
  stack.addTemplate({0.0, 0.0, 0.1});   // behind the near square
  stack.addTemplate({0.09, 0.0, 0.1});  // beside it
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.0, 0.0, 0.1})), -1);
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.09, 0.0, 0.1})), 1);
}

TEST(PickTemplate, LeavesOutPlacesThatAreNoTemplates) {
  Stack stack;
  stack.addTemplate({0.0, 0.0, 0.0});
  stack.content.points[0].template_index = -1;
  EXPECT_EQ(pickTemplate(stack.content, stack.view, stack.at({0.0, 0.0, 0.0})), -1);
}

}  // namespace
}  // namespace boresight::ui
