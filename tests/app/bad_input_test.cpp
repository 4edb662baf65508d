// SPDX-License-Identifier: Apache-2.0
// Everything that can be wrong with what whs localize is given: one line on stderr that names file,
// field and reason, the exit status, and nothing written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

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

TEST_F(BadInput, NamesAFileThatIsMissing) {
  expectRefused({{"--image", "/no/such/image.png"}}, "/no/such/image.png: ", "");
  expectRefused({{"--camera", "/no/such/camera.json"}}, "/no/such/camera.json: ", "");
  expectRefused({{"--mesh", "/no/such/model.ply"}}, "/no/such/model.ply: ", "");
  expectRefused({{"--seed", "/no/such/seed.json"}}, "/no/such/seed.json: ", "");
  expectRefused({{"--config", "/no/such/config.json"}}, "/no/such/config.json: ", "");
  expectRefused({{"--ignore", "/no/such/mask.png"}}, "/no/such/mask.png: ", "");
  expectRefused({{"--truth", "/no/such/truth.json"}}, "/no/such/truth.json: ", "");
}

/// A pipe without a writer: reading would block for ever.
TEST_F(BadInput, NamesAPipeAndADeviceWithoutReadingThem) {
  const std::filesystem::path pipe = inputs_ / "pipe.ply";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const char* option :
       {"--image", "--camera", "--mesh", "--seed", "--config", "--ignore", "--truth"})
    expectRefused({{option, pipe.string()}}, "pipe.ply: ", "is a pipe, a socket or a device");
  expectRefused({{"--image", "/dev/zero"}}, "/dev/zero: ", "is a pipe, a socket or a device");
}

TEST_F(BadInput, NamesAFileThatIsEmptyCutOrOfAnotherFormat) {
  for (const auto& [option, name] :
       std::map<std::string, std::string>{{"--image", "image.png"},
                                          {"--mesh", "model.ply"},
                                          {"--seed", "seed.json"},
                                          {"--camera", "camera.json"}}) {
    const std::string whole = contentOf(example_ / name);
    expectRefused({{option, inputs_.write(name, whole.substr(0, whole.size() / 2)).string()}}, name,
                  "");
  }
  expectRefused({{"--mesh", inputs_.write("model.ply", std::string_view()).string()}}, "model.ply",
                "");
  expectRefused({{"--image", inputs_.write("image.png", "hello, a letter").string()}}, "image.png",
                "");
  expectRefused({{"--seed", example_ / "camera.json"}}, "camera.json: format", "boresight-pose");
}

TEST_F(BadInput, NamesBothSizesWhenImageAndCameraDisagree) {
  std::string camera = contentOf(example_ / "camera.json");
  camera.replace(camera.find("1024"), 4, "2048");
  expectRefused({{"--camera", inputs_.write("camera.json", camera).string()}}, "image.png", "2048");
}

/// Beyond the fold no pixel has a ray: the run could only search in vain.
TEST_F(BadInput, RefusesADistortionThatFoldsBackWithinTheImage) {
  for (const char* k1 : {"-5.0", "-2.0"}) {
    std::string camera = contentOf(example_ / "camera.json");
    const auto begin = camera.find('[', camera.find("\"dist\""));
    camera.replace(begin, camera.find(']', begin) - begin,
                   std::string("[") + k1 + ", 0.0, 0.0, 0.0, 0.0");
    expectRefused({{"--camera", inputs_.write("camera.json", camera).string()}},
                  "camera.json: distortion", "folds back");
  }
}

/// Each face hides the next: a run would take as long as the image has pixels times faces.
TEST_F(BadInput, RefusesAMeshOfManyFacesBehindEachOther) {
  std::string mesh =
      "ply\nformat ascii 1.0\nelement vertex 6000\nproperty float x\n"
      "property float y\nproperty float z\nelement face 2000\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 2000; ++i) {
    const std::string z = " " + std::to_string(1e-4 * i) + "\n";
    mesh += "-9 -9" + z + "9 -9" + z + "0 18" + z;
  }
  for (int i = 0; i < 2000; ++i)
    mesh += "3 " + std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " +
            std::to_string(3 * i + 2) + "\n";
  const ProgramRun refused =
      run({{"--mesh", inputs_.write("layers.ply", mesh).string()},
           {"--seed", seedWith("[[1,0,0,0],[0,-1,0,0],[0,0,-1,1.0],[0,0,0,1]]")}});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("layers.ply"));
  EXPECT_THAT(refused.err, HasSubstr("overlap in an image row"));
}

TEST_F(BadInput, AsksForTheUnitOfAMeshThatStatesNone) {
  expectRefused({{"--mesh-unit", ""}}, "model.ply", "unit");
  const ProgramRun refused = run({{"--mesh-unit", "furlong"}});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--mesh-unit: unknown unit \"furlong\""));
}

TEST_F(BadInput, DoubtsTheUnitOfAMeshAThousandTimesTooSmallOrTooLarge) {
  expectRefused({{"--mesh-unit", "mm"}}, "model.ply: mesh_unit", "check the unit");
  expectRefused({{"--mesh-unit", "km"}}, "model.ply: mesh_unit", "check the unit");
}

TEST_F(BadInput, RefusesASeedThatIsNoRigidTransform) {
  expectRefused({{"--seed", seedWith("[[2,0,0,0],[0,1,0,0],[0,0,1,0.4],[0,0,0,1]]")}},
                "seed.json: camera_from_station", "not a rotation");
  expectRefused({{"--seed", seedWith("[[1,0,0,0],[0,1,0,0],[0,0,-1,0.4],[0,0,0,1]]")}},
                "seed.json: camera_from_station", "mirror");
  expectRefused({{"--seed", seedWith("[[1,0,0,NaN],[0,1,0,0],[0,0,1,0.4],[0,0,0,1]]")}},
                "seed.json", "");
  expectRefused({{"--seed", seedWith("[[1,0,0,1e999],[0,1,0,0],[0,0,1,0.4],[0,0,0,1]]")}},
                "seed.json", "");
}

TEST_F(BadInput, RefusesASeedThatSeesNothing) {
  expectRefused({{"--seed", seedWith("[[1,0,0,0],[0,1,0,0],[0,0,1,-0.6],[0,0,0,1]]")}},
                "seed.json: camera_from_station", "behind the camera");
  expectRefused({{"--seed", seedWith("[[1,0,0,3],[0,1,0,0],[0,0,1,0.6],[0,0,0,1]]")}},
                "seed.json: camera_from_station", "out of view");
}

TEST_F(BadInput, NamesAnOptionThatIsOutOfRangeOrUnknown) {
  const auto config = [this](const std::string& options) {
    return inputs_
        .write("config.json",
               R"({"format": "boresight-config", "version": 1, "options": {)" + options + "}}")
        .string();
  };
  expectRefused({{"--config", config(R"("templates.count": 0)")}},
                "config.json: options.templates.count", "");
  expectRefused({{"--config", config(R"("templates.colour": 1)")}},
                "config.json: options.templates.colour", "unknown option");
}

TEST_F(BadInput, NamesAnOutputThatCannotBeWritten) {
  expectRefused({{"--out", "/no/such/folder/result.json"}}, "/no/such/folder/result.json", "");
  expectRefused({{"--overlay", "/no/such/folder/o.png"}}, "/no/such/folder/o.png", "");
  expectRefused({{"--trace", "/no/such/folder/t"}}, "/no/such/folder/t", "");
}

TEST_F(BadInput, NamesAnOptionWhoseNumberIsNotFiniteOrOutOfRange) {
  const std::string record = example_ / "none.whsr";
  const std::string dataset = (exampleFolder() / "dataset.json").string();
  const auto expectUsage = [](const Arguments& arguments, const std::string& option,
                              const std::string& value) {
    const ProgramRun refused = runWhs(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments[0] << " " << option << " " << value;
    EXPECT_THAT(refused.err, HasSubstr(option)) << value;
    EXPECT_THAT(refused.err, HasSubstr(value)) << option;
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
  expectUsage(
      {"evaluate", "--dataset", dataset, "--out", outputs_ / "r.sqlite", "--reseed-scale", "nan"},
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
  EXPECT_EQ(run({{"--profile", "best"}}).exit_code, 2);
  EXPECT_EQ(run({{"--set", "pnp.seed"}}).exit_code, 2);
  EXPECT_EQ(run({{"--set", "pnp.seed=soon"}}).exit_code, 2);
  const ProgramRun unknown_method = run({{"--method", "sift"}});
  EXPECT_EQ(unknown_method.exit_code, 2);
  EXPECT_THAT(unknown_method.err, HasSubstr("there are: whs"));
  EXPECT_EQ(outputs_.fileCount(), 0u);
}

// No output of whs replaces a file that the command reads, whichever option names it and whichever
// of its names is given.

namespace fs = std::filesystem;

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
    EXPECT_THAT(run.err, HasSubstr("which would be overwritten; give another file"));
    for (const std::string& word : words) EXPECT_THAT(run.err, HasSubstr(word)) << arguments[0];
    EXPECT_TRUE(contents() == before) << arguments[0] << " changed a file";
  }
  std::string newSession() const {
    const std::string session = file("s.boresight.json");
    runWhs(
        {"new", "--dataset", file("stations/dataset.json"), "--out", session, "--set", kNoSearch},
        0);
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
  Arguments problem = with(localizing("", ""), {"--out", file("p.bin"), "--image-out", mesh});
  problem[0] = "problem";
  expectRefused(problem, {"--image-out", "--mesh"});
  expectRefused({"evaluate", "--dataset", dataset, "--out", file("r.sqlite"), "--jsonl", dataset},
                {"--dataset", "--jsonl"});
  expectRefused({"evaluate", "--dataset", dataset, "--out", file("r.sqlite"), "--jsonl", mesh},
                {"--jsonl: ", "model.ply"});
  expectRefused({"views", "--dataset", dataset, "--out", dataset}, {"--dataset", "--out"});
}

TEST_F(Overwrite, OfAnnotationsBySolveIsRefused) {
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
}

TEST_F(Overwrite, OfAnnotationsAndRunsOfASessionIsRefused) {
  fs::copy(exampleFolder().parent_path() / "annotated.boresight.json", folder_.path());
  const std::string session = file("annotated.boresight.json");
  expectRefused({"export", session, "--case", "bc-000028", "--points", session}, {"--points"});
  expectRefused(
      {"export", session, "--case", "bc-000028", "--points", file("stations/os/model.ply")},
      {"--points", "model.ply"});
}

TEST_F(Overwrite, OfResultsByTablesIsRefused) {
  const std::string results = file("r.sqlite");
  runWhs(with({"evaluate", "--dataset", file("stations/dataset.json"), "--out", results}, kQuick),
         0);
  expectRefused({"tables", results, "--out", results}, {"RESULTS and --out"});
}

TEST_F(Overwrite, OfAConfigurationByOptionsIsRefused) {
  const std::string config =
      folder_.write("c.json", R"({"format": "boresight-config", "version": 1})").string();
  for (const char* output : {"--dictionary", "--table"})
    expectRefused({"options", "--config", config, output, config}, {"--config", output});
}

TEST_F(Overwrite, OfWhatACommandKeepsUpToDateGoesOn) {
  const std::string session = newSession(), results = file("r.sqlite");
  runWhs({"run", session, "--case", kOsCase}, 0);
  EXPECT_EQ(runWhs({"run", session, "--case", kOsCase}).exit_code, 0) << "the same run again";
  const Arguments evaluate = with(
      {"evaluate", "--dataset", file("stations/dataset.json"), "--station", "os", "--out", results},
      kQuick);
  runWhs(evaluate, 0);
  runWhs(evaluate, 0);
  runWhs({"merge", results, results}, 0);
  runWhs(localizing("--out", file("result.json")), 0);
  EXPECT_EQ(runWhs(localizing("--out", file("result.json"))).exit_code, 0) << "an older output";
}

}  // namespace
}  // namespace boresight::test
