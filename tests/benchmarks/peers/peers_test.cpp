// SPDX-License-Identifier: Apache-2.0
// The program as a whole, on the example that ships. A peer whose package is not there is skipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <stdexcept>

#include "sessions/evaluation/results_file.h"
#include "tests/app/run_whs.h"
#include "tests/benchmarks/peers/guarded_run.h"
#include "tests/benchmarks/peers/wire_model.h"

namespace boresight::peers {
namespace {

using test::Arguments;
using test::ProgramRun;
using testing::HasSubstr;

ProgramRun runPeers(const Arguments& arguments) {
  return test::runProgram(BORESIGHT_PEERS, arguments);
}

bool isBuilt(const std::string& peer) {
  return runPeers({"list"}).out.find("\n" + peer + "  (") != std::string::npos;
}

/// One run of the example's orbiting sample, its seed at the truth.
std::string resultsFromTruth(const test::TemporaryFolder& folder, const std::string& method) {
  const std::string file = (folder / "results.sqlite").string();
  const ProgramRun run =
      runPeers({"run", "--dataset", (test::exampleFolder() / "dataset.json").string(), "--station",
                "os", "--out", file, "--method", method, "--reseed", "1", "--first-seed", "1",
                "--reseed-scale", "0", "--limit", "300"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return file;
}

sessions::RunResult onlyRun(const std::string& file) {
  const std::vector<sessions::RunResult> runs = sessions::readResults(file).runs;
  if (runs.size() != 1) throw std::runtime_error("not one run");
  return runs.front();
}

class PeersNearTruth : public testing::TestWithParam<const char*> {};

TEST_P(PeersNearTruth, SeedAtTheTruthStaysNearIt) {
  if (!isBuilt(GetParam())) GTEST_SKIP() << GetParam() << ": its package is not there";
  const test::TemporaryFolder folder;
  const sessions::RunResult run = onlyRun(resultsFromTruth(folder, GetParam()));
  EXPECT_EQ(run.method, GetParam());
  EXPECT_TRUE(run.completed) << run.status << ": " << run.message;
  ASSERT_TRUE(run.error && run.error->projection_px);
  EXPECT_LT(*run.error->projection_px, 5.0);
  EXPECT_NEAR(*run.seed_error->projection_px, 0.0, 1e-6);
  EXPECT_GT(run.seconds.total(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, PeersNearTruth, testing::Values("visp-edge", "rapid"));

TEST(Peers, WhsRunsBesideThemAndTheTableHasItsRow) {
  const test::TemporaryFolder folder;
  const std::string file = resultsFromTruth(folder, "whs");
  EXPECT_TRUE(onlyRun(file).success.value_or(false));
  const ProgramRun table = runPeers({"table", file});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("| cases | method | runs |"));
  EXPECT_THAT(table.out, HasSubstr("| os | whs | 1 | 1 | 1 | 0 | "));
}

TEST(Peers, MethodsAndSettingsThatDoNotExistAreRefused) {
  const test::TemporaryFolder folder;
  const Arguments common = {"run", "--dataset", (test::exampleFolder() / "dataset.json").string(),
                            "--out", (folder / "results.sqlite").string()};
  Arguments method = common;
  method.insert(method.end(), {"--method", "nobody"});
  EXPECT_EQ(runPeers(method).exit_code, 2);
  Arguments setting = common;
  setting.insert(setting.end(), {"--set", "nobody.range=1"});
  EXPECT_EQ(runPeers(setting).exit_code, 2);
}

TEST(GuardedRun, AnExceptionACrashAndAHangCostTheAnswerAlone) {
  EXPECT_EQ(runGuarded([] { return std::string("42"); }, 10.0).answer, "42");
  const GuardedAnswer thrown =
      runGuarded([]() -> std::string { throw std::runtime_error("no such edge"); }, 10.0);
  EXPECT_FALSE(thrown.answer);
  EXPECT_EQ(thrown.loss, "no such edge");
  const GuardedAnswer crashed = runGuarded([]() -> std::string { std::abort(); }, 10.0);
  EXPECT_FALSE(crashed.answer);
  EXPECT_THAT(crashed.loss, HasSubstr("signal"));
  const GuardedAnswer hung = runGuarded(
      []() -> std::string {
        for (;;) ::getpid();
      },
      1.0);
  EXPECT_FALSE(hung.answer);
  EXPECT_EQ(hung.loss, "took more than 1 s");
}

/// A cube of side 1 about the origin, two triangles a side.
sessions::SceneMesh cube() {
  sessions::SceneMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_in_station_m.emplace_back(i & 1 ? 0.5F : -0.5F, i & 2 ? 0.5F : -0.5F,
                                            i & 4 ? 0.5F : -0.5F);
  for (const std::array<int, 4>& side :
       {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
        std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    mesh.faces.push_back({{side[0], side[1], side[2]}});
    mesh.faces.push_back({{side[0], side[2], side[3]}});
  }
  mesh.part_of_face.assign(mesh.faces.size(), 0);
  mesh.parts.resize(1);
  return mesh;
}

TEST(WireModel, HasTheSidesOfACubeAndNoDiagonal) {
  Pose camera_from_station;
  camera_from_station.rotation = rotationExp({0.5, 0.4, 0.0});
  camera_from_station.translation_m = {0.0, 0.0, 5.0};
  const WireModel model = wireModel(cube(), camera_from_station, 30.0);
  EXPECT_EQ(model.faces.size(), 6u);  // of the three sides that are seen
  EXPECT_EQ(model.lines.size(), 9u);
  for (const auto& line : model.lines)
    EXPECT_NEAR((model.points_m[static_cast<std::size_t>(line[0])] -
                 model.points_m[static_cast<std::size_t>(line[1])])
                    .norm(),
                1.0, 1e-6);
}

TEST(WireModel, OfWhatIsNotCreasedHasTheOutlineAlone) {
  Pose camera_from_station;
  camera_from_station.translation_m = {0.0, 0.0, 5.0};
  // Nothing is sharper than 100 deg: what remains is the outline of the side that is seen.
  EXPECT_EQ(wireModel(cube(), camera_from_station, 100.0).lines.size(), 4u);
}

}  // namespace
}  // namespace boresight::peers
