// SPDX-License-Identifier: Apache-2.0
// whs problem, and the flight driver that reads what it writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/localizer/problem_bytes.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Files of one problem, written by whs, and what the driver says of them.
class WhsProblem : public testing::Test {
 protected:
  /// The example's orbiting sample with a few arguments replaced.
  Arguments arguments(const std::map<std::string, std::string>& replaced = {}) const {
    Arguments made = localizeArguments(replaced);
    made[0] = "problem";
    made.insert(made.end(), {"--out", problem_, "--image-out", image_});
    return made;
  }

  ProgramRun drive() const { return runProgram(BORESIGHT_FLIGHT_DRIVER, {problem_, image_}); }

  void expectRefused(const std::string& file, const std::string& reason) const {
    const ProgramRun run = drive();
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.errorLines(), 1) << run.err;
    EXPECT_THAT(run.err, AllOf(StartsWith(file + ": "), HasSubstr(reason)));
  }

  const TemporaryFolder folder_;
  const std::string problem_ = folder_ / "problem.bin";
  const std::string image_ = folder_ / "image.pgm";
};

TEST_F(WhsProblem, HoldsWhatLocalizeRuns) {
  const ProgramRun run = runWhs(arguments());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1024 x 1024"));
  const ExampleCase example("os");
  const std::string pixels(example.image.pixels.begin(), example.image.pixels.end());
  EXPECT_EQ(folder_.read("image.pgm"), "P5\n1024 1024\n255\n" + pixels);

  LocalizerOptions options;
  options.templates.feature_size_m = 0.018;
  std::vector<std::uint8_t> expected(encodeProblem(example.problem(), options, {}));
  encodeProblem(example.problem(), options, expected);
  EXPECT_TRUE(folder_.read("problem.bin") == std::string(expected.begin(), expected.end()));
}

TEST_F(WhsProblem, DriverDoesNotPassOverLostOutput) {
  ASSERT_EQ(runWhs(arguments()).exit_code, 0);
  const std::string command = std::string(BORESIGHT_FLIGHT_DRIVER) + " '" + problem_ + "' '" +
                              image_ + "' >/dev/full 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 3);
}

TEST_F(WhsProblem, IsTheSameFromADataset) {
  ASSERT_EQ(runWhs(arguments()).exit_code, 0);
  const std::string problem = folder_.read("problem.bin");
  const ProgramRun run = runWhs({"problem", "--dataset", exampleFolder() / "dataset.json", "--case",
                                 "os-000038", "--out", problem_, "--image-out", image_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(folder_.read("problem.bin") == problem);
}

TEST_F(WhsProblem, RefusesWhatItCannotWriteOrRead) {
  const std::string dataset = exampleFolder() / "dataset.json";
  const ProgramRun no_case = runWhs({"problem", "--dataset", dataset, "--case", "none", "--out",
                                     problem_, "--image-out", image_});
  EXPECT_EQ(no_case.exit_code, 3);
  EXPECT_THAT(no_case.err, AllOf(StartsWith(dataset), HasSubstr("none")));
  Arguments both = arguments();
  both.insert(both.end(), {"--dataset", dataset, "--case", "os-000038"});
  EXPECT_EQ(runWhs(both).exit_code, 2);
  EXPECT_EQ(runWhs({"problem", "--out", problem_, "--image-out", image_}).exit_code, 2);
  EXPECT_EQ(runWhs(arguments({{"--seed", ""}})).exit_code, 2);
  EXPECT_EQ(runWhs(arguments({{"--camera", "/no/such/camera.json"}})).exit_code, 3);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(WhsProblem, TheDriverRefusesDamageInOneSentence) {
  ASSERT_EQ(runWhs(arguments()).exit_code, 0);
  const std::string problem = folder_.read("problem.bin");
  const std::string image = folder_.read("image.pgm");
  std::string damaged = problem;
  damaged[damaged.size() / 2] ^= 1;
  folder_.write("problem.bin", damaged);
  expectRefused(problem_, "checksum");
  folder_.write("problem.bin", problem.substr(0, 1000));
  expectRefused(problem_, "cut short");
  folder_.write("problem.bin", image);
  expectRefused(problem_, "not a problem file");
  folder_.write("problem.bin", std::string());
  expectRefused(problem_, "not a problem file");

  folder_.write("problem.bin", problem);
  folder_.write("image.pgm", image.substr(0, image.size() - 1));
  expectRefused(image_, "fewer pixels");
  folder_.write("image.pgm", image + "x");
  expectRefused(image_, "more bytes");
  folder_.write("image.pgm", problem);
  expectRefused(image_, "not a binary PGM");
  folder_.write("image.pgm", "P5\n1024 1024\n65535\n" + image);
  expectRefused(image_, "8 bits");
  folder_.write("image.pgm", std::string("P5\n1024 99999999999999999999\n255\n"));
  expectRefused(image_, "width and height");
  folder_.write("image.pgm", "P5\n# by hand\n512 2048 255\n" + image.substr(17));
  expectRefused(image_, "not the camera's");
  const std::string folder = folder_.path();
  for (const Arguments& arguments : {Arguments{folder, image_}, Arguments{problem_, folder}}) {
    const ProgramRun run = runProgram(BORESIGHT_FLIGHT_DRIVER, arguments);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_EQ(run.err, folder + ": is a folder; give a file\n");
  }
  EXPECT_EQ(runProgram(BORESIGHT_FLIGHT_DRIVER, {problem_, "/no/such.pgm"}).exit_code, 3);
  EXPECT_EQ(runProgram(BORESIGHT_FLIGHT_DRIVER, {"/no/such.bin", image_}).exit_code, 3);
  EXPECT_EQ(runProgram(BORESIGHT_FLIGHT_DRIVER, {problem_}).exit_code, 2);
}

}  // namespace
}  // namespace boresight::test
