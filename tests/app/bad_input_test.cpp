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
    replaced.emplace("--out", (outputs_ / "result.json").string());
    replaced.emplace("--trace", (outputs_ / "trace").string());
    replaced.emplace("--overlay", (outputs_ / "overlay.png").string());
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

/// Whose other end nobody opens: reading would wait for ever.
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
    expectRefused({{option, inputs_.write(name, std::string_view()).string()}}, name, "");
    expectRefused({{option, inputs_.write(name, whole.substr(0, whole.size() / 2)).string()}}, name,
                  "");
    expectRefused({{option, inputs_.write(name, "hello, this is a letter").string()}}, name, "");
  }
  expectRefused({{"--seed", (example_ / "camera.json").string()}}, "camera.json: format",
                "boresight-pose");
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
  EXPECT_THAT(refused.err, HasSubstr("behind each other"));
}

TEST_F(BadInput, AsksForTheUnitOfAMeshThatStatesNone) {
  expectRefused({{"--mesh-unit", ""}}, "model.ply", "unit");
  const ProgramRun refused = run({{"--mesh-unit", "furlong"}});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--mesh-unit: unknown unit \"furlong\""));
}

TEST_F(BadInput, DoubtsTheUnitOfAMeshAThousandTimesTooSmallOrTooLarge) {
  expectRefused({{"--mesh-unit", "mm"}}, "model.ply: mesh_unit", "is the unit right?");
  expectRefused({{"--mesh-unit", "km"}}, "model.ply: mesh_unit", "is the unit right?");
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
                "config.json: options.templates.colour", "no such option");
}

TEST_F(BadInput, NamesAnOutputThatCannotBeWritten) {
  expectRefused({{"--out", "/no/such/folder/result.json"}}, "/no/such/folder/result.json", "");
  expectRefused({{"--overlay", "/no/such/folder/o.png"}}, "/no/such/folder/o.png", "");
  expectRefused({{"--trace", "/no/such/folder/t"}}, "/no/such/folder/t", "");
}

TEST_F(BadInput, NamesAnOptionWhoseNumberIsNotFiniteOrOutOfRange) {
  const std::string record = (example_ / "none.whsr").string();
  const std::string dataset = (exampleFolder() / "dataset.json").string();
  const auto expectUsage = [](const Arguments& arguments, const std::string& option,
                              const std::string& value) {
    const ProgramRun refused = runWhs(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments[0] << " " << option << " " << value;
    EXPECT_THAT(refused.err, HasSubstr(option)) << value;
    EXPECT_THAT(refused.err, HasSubstr(value)) << option;
    EXPECT_EQ(refused.out, "");
  };
  for (const std::string value : {"nan", "1e999", "-1"}) {
    expectUsage(localizeArguments({{"--feature-size", value}}), "--feature-size", value);
    Arguments uncertain = localizeArguments();
    uncertain.insert(uncertain.end(), {"--uncertainty", value, "0.01", "0.01", "1", "1", "1"});
    expectUsage(uncertain, "--uncertainty", value);
    for (const std::string option : {"--feature-size", "--mesh-scale-sigma"})
      expectUsage({"new", "--image", "i.png", option, value, "--out", "s.json"}, option, value);
    expectUsage(
        {"camera", (example_ / "camera.json").string(), "--as", "pinhole", "--distance", value},
        "--distance", value);
    expectUsage({"evaluate", "--dataset", dataset, "--out", (outputs_ / "r.sqlite").string(),
                 "--reseed-scale", value},
                "--reseed-scale", value);
    for (const std::string option : {"--found-px", "--found-share", "--inlier-share", "--sigmas"})
      expectUsage({"compare", record, record, option, value}, option, value);
    expectUsage(localizeArguments({{"--set", "templates.feature_size_m=" + value}}), "--set",
                value == "1e999" ? "templates.feature_size_m" : value);
    expectUsage(localizeArguments({{"--threads", value}}), "--threads", value);
  }
  Arguments turned = localizeArguments();
  turned.insert(turned.end(), {"--uncertainty", "0.01", "0.01", "0.01", "1", "1", "181"});
  expectUsage(turned, "--uncertainty", "180 deg");
  EXPECT_EQ(outputs_.fileCount(), 0u);
}

TEST_F(BadInput, CallsWrongUseUsage) {
  for (const Arguments& arguments :
       {Arguments{}, Arguments{"fly"}, Arguments{"localize"}, Arguments{"localize", "--what"}})
    EXPECT_EQ(runWhs(arguments).exit_code, 2);
  EXPECT_EQ(run({{"--profile", "best"}}).exit_code, 2);
  EXPECT_EQ(run({{"--set", "pnp.seed"}}).exit_code, 2);
  EXPECT_EQ(run({{"--set", "pnp.seed=soon"}}).exit_code, 2);
  const ProgramRun unknown_method = run({{"--method", "sift"}});
  EXPECT_EQ(unknown_method.exit_code, 2);
  EXPECT_THAT(unknown_method.err, HasSubstr("there are: whs"));
  EXPECT_EQ(outputs_.fileCount(), 0u);
}

}  // namespace
}  // namespace boresight::test
