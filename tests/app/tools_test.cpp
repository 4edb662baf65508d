// SPDX-License-Identifier: Apache-2.0
// render, solve, info, options, --help and --version.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/points_file.h"
#include "sessions/trace/scene_render.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::filesystem::path kExample = exampleFolder() / "os";

TEST(Whs, ExplainsItself) {
  const ProgramRun help = runWhs({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"localize", "evaluate", "solve", "render", "info", "options",
                              "problem", "new", "run", "pack"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    EXPECT_EQ(runWhs({command, "--help"}).exit_code, 0) << command;
    EXPECT_THAT(runWhs({command, "--version"}).out, HasSubstr("whs ")) << command;
  }
  EXPECT_EQ(runWhs({"--version"}).exit_code, 0);
}

TEST(WhsOptions, ListsEveryOptionWithRangeAndMeaning) {
  const std::string out = runWhs({"options"}).out;
  const LocalizerOptions options;
  LocalizerOptions::visitFields(options, [&out](const OptionInfo& info, const auto&) {
    EXPECT_THAT(out, AllOf(HasSubstr(info.name), HasSubstr(info.help)));
  });
  EXPECT_NE(runWhs({"options", "--profile", "paper"}).out, out);
}

TEST(WhsRender, DrawsWhatTheCoreRenders) {
  const TemporaryFolder folder;
  const ProgramRun run =
      runWhs({"render", "--camera", kExample / "camera.json", "--mesh", kExample / "model.ply",
              "--mesh-unit", "m", "--pose", kExample / "truth.json", "--out", folder / "e.png"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ExampleCase example("os");
  sessions::RenderTrace render;
  ASSERT_EQ(sessions::renderScene(example.camera, example.scene.view(),
                                  example.truth.camera_from_station, render),
            Status::kOk);
  const sessions::GrayImage drawn = sessions::readImage(folder / "e.png");
  std::size_t white = 0;
  for (const std::uint8_t pixel : drawn.pixels) white += pixel == 255 ? 1u : 0u;
  EXPECT_EQ(white, render.pixels.size());
  for (const EdgePixel& pixel : render.pixels) ASSERT_EQ(drawn.view().at(pixel.x, pixel.y), 255);
}

/// Points of the example's mesh where the true pose projects them.
std::vector<sessions::PointPair> truePoints(std::size_t count) {
  const ExampleCase example("os");
  std::vector<sessions::PointPair> points;
  const auto& vertices = example.scene.vertices_in_station_m;
  for (std::size_t i = 0; i < vertices.size() && points.size() < count; i += 97) {
    sessions::PointPair point;
    point.id = "p" + std::to_string(i);
    point.point_in_station_m = vertices[i].cast<double>();
    if (project(example.camera, example.truth.camera_from_station * point.point_in_station_m,
                point.pixel))
      points.push_back(point);
  }
  return points;
}

TEST(WhsSolve, FindsThePoseDespiteAMistakenPoint) {
  const TemporaryFolder folder;
  auto points = truePoints(10);
  points[3].pixel += Eigen::Vector2d(120.0, -80.0);
  sessions::writePoints(folder / "points.json", points);
  const ProgramRun run = runWhs({"solve", "--points", folder / "points.json", "--camera",
                                 kExample / "camera.json", "--out", folder / "pose.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("9 of 10 points used"), HasSubstr("144.22")));
  const Vector6d error =
      perturbationBetween(ExampleCase("os").truth.camera_from_station,
                          sessions::readPose(folder / "pose.json").camera_from_station);
  EXPECT_LT(error.norm(), 1e-6);
}

TEST(WhsSolve, LeavesOutDisabledPointsAndAsksForFour) {
  const TemporaryFolder folder;
  auto points = truePoints(5);
  points[0].enabled = false;
  points[1].enabled = false;
  sessions::writePoints(folder / "points.json", points);
  const ProgramRun run =
      runWhs({"solve", "--points", folder / "points.json", "--camera", kExample / "camera.json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, AllOf(HasSubstr("points.json: points: 3 enabled"), HasSubstr("at least 4")));
}

TEST(WhsSolve, SaysWhenNoPoseAgrees) {
  const TemporaryFolder folder;
  auto points = truePoints(6);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].pixel = points[0].pixel;
  sessions::writePoints(folder / "points.json", points);
  const ProgramRun run = runWhs({"solve", "--points", folder / "points.json", "--camera",
                                 kExample / "camera.json", "--threshold", "0.5"});
  EXPECT_EQ(run.exit_code, 4) << run.out;
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

TEST(WhsInfo, DescribesEveryKindOfFile) {
  const ProgramRun run =
      runWhs({"info", kExample / "image.png", kExample / "camera.json", kExample / "model.ply",
              kExample / "seed.json", exampleFolder() / "dataset.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("PNG, 1024 x 1024 px"), HasSubstr("brown_conrady"),
                    HasSubstr("field of view"), HasSubstr("faces"), HasSubstr("does not state"),
                    HasSubstr("uncertainty"), HasSubstr("2 cases, 2 stations")));
}

TEST(WhsInfo, GoesOnAfterABadFile) {
  const ProgramRun run = runWhs({"info", "/no/such/file.png", kExample / "camera.json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("/no/such/file.png"));
  EXPECT_THAT(run.out, HasSubstr("brown_conrady"));
}

}  // namespace
}  // namespace boresight::test
