// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "sessions/evaluation/results_file.h"
#include "tests/app/ended_whs.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/approach_files.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

class WhsFollow : public testing::Test {
 protected:
  Arguments followArguments(const std::filesystem::path& images, const Arguments& more = {}) const {
    const TemporaryFolder& approach = approachFolder();
    const Arguments inputs = {"follow",
                              "--images",
                              images,
                              "--camera",
                              approach / "camera.json",
                              "--mesh",
                              approach / "model.ply",
                              "--mesh-unit",
                              "m",
                              "--seed",
                              approach / "seed.json"};
    return with(with(inputs, {"--out", results_, "--jsonl", folder_ / "r.jsonl"}), more);
  }
  std::vector<nlohmann::json> lines() const { return jsonLines(folder_.read("r.jsonl")); }
  const TemporaryFolder folder_;
  const std::string results_ = folder_ / "r.sqlite";
};

TEST_F(WhsFollow, Folder_IsFollowedFrameByFrameAndItsResultsAreContinued) {
  const std::filesystem::path images = approachFolder() / "frames";
  const ProgramRun run = runWhs(followArguments(images), 0);
  EXPECT_EQ(run.err, "") << "progress belongs on a terminal only";
  EXPECT_THAT(run.out, AllOf(HasSubstr("6 of 6 frames accepted; "), HasSubstr(" frames/s\n")));
  const auto results = lines();
  ASSERT_EQ(results.size(), 6u);
  for (int i = 0; i < kApproachFrames; ++i) {
    const nlohmann::json& result = results[static_cast<std::size_t>(i)];
    EXPECT_EQ(result["id"], std::to_string(i) + ".png");
    EXPECT_EQ(result["station"], "model");
    EXPECT_EQ(result["completed"], true);
    if (i == 0) continue;
    const nlohmann::json& before = results[static_cast<std::size_t>(i - 1)];
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        EXPECT_NEAR(result["camera_from_station_seed"][row][column].get<double>(),
                    before["camera_from_station"][row][column].get<double>(), 1e-12);
  }
  const sessions::Results stored = sessions::readResults(results_);
  EXPECT_EQ(stored.runs.size(), 6u);
  EXPECT_EQ(stored.facts.dataset.cases, 6);

  EXPECT_THAT(runWhs(followArguments(images), 0).err, HasSubstr("resumed, 6 frames are done"));
  EXPECT_EQ(lines(), results);
  EXPECT_THAT(runWhs(followArguments(images, {"--motion", "2", "0.5"}), 3).err,
              HasSubstr("its runs belong to another dataset"));
}

TEST_F(WhsFollow, UnreadableAndOtherSizedFrames_AreLostWithTheirReason) {
  folder_.write("bad.png", std::string_view("no image"));
  const std::vector<std::uint8_t> pixels(64 * 48, 9);
  sessions::writePng(folder_ / "small.png", pixels, 64, 48, 1);
  const std::string frames = (approachFolder() / "frames").string();
  const std::string file = folder_.write("list.txt", frames + "/0.png\nbad.png\n" + frames +
                                                         "/1.png\nsmall.png\n" + frames + "/2.png");
  const ProgramRun run = runWhs(followArguments(file), 0);
  EXPECT_EQ(run.errorLines(), 2) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("bad.png: "),
                             HasSubstr("small.png: image size: is 64 x 48, but the camera is")));
  EXPECT_THAT(run.out, HasSubstr("3 of 5 frames accepted, 2 lost: 2, 4; "));
  EXPECT_EQ(lines()[1]["status"], "input_error");
}

TEST_F(WhsFollow, InterruptedSequence_KeepsItsFramesAndContinues) {
  constexpr int kLong = 16;  // to and fro
  std::filesystem::create_directory(folder_ / "long");
  for (int i = 0; i < kLong; ++i) {
    const int step = i % (2 * kApproachFrames - 2);
    const int frame = std::min(step, 2 * kApproachFrames - 2 - step);
    std::filesystem::create_symlink(approachFolder() / ("frames/" + std::to_string(frame) + ".png"),
                                    folder_ / ("long/" + std::to_string(i) + ".png"));
  }
  const Arguments arguments = followArguments(folder_ / "long");
  const EndedWhs ended = endWhsAfter(arguments, SIGINT, results_, 3);
  EXPECT_TRUE(WIFEXITED(ended.status));
  EXPECT_EQ(WEXITSTATUS(ended.status), 128 + SIGINT);
  EXPECT_GE(ended.held, 3);
  EXPECT_LT(ended.held, kLong);
  EXPECT_EQ(lines().size(), static_cast<std::size_t>(ended.held));
  const ProgramRun run = runWhs(arguments, 0);
  EXPECT_THAT(run.err, HasSubstr("resumed, " + std::to_string(ended.held) + " frames are done"));
  EXPECT_THAT(run.out, HasSubstr("16 of 16 frames accepted"));
  EXPECT_EQ(lines().size(), static_cast<std::size_t>(kLong));
}

TEST_F(WhsFollow, SequenceWithoutAnyPose_EndsAsNotConverged) {
  const sessions::GrayImage covered = GeneratedApproach(24).coveredImage();
  sessions::writePng(folder_ / "0.png", covered.pixels, 512, 512, 1);
  EXPECT_THAT(runWhs(followArguments(folder_.write("list.txt", "0.png\n")), 4).out,
              HasSubstr("0 of 1 frames accepted, 1 lost: 1; "));
}

TEST_F(WhsFollow, BadInputs_AreRefusedInOneLine) {
  const auto error = [this](const std::string& images, const Arguments& more, int exit_code) {
    const ProgramRun run = runWhs(followArguments(images, more), exit_code);
    EXPECT_FALSE(std::filesystem::exists(results_));
    return run.err;
  };
  const std::string frames = approachFolder() / "frames",
                    movie = folder_.write("m.mp4", "no video");
  EXPECT_THAT(error(folder_ / "none", {}, 3), HasSubstr("there is no such folder or file"));
  EXPECT_THAT(error(movie, {"--bit-depth", "8"}, 2), HasSubstr("are not for a video"));
  EXPECT_THAT(error(frames, {"--motion", "5", "200"}, 2),
              HasSubstr("the angle is at most 180 deg"));
  EXPECT_THAT(error(frames, {"--set", "loop.none=1"}, 2), HasSubstr("loop.none"));
}

}  // namespace
}  // namespace boresight::test
