// SPDX-License-Identifier: Apache-2.0
// Everything that can be wrong with what whs localize is given: one line on stderr that names file,
// field and reason, the exit status, and nothing written.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/app/run_whs.h"
#include "tests/support/approach_files.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using nlohmann::json;

class BadInput : public testing::Test {
 protected:
  /// Runs localize with some options replaced and all outputs asked for.
  ProgramRun run(std::map<std::string, std::string> replaced) const {
    replaced.emplace("--out", outputs_ / "result.json");
    replaced.emplace("--trace", outputs_ / "trace");
    replaced.emplace("--overlay", outputs_ / "overlay.png");
    return runWhs(localizeArguments(replaced));
  }

  void expectRefused(const std::map<std::string, std::string>& replaced,
                     const std::string& file_and_field, const std::string& reason) const {
    const ProgramRun refused = run(replaced);
    EXPECT_EQ(refused.exit_code, 3) << refused.err;
    EXPECT_EQ(refused.errorLines(), 1) << refused.err;
    EXPECT_THAT(refused.err, AllOf(HasSubstr(file_and_field), HasSubstr(reason)));
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(outputs_.fileCount(), 0u);
  }

  /// The example's seed with its matrix replaced.
  std::string seedWith(const std::string& matrix) const {
    return inputs_
        .write(
            "seed.json",
            R"({"format": "boresight-pose", "version": 1, "camera_from_station": )" + matrix + "}")
        .string();
  }

  const std::filesystem::path example_ = exampleFolder() / "os";
  const TemporaryFolder inputs_;
  const TemporaryFolder outputs_;
};

/// Of a pipe without a writer reading would block for ever.
TEST_F(BadInput, NamesAFileThatIsMissingAPipeOrADevice) {
  const std::string pipe = inputs_ / "pipe.ply";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const char* option :
       {"--image", "--camera", "--mesh", "--seed", "--config", "--ignore", "--truth"}) {
    expectRefused({{option, "/no/such/file.ply"}}, "/no/such/file.ply: ", "");
    expectRefused({{option, pipe}}, "pipe.ply: ", "is a pipe, a socket or a device");
  }
  expectRefused({{"--image", "/dev/zero"}}, "/dev/zero: ", "is a pipe, a socket or a device");
}

/// What else the readers refuse of these files is tested with them.
TEST_F(BadInput, NamesFileAndFieldOfWhatDoesNotFit) {
  const auto cameraWith = [this](const std::string& member, const json& value) {
    json camera = json::parse(std::ifstream(example_ / "camera.json"));
    camera[member] = value;
    return inputs_.write(member + "_camera.json", camera.dump()).string();
  };
  const struct {
    const char* option;
    std::string value;
    const char* file_and_field;
    const char* reason;
  } rows[] = {
      {"--seed", example_ / "camera.json", "camera.json: format", "boresight-pose"},
      {"--camera", cameraWith("width", 2048), "image.png", "2048"},
      // Beyond the fold no pixel has a ray: the run could only search in vain.
      {"--camera", cameraWith("dist", {-5.0, 0.0, 0.0, 0.0, 0.0}), "dist_camera.json: distortion",
       "folds back"},
      {"--mesh-unit", "", "model.ply", "unit"},
      {"--mesh-unit", "mm", "model.ply: mesh_unit", "check the unit"},
      {"--mesh-unit", "km", "model.ply: mesh_unit", "check the unit"},
      {"--out", "/no/such/folder/result.json", "/no/such/folder/result.json", ""},
      {"--overlay", "/no/such/folder/o.png", "/no/such/folder/o.png", ""},
      {"--trace", "/no/such/folder/t", "/no/such/folder/t", ""},
  };
  for (const auto& row : rows)
    expectRefused({{row.option, row.value}}, row.file_and_field, row.reason);
  expectRefused({{"--seed", seedWith("[[1,0,0,0],[0,1,0,0],[0,0,-1,0.4],[0,0,0,1]]")}},
                "seed.json: camera_from_station", "mirror");
  expectRefused({{"--seed", seedWith("[[1,0,0,0],[0,1,0,0],[0,0,1,-0.6],[0,0,0,1]]")}},
                "seed.json: camera_from_station", "behind the camera");
}

/// Each face hides the next: a run would take as long as the image has pixels times faces.
TEST_F(BadInput, RefusesAMeshOfManyFacesBehindEachOther) {
  Solid layers;
  for (int i = 0; i < 2000; ++i) {
    const float z = 1e-4F * static_cast<float>(i);
    for (const auto& [x, y] : {std::pair(-9.0F, -9.0F), {9.0F, -9.0F}, {0.0F, 18.0F}})
      layers.vertices.emplace_back(x, y, z);
    layers.faces.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
  }
  const ProgramRun refused =
      run({{"--mesh", inputs_.write("layers.ply", plyOf(layers)).string()},
           {"--seed", seedWith("[[1,0,0,0],[0,-1,0,0],[0,0,-1,1.0],[0,0,0,1]]")}});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("layers.ply"), HasSubstr("overlap in an image row")));
}

TEST_F(BadInput, NamesAnOptionWhoseNumberIsNotFiniteOrOutOfRange) {
  const std::string record = example_ / "none.whsr";
  const auto expectUsage = [](const Arguments& arguments, const std::string& option,
                              const std::string& value) {
    const ProgramRun refused = runWhs(arguments, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr(option), HasSubstr(value)));
    EXPECT_EQ(refused.out, "");
  };
  // One check reads these numbers: each option once, with one of the values in turn.
  for (const std::string value : {"nan", "1e999", "-1"})
    expectUsage(localizeArguments({{"--feature-size", value}}), "--feature-size", value);
  expectUsage(with(localizeArguments(), {"--uncertainty", "nan", "0.01", "0.01", "1", "1", "1"}),
              "--uncertainty", "nan");
  expectUsage({"new", "--image", "i.png", "--mesh-scale-sigma", "-1", "--out", "s.json"},
              "--mesh-scale-sigma", "-1");
  expectUsage({"camera", example_ / "camera.json", "--as", "pinhole", "--distance", "1e999"},
              "--distance", "1e999");
  expectUsage({"evaluate", "--dataset", exampleDataset(), "--out", outputs_ / "r.sqlite",
               "--reseed-scale", "nan"},
              "--reseed-scale", "nan");
  expectUsage({"compare", record, record, "--found-px", "-1"}, "--found-px", "-1");
  expectUsage({"compare", record, record, "--found-share", "nan"}, "--found-share", "nan");
  expectUsage({"compare", record, record, "--inlier-share", "1e999"}, "--inlier-share", "1e999");
  expectUsage({"compare", record, record, "--sigmas", "-1"}, "--sigmas", "-1");
  expectUsage(localizeArguments({{"--set", "templates.feature_size_m=1e999"}}), "--set",
              "templates.feature_size_m");
  expectUsage(localizeArguments({{"--set", "templates.feature_size_m=nan"}}), "--set", "nan");
  expectUsage(localizeArguments({{"--threads", "-1"}}), "--threads", "-1");
  expectUsage(with(localizeArguments(), {"--uncertainty", "0.01", "0.01", "0.01", "1", "1", "181"}),
              "--uncertainty", "180 deg");
  EXPECT_EQ(outputs_.fileCount(), 0u);
}

TEST_F(BadInput, CallsWrongUseUsage) {
  for (const Arguments& arguments :
       {Arguments{}, Arguments{"fly"}, Arguments{"localize"}, Arguments{"localize", "--what"}})
    runWhs(arguments, 2);
  const std::array<const char*, 3> wrong[] = {
      {"--profile", "best", ""},
      {"--set", "pnp.seed", ""},
      {"--set", "pnp.seed=soon", ""},
      {"--mesh-unit", "furlong", "--mesh-unit: unknown unit \"furlong\""},
      {"--method", "sift", "there are: whs, ncc, ssd, orb"}};
  for (const auto& [option, value, text] : wrong) {
    const ProgramRun refused = run({{option, value}});
    EXPECT_EQ(refused.exit_code, 2) << option << value;
    EXPECT_THAT(refused.err, HasSubstr(text));
  }
  EXPECT_EQ(outputs_.fileCount(), 0u);
}

// No output of whs replaces a file that the command reads, whichever option names it and whichever
// of its names is given.

namespace fs = std::filesystem;

class Overwrite : public testing::Test {
 protected:
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
    const std::string error = refusal(arguments);
    EXPECT_THAT(error, HasSubstr("which would be overwritten; give another file"));
    for (const std::string& word : words) EXPECT_THAT(error, HasSubstr(word)) << arguments[0];
    EXPECT_TRUE(contents() == before) << arguments[0] << " changed a file";
  }
  std::string newSession() const {
    const std::string session = file("s.boresight.json");
    runWhs({"new", "--dataset", dataset_, "--out", session, "--set", kNoSearch}, 0);
    return session;
  }

  const TemporaryFolder folder_;
  const std::string dataset_ = copyOfExample(folder_);
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
  const std::string seed = file("stations/os/seed.json"), results = file("r.sqlite");
  expectRefused({"camera", camera, "--as", "pinhole", "--out", camera}, {"file and --out"});
  expectRefused({"render", "--camera", camera, "--mesh", mesh, "--mesh-unit", "m", "--pose", seed,
                 "--out", seed},
                {"--pose", "--out"});
  Arguments problem = with(localizing("", ""), {"--out", file("p.bin"), "--image-out", mesh});
  problem[0] = "problem";
  expectRefused(problem, {"--image-out", "--mesh"});
  const Arguments evaluate = {"evaluate", "--dataset", dataset_, "--out", results};
  expectRefused(with(evaluate, {"--jsonl", dataset_}), {"--dataset", "--jsonl"});
  expectRefused(with(evaluate, {"--jsonl", mesh}), {"--jsonl: ", "model.ply"});
  runWhs(with(evaluate, kQuick), 0);
  expectRefused({"tables", results, "--out", results}, {"RESULTS and --out"});
  expectRefused({"views", "--dataset", dataset_, "--out", dataset_}, {"--dataset", "--out"});
  const std::string config =
      folder_.write("c.json", R"({"format": "boresight-config", "version": 1})").string();
  for (const char* output : {"--dictionary", "--table"})
    expectRefused({"options", "--config", config, output, config}, {"--config", output});
  const std::string points = file("points.json");
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
  const std::string session = newSession();
  runWhs({"run", session, "--case", kOsCase}, 0);
  for (const std::string& input : {session, file("stations/os/image.png")}) {
    expectRefused({"queue", session, "--csv", input}, {"--csv", input});
    expectRefused({"check", session, "--case", kOsCase, "--json", input}, {"--json", input});
    expectRefused({"report", session, "--case", kOsCase, "--out", input}, {"--out", input});
    expectRefused({"export", session, "--case", kOsCase, "--pose", input}, {"--pose", input});
  }
  expectRefused({"pack", session, "--out", session}, {"session and --out"});
  expectRefused({"pack", session, "--out", file("stations/os/model.ply")}, {"--out", "model.ply"});
  fs::copy(exampleFolder().parent_path() / "annotated.boresight.json", folder_.path());
  const std::string annotated = file("annotated.boresight.json");
  for (const std::string& input : {annotated, file("stations/os/model.ply")})
    expectRefused({"export", annotated, "--case", "bc-000028", "--points", input},
                  {"--points", input});
}

/// Its own older output, and what the same run writes again.
TEST_F(Overwrite, OfWhatACommandKeepsUpToDateGoesOn) {
  const std::string session = newSession(), results = file("r.sqlite");
  runWhs({"run", session, "--case", kOsCase}, 0);
  runWhs({"run", session, "--case", kOsCase}, 0);
  const Arguments evaluate =
      with({"evaluate", "--dataset", dataset_, "--station", "os", "--out", results}, kQuick);
  runWhs(evaluate, 0);
  runWhs(evaluate, 0);
  runWhs({"merge", results, results}, 0);
  runWhs(localizing("--out", file("result.json")), 0);
  runWhs(localizing("--out", file("result.json")), 0);
}

}  // namespace
}  // namespace boresight::test
