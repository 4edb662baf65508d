// SPDX-License-Identifier: Apache-2.0
// No output of whs replaces a file that the command reads, whichever option names it and whichever
// of its names is given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Overwrite : public testing::Test {
 protected:
  Overwrite() { fs::copy(exampleFolder(), folder_ / "stations", fs::copy_options::recursive); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  /// localize with its inputs in the folder, and one output.
  Arguments localizing(const std::string& option, const std::string& output) const {
    return localizeArguments({{"--image", file("stations/os/image.png")},
                              {"--camera", file("stations/os/camera.json")},
                              {"--mesh", file("stations/os/model.ply")},
                              {"--seed", file("stations/os/seed.json")},
                              {option, output}});
  }
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
      if (entry.is_regular_file())
        all[entry.path().string()] = folder_.read(fs::relative(entry.path(), folder_.path()));
    return all;
  }
  /// One line on stderr with all `words`, the exit status of a bad file, and every file as it was.
  void expectRefused(const Arguments& arguments, const std::vector<std::string>& words) const {
    const auto before = contents();
    const ProgramRun run = runWhs(arguments);
    EXPECT_EQ(run.exit_code, 3) << arguments[0] << run.err;
    EXPECT_EQ(run.errorLines(), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("which would be lost; name another file"));
    for (const std::string& word : words) EXPECT_THAT(run.err, HasSubstr(word)) << arguments[0];
    EXPECT_TRUE(contents() == before) << arguments[0] << " changed a file";
  }
  std::string newSession() const {
    const std::string session = file("s.boresight.json");
    EXPECT_EQ(
        runWhs({"new", "--dataset", file("stations/dataset.json"), "--out", session}).exit_code, 0);
    return session;
  }

  const TemporaryFolder folder_;
};

TEST_F(Overwrite, OfInputsByLocalizeIsRefusedWithBothOptions) {
  const std::string image = file("stations/os/image.png");
  expectRefused(localizing("--overlay", image), {"--image and --overlay: ", image});
  expectRefused(localizing("--out", file("stations/os/seed.json")),
                {"--out", "--seed", "seed.json"});
  expectRefused(localizing("--trace", file("stations/os/camera.json")), {"--trace", "--camera"});
  expectRefused(localizing("--record", file("stations/os/model.ply")), {"--record", "--mesh"});
}

TEST_F(Overwrite, ByAnotherNameOfAnInputIsRefused) {
  fs::create_symlink(file("stations/os/image.png"), folder_ / "symbolic.png");
  fs::create_hard_link(file("stations/os/image.png"), folder_ / "hard.png");
  fs::create_directory_symlink(file("stations/os"), folder_ / "folder");
  for (const char* name :
       {"symbolic.png", "hard.png", "folder/image.png", "stations/../stations/os/image.png"})
    expectRefused(localizing("--overlay", file(name)), {"--image and --overlay"});
}

TEST_F(Overwrite, OfInputsByOtherCommandsIsRefused) {
  const std::string camera = file("stations/os/camera.json"), mesh = file("stations/os/model.ply");
  const std::string seed = file("stations/os/seed.json"), dataset = file("stations/dataset.json");
  expectRefused({"camera", camera, "--as", "pinhole", "--out", camera}, {"file and --out"});
  expectRefused({"render", "--camera", camera, "--mesh", mesh, "--mesh-unit", "m", "--pose", seed,
                 "--out", seed},
                {"--pose", "--out"});
  Arguments problem = localizing("", "");
  problem[0] = "problem";
  problem.insert(problem.end(), {"--out", file("p.bin"), "--image-out", mesh});
  expectRefused(problem, {"--image-out", "--mesh"});
  expectRefused({"evaluate", "--dataset", dataset, "--out", file("r.sqlite"), "--jsonl", dataset},
                {"--dataset", "--jsonl"});
  expectRefused({"evaluate", "--dataset", dataset, "--out", file("r.sqlite"), "--jsonl", mesh},
                {"--jsonl: ", "model.ply"});
  expectRefused({"views", "--dataset", dataset, "--out", dataset}, {"--dataset", "--out"});
}

TEST_F(Overwrite, OfMarksBySolveIsRefused) {
  const std::string points = file("points.json"), camera = file("stations/os/camera.json");
  folder_.write("points.json",
                R"({"format": "boresight-points", "version": 1, "points": [
  {"id": "a", "point_in_station_m": [0, 0, 0], "pixel": [500, 500]},
  {"id": "b", "point_in_station_m": [0.1, 0, 0], "pixel": [700, 500]},
  {"id": "c", "point_in_station_m": [0, 0.1, 0], "pixel": [500, 700]},
  {"id": "d", "point_in_station_m": [0.1, 0.1, 0.02], "pixel": [710, 690]}]})");
  expectRefused({"solve", "--points", points, "--camera", camera, "--out", points},
                {"--points", "--out"});
  expectRefused({"solve", "--points", points, "--camera", camera, "--json", camera},
                {"--camera", "--json"});
}

TEST_F(Overwrite, OfASessionAndItsInputsIsRefused) {
  const std::string session = newSession(), mesh = file("stations/os/model.ply");
  const std::string image = file("stations/os/image.png");
  ASSERT_EQ(runWhs({"run", session, "--case", "os-000038"}).exit_code, 0);
  for (const std::string& input : {session, mesh, image}) {
    expectRefused({"queue", session, "--csv", input}, {"--csv", input});
    expectRefused({"check", session, "--case", "os-000038", "--json", input}, {"--json", input});
    expectRefused({"report", session, "--case", "os-000038", "--out", input}, {"--out", input});
    expectRefused({"export", session, "--case", "os-000038", "--pose", input}, {"--pose", input});
    expectRefused({"pack", session, "--out", input}, {"--out", input});
  }
  expectRefused({"queue", session, "--csv", session}, {"session and --csv"});
}

TEST_F(Overwrite, OfMarksAndRunsOfASessionIsRefused) {
  fs::copy(exampleFolder().parent_path() / "annotated.boresight.json", folder_.path());
  const std::string session = file("annotated.boresight.json");
  expectRefused({"export", session, "--case", "bc-000028", "--points", session}, {"--points"});
  expectRefused(
      {"export", session, "--case", "bc-000028", "--points", file("stations/os/model.ply")},
      {"--points", "model.ply"});
}

TEST_F(Overwrite, OfResultsByTablesIsRefused) {
  const std::string results = file("r.sqlite");
  ASSERT_EQ(runWhs({"evaluate", "--dataset", file("stations/dataset.json"), "--out", results,
                    "--set", "loop.max_iterations=1"})
                .exit_code,
            0);
  expectRefused({"tables", results, "--out", results}, {"RESULTS and --out"});
}

TEST_F(Overwrite, OfWhatACommandKeepsUpToDateGoesOn) {
  const std::string session = newSession(), results = file("r.sqlite");
  EXPECT_EQ(runWhs({"run", session, "--case", "os-000038"}).exit_code, 0);
  EXPECT_EQ(runWhs({"run", session, "--case", "os-000038"}).exit_code, 0) << "the same run again";
  const Arguments evaluate = {
      "evaluate", "--dataset", file("stations/dataset.json"), "--station", "os", "--out", results};
  EXPECT_EQ(runWhs(evaluate).exit_code, 0);
  EXPECT_EQ(runWhs(evaluate).exit_code, 0);
  EXPECT_EQ(runWhs({"merge", results, results}).exit_code, 0);
  EXPECT_EQ(runWhs(localizing("--out", file("result.json"))).exit_code, 0);
  EXPECT_EQ(runWhs(localizing("--out", file("result.json"))).exit_code, 0) << "an older output";
}

}  // namespace
}  // namespace boresight::test
