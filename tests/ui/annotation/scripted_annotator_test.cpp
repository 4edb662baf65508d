// SPDX-License-Identifier: Apache-2.0
// A careful annotator in the whole window: clicks on the image where corners of the
// station are truly seen, give or take what a hand and an eye miss, and Ctrl+clicks on the drawn
// edges. Run at a screen scaling of one and of one and a half.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <QtTest/QTest>
#include <QtWidgets>

#include "sessions/annotation/annotations_on_image.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/trace/doubtful_pose.h"
#include "tests/support/random_pose.h"
#include "tests/ui/annotation/annotation_fixture.h"
#include "tests/ui/window_test.h"
#include "ui/annotation/annotation_tool.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/station_snapper.h"
#include "ui/views/image_panel.h"
#include "ui/window/window_docks.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/verdict_bar.h"

namespace boresight::ui {
namespace {

namespace fs = std::filesystem;

constexpr double kHand_px = 0.3;  ///< root mean square distance by which a click misses
constexpr double kMargin_px = 12.0;
constexpr std::size_t kCandidates = 400;

/// The examples with a plate over the left of station os.
fs::path halfHiddenExample(const fs::path& folder) {
  fs::copy(test::exampleFolder(), folder / "stations", fs::copy_options::recursive);
  const sessions::GrayImage image = test::halfHiddenImage();
  sessions::writePng(folder / "stations/os/image.png", image.pixels, image.width, image.height, 1);
  return folder / "stations/dataset.json";
}

class ScriptedAnnotator : public test::WindowTest,
                          public testing::WithParamInterface<double>,
                          protected ImagePointer {
 protected:
  ImageView& view() override { return window_.image().view(); }

  void openCase(const fs::path& dataset, const std::string& station) {
    sessions::Session session = sessions::makeSession(dataset);
    session.cases.eraseIf([&](const auto& item) { return item->station != station; });
    ASSERT_FALSE(session.cases.empty());
    session.cases = std::vector{session.cases.front()};
    ASSERT_TRUE(window_.document().create(file_, session));
    tool_ = &window_.findChild<ImageAnnotation*>()->tool();
    snapper_ = window_.findChild<StationSnapper*>();
    ASSERT_TRUE(wait([&] {
      return window_.state().currentCase() && snapper_->mesh() && !window_.tasks().isBusy();
    }));
    window_.annotation().setMode(PlaceMode::kPoint);
  }

  const sessions::SessionCase& source() { return window_.state().currentCase()->source; }
  const Pose& truth() { return *source().camera_from_station_truth; }
  Vector2d pixelOf(const Pose& pose, const Vector3d& point_m) {
    return sessions::predictPlace(source().camera, pose, point_m).pixel;
  }

  /// Under this pose the corner is in the image, seen, and what a click on it snaps to.
  bool isClear(const Pose& pose, const Vector3d& corner_m) {
    const auto place = sessions::predictPlace(source().camera, pose, corner_m);
    const Vector2d size(source().camera.width, source().camera.height);
    if (!place.valid || place.pixel.minCoeff() < kMargin_px ||
        (size - place.pixel).minCoeff() < kMargin_px)
      return false;
    const auto snaps = snapper_->near(source().camera, pose, place.pixel, 2.5);
    return !snaps.empty() && snaps[0].kind == sessions::MeshSnapKind::kVertex &&
           (snaps[0].point_in_station_m - corner_m).norm() < 1e-9;
  }

  /// Corners that can be told both in the image and on the drawn edges, the next one always as far
  /// as can be from those before.
  std::vector<Vector3d> chooseCorners(std::size_t count) {
    const Pose drawn = *tool_->stationPose();
    const auto& edges = snapper_->mesh()->edges();
    const std::size_t step = std::max<std::size_t>(1, edges.size() / kCandidates);
    std::vector<Vector3d> clear_m;
    for (std::size_t i = 0; i < edges.size(); i += step)
      for (const Vector3d& corner_m : {edges[i].start_in_station_m, edges[i].end_in_station_m})
        if (std::ranges::find(clear_m, corner_m) == clear_m.end() && isClear(truth(), corner_m) &&
            pixelOf(truth(), corner_m).x() > hidden_px_ && isClear(drawn, corner_m))
          clear_m.push_back(corner_m);
    std::vector<Vector3d> chosen_m;
    while (chosen_m.size() < std::min(count, clear_m.size())) {
      const auto apart_m = [&](const Vector3d& corner_m) {
        double least_m = 1e9;
        for (const Vector3d& other_m : chosen_m)
          least_m = std::min(least_m, (other_m - corner_m).norm());
        return least_m;
      };
      chosen_m.push_back(*std::ranges::max_element(clear_m, {}, apart_m));
    }
    return chosen_m;
  }

  /// One side after the other, the order changing from pair to pair.
  void annotate(const std::vector<Vector3d>& corners_m) {
    Random random = test::randomFor("ScriptedAnnotator");
    for (std::size_t i = 0; i < corners_m.size(); ++i) {
      for (const bool on_image : {i % 2 == 0, i % 2 != 0}) {
        const Vector2d seen = pixelOf(on_image ? truth() : *tool_->stationPose(), corners_m[i]);
        zoom(seen, GetParam());
        const double x = on_image ? random.normal() : 0.0;
        const double y = on_image ? random.normal() : 0.0;
        click(seen + kHand_px / std::sqrt(2.0) * Vector2d(x, y),
              on_image ? Qt::AltModifier : Qt::ControlModifier);
      }
      ASSERT_TRUE(wait([&] { return !window_.annotation().stale(); }));
      const auto& points = window_.annotation().annotations().points;
      ASSERT_EQ(points.size(), i + 1);
      ASSERT_TRUE(points.back().complete());
      EXPECT_LT((*points.back().point_in_station_m - corners_m[i]).norm(), 1e-9);
    }
  }

  sessions::PoseError error() {
    const Pose solved = window_.annotation().solvedPose().value();
    sessions::PoseError pose_error =
        sessions::poseError(truth(), solved, source().camera_from_end_effector);
    const auto vertices = sessions::matchedVertices(window_.state().currentCase()->scene.view());
    pose_error.projection_px =
        sessions::projectionError(source().camera, truth(), solved, vertices);
    return pose_error;
  }

  /// A photograph of BORESIGHT_DATA is solved to its dataset's tolerance.
  void annotatePhotograph(const std::string& station) {
    const char* data = std::getenv("BORESIGHT_DATA");
    const fs::path dataset = fs::path(data ? data : "") / "real" / "dataset.json";
    if (!data || !fs::is_regular_file(dataset))
      GTEST_SKIP() << "BORESIGHT_DATA names no folder with photographs";
    openCase(dataset, station);
    annotate(chooseCorners(10));
    ASSERT_GE(window_.annotation().annotations().points.size(), 5u);
    const sessions::PoseError off = error();
    ASSERT_TRUE(source().requirement);
    EXPECT_TRUE(meetsRequirement(off, *source().requirement)) << *off.projection_px << " px";
  }

  double hidden_px_ = 0.0;  ///< width of what a plate hides
  AnnotationTool* tool_ = nullptr;
  StationSnapper* snapper_ = nullptr;
};

TEST_P(ScriptedAnnotator, FindsTheTruePoseOfTheBitCarousel) {
  openCase(test::exampleFolder() / "dataset.json", "bc");
  annotate(chooseCorners(10));
  ASSERT_EQ(window_.annotation().annotations().points.size(), 10u);
  const sessions::PoseError off = error();
  EXPECT_LT(std::hypot(off.normal_mm, off.lateral_mm), 0.15);
  EXPECT_LT(1e-3 * off.geodesic_mrad / kDegree_rad, 0.1);
}

/// A plate hides part of the image. The run is rejected; its pose is where annotating begins.
class DoubtfulPoseAnnotator : public ScriptedAnnotator {};

TEST_P(DoubtfulPoseAnnotator, RefinesTheDoubtfulPoseOfAHalfHiddenStation) {
  openCase(halfHiddenExample(folder_.path()), "os");
  window_.annotation().setMode(PlaceMode::kOff);
  window_.workspaces().show(Workspace::kRun);
  ASSERT_TRUE(runToTheEnd(1));
  const auto doubtful = sessions::doubtfulPose(*window_.state().snapshot());
  ASSERT_TRUE(doubtful) << window_.state().snapshot()->probability;
  // A pose that was nudged before must neither cover it nor be picked on.
  window_.state().setNudgedPose(source().camera_from_station_seed);

  VerdictBar& bar = window_.frame().verdict();
  ASSERT_TRUE(wait([&] { return bar.verdict().step == Step::kAnnotateFromPose; }))
      << bar.text().toStdString();
  QTest::mouseClick(&bar.action(), Qt::LeftButton);
  ASSERT_TRUE(wait([&] { return window_.workspaces().current() == Workspace::kAnnotate; }));
  EXPECT_EQ(window_.annotation().mode(), PlaceMode::kPoint);
  EXPECT_EQ(tool_->stationPose(), doubtful->camera_from_station);
  ASSERT_TRUE(wait([&] { return !view().layer(LayerId::kIterationEdges).empty() && resting(); }));
  EXPECT_TRUE(view().layer(LayerId::kIterationEdges).isShown());
  EXPECT_TRUE(test::has(view().layer(LayerId::kIterationEdges).name, "Doubtful pose, "));

  hidden_px_ = test::kHidden_px + kMargin_px;
  annotate(chooseCorners(5));
  ASSERT_EQ(window_.annotation().annotations().points.size(), 5u);
  const sessions::PoseError off = error();
  EXPECT_LT(std::hypot(off.normal_mm, off.lateral_mm), 1.0);
  EXPECT_LT(1e-3 * off.geodesic_mrad / kDegree_rad, 0.5);
  const auto& run = *window_.state().snapshot();
  EXPECT_FALSE(run.converged()) << "it is never accepted";
  EXPECT_EQ(run.camera_from_station, run.camera_from_station_seed);
}

TEST_P(ScriptedAnnotator, FindsThePoseOfABoxOnAPhotograph) { annotatePhotograph("visp_teabox"); }

TEST_P(ScriptedAnnotator, FindsThePoseOfAMachinedPartOnAPhotograph) {
  annotatePhotograph("metal_obj18");
}
INSTANTIATE_TEST_SUITE_P(Zooms, ScriptedAnnotator, testing::Values(3.0, 12.0));
INSTANTIATE_TEST_SUITE_P(Zoom, DoubtfulPoseAnnotator, testing::Values(3.0));

}  // namespace
}  // namespace boresight::ui
