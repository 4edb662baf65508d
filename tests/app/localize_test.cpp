// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "sessions/io/image_file.h"
#include "sessions/record/onboard_record.h"
#include "sessions/run/trace_file.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(WhsLocalize, PrintsIterationsAndPoseAndWritesWhatIsAsked) {
  const TemporaryFolder folder;
  const ProgramRun run =
      runWhs(localizeArguments({{"--truth", (exampleFolder() / "os" / "truth.json").string()},
                                {"--out", (folder / "result.json").string()},
                                {"--trace", (folder / "run.trace").string()},
                                {"--overlay", (folder / "overlay.png").string()}}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, AllOf(HasSubstr("iteration"), HasSubstr("inliers"), HasSubstr("converged"),
                             HasSubstr("1 sigma"), HasSubstr("against the truth")));

  const auto result = nlohmann::json::parse(folder.read("result.json"));
  EXPECT_EQ(result["format"], "boresight-result");
  EXPECT_EQ(result["status"], "converged");
  EXPECT_LT(result["error"]["projection_px"].get<double>(), 0.5);
  EXPECT_EQ(result["provenance"]["image"]["sha256"].get<std::string>().size(), 64u);
  EXPECT_NE(result["provenance"]["image"]["sha256"],
            result["provenance"]["image"]["pixels_sha256"]);
  EXPECT_EQ(result["provenance"]["options"], nlohmann::json({{"templates.feature_size_m", 0.018}}));

  const sessions::LocalizationTrace trace = sessions::loadTrace(folder / "run.trace");
  EXPECT_EQ(trace.digest, result["provenance"]["digest"]);
  EXPECT_THAT(run.out, HasSubstr(trace.digest));
  EXPECT_EQ(trace.iterations.size(), result["iterations"]);
  EXPECT_EQ(sessions::readImage(folder / "overlay.png").width, 1024);
}

TEST(WhsLocalize, GivesTheSameDigestWithAllKernels) {
  const auto digestWith = [](const std::string& kernels) {
    const ProgramRun run = runWhs(localizeArguments({{"--kernels", kernels}}));
    EXPECT_EQ(run.exit_code, 0) << kernels << ": " << run.err;
    return run.out.substr(std::min(run.out.find("digest"), run.out.size()));
  };
  EXPECT_EQ(digestWith("portable"), digestWith("best"));
  const ProgramRun unknown = runWhs(localizeArguments({{"--kernels", "abacus"}}));
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("--kernels"), HasSubstr("best, portable")));
}

TEST(WhsLocalize, GivesTheSameDigestWithAndWithoutRecording) {
  const TemporaryFolder folder;
  const auto digestOf = [](const ProgramRun& run) {
    return run.out.substr(run.out.find("digest"));
  };
  const std::string plain = digestOf(runWhs(localizeArguments()));
  EXPECT_EQ(plain.size(), std::string("digest ").size() + 64 + 1);
  EXPECT_EQ(digestOf(runWhs(localizeArguments({{"--trace", (folder / "t").string()}}))), plain);
  EXPECT_NE(digestOf(runWhs(localizeArguments({{"--set", "pnp.seed=2"}}))), plain);
}

TEST(WhsLocalize, WritesTheOnboardRecord) {
  const TemporaryFolder folder;
  const ProgramRun run = runWhs(localizeArguments({{"--record", (folder / "run.whsr").string()}}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const sessions::OnboardRecord record = sessions::readRecord(folder / "run.whsr");
  EXPECT_TRUE(record.whole());
  ASSERT_TRUE(record.end && record.inputs);
  EXPECT_THAT(run.out, HasSubstr("digest " + record.end->digest));
  // The hash of the pixels is the one that sessions and results name.
  EXPECT_EQ(hexText(record.inputs->sha256.pixels).data(),
            sessions::readImage(exampleFolder() / "os/image.png").pixels_sha256);
  EXPECT_LT(folder.read("run.whsr").size(), 64000u);
}

TEST(WhsCompare, SaysByItsExitCodeWhetherTwoRunsWereTheSame) {
  const TemporaryFolder folder;
  const std::string first = (folder / "a.whsr").string();
  const std::string second = (folder / "b.whsr").string();
  ASSERT_EQ(runWhs(localizeArguments({{"--record", first}})).exit_code, 0);
  ASSERT_EQ(runWhs(localizeArguments({{"--record", second}})).exit_code, 0);
  const ProgramRun equal = runWhs({"compare", first, second});
  EXPECT_EQ(equal.exit_code, 0) << equal.out;
  EXPECT_THAT(equal.out, HasSubstr("equal to the bit"));
  ASSERT_EQ(runWhs(localizeArguments({{"--record", second}, {"--set", "pnp.seed=2"}})).exit_code,
            0);
  const ProgramRun other = runWhs({"compare", first, second});
  EXPECT_EQ(other.exit_code, 6);
  EXPECT_THAT(other.out, HasSubstr("options: the option pnp.seed"));
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  write("cut.whsr", folder.read("a.whsr").substr(0, 4000));
  EXPECT_EQ(runWhs({"compare", first, (folder / "cut.whsr").string()}).exit_code, 5);
  write("no.whsr", "no record");
  const ProgramRun none = runWhs({"compare", first, (folder / "no.whsr").string()});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, HasSubstr("no.whsr"));
}

TEST(WhsLocalize, GivesTheSameDigestInTheMemoryOfFlight) {
  const auto digestOf = [](const ProgramRun& run) {
    return run.out.substr(run.out.find("digest"), 64 + 7);
  };
  for (const std::string station : {"os", "bc"}) {
    const std::filesystem::path folder = exampleFolder() / station;
    std::map<std::string, std::string> inputs;
    for (const auto& [name, file] :
         {std::pair{"--image", "image.png"}, std::pair{"--camera", "camera.json"},
          std::pair{"--mesh", "model.ply"}, std::pair{"--seed", "seed.json"}})
      inputs[name] = (folder / file).string();
    const ProgramRun plain = runWhs(localizeArguments(inputs));
    inputs["--profile"] = "flight";
    const ProgramRun flight = runWhs(localizeArguments(inputs));
    EXPECT_EQ(flight.exit_code, 0) << flight.err;
    EXPECT_EQ(digestOf(flight), digestOf(plain));
    EXPECT_THAT(flight.out, AllOf(HasSubstr("high water"), HasSubstr("refine"),
                                  HasSubstr("bytes of 10000000")));
    EXPECT_THAT(plain.out, Not(HasSubstr("high water")));
  }
}

TEST(WhsLocalize, RefusesOptionsThatAskForMoreMemoryThanFlightHas) {
  const ProgramRun asking = runWhs(
      localizeArguments({{"--profile", "flight"}, {"--set", "render.max_edge_pixels=1000000"}}));
  EXPECT_EQ(asking.exit_code, 4);
  EXPECT_EQ(asking.errorLines(), 1) << asking.err;
  EXPECT_THAT(asking.err, AllOf(HasSubstr("arena_too_small"), HasSubstr("bytes"),
                                HasSubstr("10000000 in all"), HasSubstr("lower")));
  EXPECT_THAT(asking.out, Not(HasSubstr("digest")));
}

TEST(WhsLocalize, GivesTheSameDigestWithAnyNumberOfThreads) {
  const auto digestOf = [](const ProgramRun& run) {
    return run.out.substr(run.out.find("digest"));
  };
  const std::string plain = digestOf(runWhs(localizeArguments()));
  for (const std::string threads : {"0", "1", "2", "3", "8"})
    EXPECT_EQ(digestOf(runWhs(localizeArguments({{"--threads", threads}}))), plain) << threads;
  EXPECT_EQ(runWhs(localizeArguments({{"--threads", "-1"}})).exit_code, 2);
}

TEST(WhsLocalize, ExitsWith4AndSaysWhyWhenItDoesNotConverge) {
  const TemporaryFolder folder;
  const ProgramRun run = runWhs(localizeArguments(
      {{"--set", "loop.max_iterations=1"}, {"--out", (folder / "result.json").string()}}));
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("iteration_limit"), HasSubstr("mm"), HasSubstr("needed")));
  const auto result = nlohmann::json::parse(folder.read("result.json"));
  EXPECT_EQ(result["completed"], false);
  EXPECT_EQ(result["camera_from_station"], result["camera_from_station_seed"]);
  EXPECT_FALSE(result.contains("covariance"));
}

TEST(WhsLocalize, TakesProfileConfigAndAssignmentsInThisOrder) {
  const TemporaryFolder folder;
  const auto config = folder.write(
      "config.json", R"({"format": "boresight-config", "version": 1, "profile": "paper",
                         "options": {"loop.max_iterations": 1, "pnp.seed": 3}})");
  const ProgramRun run = runWhs(localizeArguments({{"--config", config.string()},
                                                   {"--set", "pnp.seed=4"},
                                                   {"--out", (folder / "result.json").string()}}));
  EXPECT_EQ(run.exit_code, 4) << run.err;
  const auto provenance = nlohmann::json::parse(folder.read("result.json"))["provenance"];
  EXPECT_EQ(provenance["profile"], "paper");
  EXPECT_EQ(provenance["options"]["loop.max_iterations"], 1);
  EXPECT_EQ(provenance["options"]["pnp.seed"], 4);
}

TEST(WhsLocalize, TakesTheUncertaintyFromTheCommandLine) {
  const TemporaryFolder folder;
  Arguments arguments = localizeArguments(
      {{"--set", "loop.max_iterations=1"}, {"--out", (folder / "result.json").string()}});
  for (const char* value :
       {"--uncertainty", "0.01", "0.02", "0.03", "1", "2", "3", "--pivot", "station"})
    arguments.emplace_back(value);
  runWhs(arguments);
  const auto uncertainty =
      nlohmann::json::parse(folder.read("result.json"))["provenance"]["uncertainty"];
  EXPECT_EQ(uncertainty["translation_m"], nlohmann::json({0.01, 0.02, 0.03}));
  EXPECT_EQ(uncertainty["rotation_deg"], nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(uncertainty["pivot"], "station");
}

TEST(WhsLocalize, SeesOnlyWhatTheIgnoreMaskLeaves) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> mask(1024 * 1024, 255);
  sessions::writePng(folder / "all.png", mask, 1024, 1024, 1);
  const ProgramRun run = runWhs(localizeArguments({{"--ignore", (folder / "all.png").string()}}));
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

}  // namespace
}  // namespace boresight::test
