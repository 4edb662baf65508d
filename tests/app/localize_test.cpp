// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/record/problem_bytes.h"
#include "sessions/io/images/image_file.h"
#include "sessions/record/onboard_record.h"
#include "sessions/trace/trace_file.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

/// The recommended settings, with every output: run once.
struct WholeRun {
  TemporaryFolder folder;
  ProgramRun run =
      runWhs(localizeArguments({{"--truth", (exampleFolder() / "os" / "truth.json").string()},
                                {"--out", folder / "result.json"},
                                {"--trace", folder / "run.trace"},
                                {"--record", folder / "run.whsr"},
                                {"--overlay", folder / "overlay.png"}},
                               true),
             0);
  nlohmann::json result = jsonOf(folder / "result.json");
  sessions::LocalizationTrace trace = sessions::loadTrace(folder / "run.trace");

  static const WholeRun& get() {
    static const WholeRun whole;
    return whole;
  }
};

TEST(WhsLocalize, PrintsIterationsAndPoseAndWritesWhatIsAsked) {
  const auto& [folder, run, result, trace] = WholeRun::get();
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, AllOf(HasSubstr("iteration"), HasSubstr("inliers"), HasSubstr("converged"),
                             HasSubstr("1 sigma"), HasSubstr("against the truth")));
  EXPECT_EQ(result["format"], "boresight-result");
  EXPECT_EQ(result["status"], "converged");
  EXPECT_LT(result["error"]["projection_px"].get<double>(), 0.5);
  EXPECT_EQ(result["provenance"]["image"]["sha256"].get<std::string>().size(), 64u);
  EXPECT_NE(result["provenance"]["image"]["sha256"],
            result["provenance"]["image"]["pixels_sha256"]);
  EXPECT_EQ(result["provenance"]["options"], nlohmann::json({{"templates.feature_size_m", 0.018}}));
  EXPECT_EQ(trace.digest, result["provenance"]["digest"]);
  EXPECT_THAT(run.out, HasSubstr(trace.digest));
  EXPECT_EQ(trace.iterations.size(), result["iterations"]);
  EXPECT_EQ(sessions::readImage(folder / "overlay.png").width, 1024);

  const sessions::OnboardRecord record = sessions::readRecord(folder / "run.whsr");
  EXPECT_TRUE(record.whole());
  ASSERT_TRUE(record.end && record.inputs);
  EXPECT_EQ(record.end->digest, trace.digest);
  // The hash of the pixels is the one that sessions and results name.
  EXPECT_EQ(hexText(record.inputs->sha256.pixels).data(), osExample().image.pixels_sha256);
  EXPECT_LT(folder.read("run.whsr").size(), 64000u);
}

TEST(WhsLocalize, ResultHasProbabilityCandidatesAndCompetingPosesOfTheRun) {
  const auto& [folder, run, result, trace] = WholeRun::get();
  const nlohmann::json& acceptance = result["acceptance"];
  EXPECT_EQ(acceptance["probability"], trace.probability);
  EXPECT_EQ(acceptance["evidence_nats"], trace.evidence.strongest_nats());
  EXPECT_EQ(acceptance["weakest_quadrant_nats"], trace.evidence.weakest_nats());
  EXPECT_EQ(acceptance["edge_support"], trace.support.share());
  EXPECT_EQ(acceptance["edge_width_px"], trace.edge_width.widest_px());
  EXPECT_FALSE(acceptance["in_colour"].get<bool>()) << "the example is gray";
  ASSERT_EQ(result["candidates"].size(), trace.candidates.size());
  for (std::size_t i = 0; i < trace.candidates.size(); ++i)
    EXPECT_EQ(result["candidates"][i]["evidence_nats"], trace.candidates[i].rank_nats());
  ASSERT_EQ(result["compared_poses"].size(), trace.hypotheses.size());
  for (std::size_t i = 0; i < trace.hypotheses.size(); ++i) {
    const nlohmann::json& compared = result["compared_poses"][i];
    EXPECT_EQ(compared["score"], trace.hypotheses[i].score);
    EXPECT_EQ(compared["best"], static_cast<int>(i) == trace.best_hypothesis);
    EXPECT_EQ(compared["competitor"], static_cast<int>(i) == trace.competitor);
  }
  ASSERT_EQ(result["competing_poses"].size(), trace.competing_poses.size());
  for (std::size_t i = 0; i < trace.competing_poses.size(); ++i)
    EXPECT_EQ(result["competing_poses"][i]["margin_nats"], trace.competing_poses[i].margin_nats);
  EXPECT_GT(result["image_quality"]["contrast_gray"], 10.0);
  EXPECT_THAT(run.out, AllOf(HasSubstr("The probability that the pose is right is"),
                             HasSubstr(" and comes from "), HasSubstr("image at the seed: noise")));
}

TEST(WhsLocalize, DoubtfulPose_IsStatedNextToTheSeedThatIsKept) {
  const TemporaryFolder folder;
  const sessions::GrayImage image = halfHiddenImage();
  sessions::writePng(folder / "hidden.png", image.pixels, image.width, image.height, 1);
  const ProgramRun run = runWhs(localizeArguments({{"--image", folder / "hidden.png"},
                                                   {"--out", folder / "result.json"},
                                                   {"--overlay", folder / "overlay.png"}},
                                                  true),
                                4);
  EXPECT_THAT(run.err, AllOf(HasSubstr("not_supported"), HasSubstr("Doubtful pose, probability")));
  const nlohmann::json result = jsonOf(folder / "result.json");
  EXPECT_EQ(result["status"], "not_supported");
  const nlohmann::json& doubtful = result["doubtful_pose"];
  EXPECT_EQ(doubtful["probability"], result["acceptance"]["probability"]);
  EXPECT_EQ(doubtful["camera_from_station"], result["iteration"].back()["camera_from_station"]);
  EXPECT_EQ(result["camera_from_station"], result["camera_from_station_seed"]);
  EXPECT_FALSE(WholeRun::get().result.contains("doubtful_pose"));
}

/// Other numbers of threads, and with a search: SameBits.Threads and SameBits.Kernels.
TEST(WhsLocalize, GivesTheSameDigestByAllKernelsAndThreadsAndWithRecording) {
  const TemporaryFolder folder;
  const std::string plain = digestOf(runWhs(localizeArguments(), 0));
  EXPECT_EQ(plain.size(), std::string("digest ").size() + 64);
  using Option = std::pair<const std::string, std::string>;
  for (const Option& option : {Option{"--kernels", "portable"}, Option{"--trace", folder / "t"},
                               Option{"--threads", "0"}, Option{"--threads", "3"}})
    EXPECT_EQ(digestOf(runWhs(localizeArguments({option}))), plain)
        << option.first << " " << option.second;
  EXPECT_NE(digestOf(runWhs(localizeArguments({{"--set", "pnp.seed=2"}}))), plain);
  EXPECT_THAT(runWhs(localizeArguments({{"--kernels", "abacus"}}), 2).err,
              AllOf(HasSubstr("--kernels"), HasSubstr("best, portable")));
}

TEST(WhsLocalize, GivesTheSameDigestInTheMemoryOfFlight) {
  const ProgramRun& plain = WholeRun::get().run;
  const ProgramRun flight = runWhs(localizeArguments({{"--profile", "flight"}}, true), 0);
  EXPECT_EQ(digestOf(flight), digestOf(plain));
  EXPECT_THAT(flight.out,
              AllOf(HasSubstr("high water"), HasSubstr("refine"), HasSubstr("bytes of 10000000")));
  EXPECT_THAT(plain.out, Not(HasSubstr("high water")));
}

TEST(WhsLocalize, RefusesOptionsThatAskForMoreMemoryThanFlightHas) {
  const ProgramRun asking = runWhs(
      localizeArguments({{"--profile", "flight"}, {"--set", "render.max_edge_pixels=1000000"}}), 4);
  EXPECT_EQ(asking.errorLines(), 1) << asking.err;
  EXPECT_THAT(asking.err, AllOf(HasSubstr("arena_too_small"), HasSubstr("bytes"),
                                HasSubstr("of 10000000"), HasSubstr("lower")));
  EXPECT_THAT(asking.out, Not(HasSubstr("digest")));
}

TEST(WhsLocalize, ExitsWith4AndSaysWhyWhenItDoesNotConverge) {
  const TemporaryFolder folder;
  const std::string out = folder / "result.json";
  EXPECT_THAT(refusal(localizeArguments({{"--set", "loop.max_iterations=1"}, {"--out", out}}), 4),
              AllOf(HasSubstr("iteration_limit"), HasSubstr("mm"), HasSubstr("needed")));
  const auto result = jsonOf(out);
  EXPECT_EQ(result["completed"], false);
  EXPECT_EQ(result["camera_from_station"], result["camera_from_station_seed"]);
  EXPECT_FALSE(result.contains("covariance"));
}

TEST(WhsLocalize, TakesConfigurationAssignmentsAndUncertaintyFromTheCommandLine) {
  const TemporaryFolder folder;
  const std::string out = folder / "result.json";
  const std::string config = folder.write(
      "config.json", R"({"format": "boresight-config", "version": 1, "profile": "paper",
                         "options": {"loop.max_iterations": 1, "pnp.seed": 3}})");
  const Arguments uncertain = {"--uncertainty", "0.01",   "0.02", "0.03", "1", "2", "3",
                               "--pivot",       "station"};
  const Arguments arguments =
      localizeArguments({{"--config", config}, {"--set", "pnp.seed=4"}, {"--out", out}});
  runWhs(with(arguments, uncertain), 4);
  const auto provenance = jsonOf(out)["provenance"];
  EXPECT_EQ(provenance["profile"], "paper");
  EXPECT_EQ(provenance["options"]["loop.max_iterations"], 1);
  EXPECT_EQ(provenance["options"]["pnp.seed"], 4) << "an assignment comes after the file";
  const auto& uncertainty = provenance["uncertainty"];
  EXPECT_EQ(uncertainty["translation_m"], nlohmann::json({0.01, 0.02, 0.03}));
  EXPECT_EQ(uncertainty["rotation_deg"], nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(uncertainty["pivot"], "station");
}

TEST(WhsLocalize, SeesOnlyWhatTheIgnoreMaskLeaves) {
  const TemporaryFolder folder;
  const std::string mask = folder / "all.png";
  sessions::writePng(mask, std::vector<std::uint8_t>(1024 * 1024, 255), 1024, 1024, 1);
  refusal(localizeArguments({{"--ignore", mask}}), 4);
}

// Other methods, on the command line.

TEST(WhsMethods, ResultNamesTheMethodAndItsOptions) {
  const TemporaryFolder folder;
  const ProgramRun run = runWhs(localizeArguments({{"--method", "ncc"},
                                                   {"--set", "ncc.kind=ccorr_normed"},
                                                   {"--out", folder / "result.json"}}));
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 4) << run.err;
  EXPECT_THAT(jsonOf(folder / "result.json").dump(),
              AllOf(HasSubstr("\"method\":\"ncc\""), HasSubstr("\"ncc.kind\":\"ccorr_normed\"")));
}

TEST(WhsMethods, APoseFoundWithoutASearch_IsJudgedByEdgeSupportAndReportedSo) {
  const ProgramRun run =
      runWhs(localizeArguments({{"--method", "ncc"}, {"--set", "support.min_support=1"}}), 4);
  EXPECT_THAT(run.out + run.err,
              AllOf(HasSubstr("edge support is"), Not(HasSubstr("probability"))));
}

TEST(WhsMethods, RefusesWhatDoesNotFit) {
  EXPECT_THAT(runWhs(localizeArguments({{"--method", "loftr-r"}}), 2).err, HasSubstr("--matcher"));
  EXPECT_THAT(runWhs(localizeArguments({{"--method", "orb"}, {"--set", "orb.levels=99"}}), 2).err,
              HasSubstr("orb.levels"));
  runWhs(localizeArguments({{"--method", "orb"}, {"--record", "/no/such/run.whsr"}}), 2);
}

TEST(WhsMethods, AMatcherThatDiesIsOneSentence) {
  EXPECT_THAT(refusal(localizeArguments(
                          {{"--method", "external"}, {"--matcher", BORESIGHT_TEST_MATCHER " die"}}),
                      4),
              AllOf(HasSubstr("ended with status 3"), HasSubstr("out of paper")));
}

// whs problem, and the flight driver that reads what it writes.

/// Files of one problem, written by whs, and what the driver says of them.
class WhsProblem : public testing::Test {
 protected:
  /// The example's orbiting sample with a few arguments replaced.
  Arguments arguments(const std::map<std::string, std::string>& replaced = {}) const {
    Arguments arguments = localizeArguments(replaced);
    arguments[0] = "problem";
    return with(arguments, {"--out", problem_, "--image-out", image_});
  }

  void expectRefused(const std::string& file, const std::string& reason) const {
    const ProgramRun run = runProgram(BORESIGHT_FLIGHT_DRIVER, {problem_, image_});
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
  EXPECT_THAT(runWhs(arguments(), 0).out, HasSubstr("1024 x 1024"));
  const ExampleCase& example = osExample();
  const std::string pixels(example.image.pixels.begin(), example.image.pixels.end());
  EXPECT_EQ(folder_.read("image.pgm"), "P5\n1024 1024\n255\n" + pixels);

  LocalizerOptions options;
  options.templates.feature_size_m = 0.018;
  options.search.enabled = false;
  std::vector<std::uint8_t> expected(encodeProblem(example.problem(), options, {}));
  encodeProblem(example.problem(), options, expected);
  EXPECT_TRUE(folder_.read("problem.bin") == std::string(expected.begin(), expected.end()));

  // The driver fails when its output is lost.
  const std::string command = std::string(BORESIGHT_FLIGHT_DRIVER) + " '" + problem_ + "' '" +
                              image_ + "' >/dev/full 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 3);
}

TEST_F(WhsProblem, IsTheSameFromADataset) {
  // The end effector as the dataset states it.
  runWhs(with(arguments(), {"--end-effector", "0", "0", "0.37"}), 0);
  const std::string problem = folder_.read("problem.bin");
  runWhs({"problem", "--dataset", exampleDataset(), "--case", kOsCase, "--out", problem_,
          "--image-out", image_, "--set", kNoSearch},
         0);
  EXPECT_TRUE(folder_.read("problem.bin") == problem);
}

TEST_F(WhsProblem, RefusesWhatItCannotWriteOrRead) {
  const std::string dataset = exampleDataset();
  const Arguments outputs = {"problem", "--out", problem_, "--image-out", image_};
  EXPECT_THAT(runWhs(with(outputs, {"--dataset", dataset, "--case", "none"}), 3).err,
              AllOf(StartsWith(dataset), HasSubstr("none")));
  runWhs(with(arguments(), {"--dataset", dataset, "--case", kOsCase}), 2);
  runWhs(outputs, 2);
  runWhs(arguments({{"--seed", ""}}), 2);
  runWhs(arguments({{"--camera", "/no/such/camera.json"}}), 3);
  EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(WhsProblem, TheDriverRefusesDamageInOneSentence) {
  runWhs(arguments(), 0);
  const std::string problem = folder_.read("problem.bin");
  const std::string image = folder_.read("image.pgm");
  std::string damaged = problem;
  damaged[damaged.size() / 2] ^= 1;
  const std::pair<std::string, const char*> problems[] = {{damaged, "checksum"},
                                                          {problem.substr(0, 1000), "truncated"},
                                                          {image, "not a problem file"},
                                                          {"", "not a problem file"}};
  for (const auto& [bytes, reason] : problems) {
    folder_.write("problem.bin", bytes);
    expectRefused(problem_, reason);
  }
  folder_.write("problem.bin", problem);
  const std::pair<std::string, const char*> images[] = {
      {image.substr(0, image.size() - 1), "fewer pixels"},
      {image + "x", "more bytes"},
      {problem, "not a binary PGM"},
      {"P5\n1024 1024\n65535\n" + image, "8 bits"},
      {"P5\n1024 99999999999999999999\n255\n", "width and height"},
      {"P5\n512 2048\n255\n" + image.substr(17), "not the camera's"}};
  for (const auto& [bytes, reason] : images) {
    folder_.write("image.pgm", bytes);
    expectRefused(image_, reason);
  }
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
