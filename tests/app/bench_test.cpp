// SPDX-License-Identifier: Apache-2.0
// What `whs bench` prints and writes; how long anything takes decides nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::HasSubstr;

TEST(WhsBench, WritesWhatItMeasured) {
  const TemporaryFolder folder;
  const ProgramRun run = runWhs({"bench", "--quick", "--json", (folder / "bench.json").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const auto json = nlohmann::json::parse(folder.read("bench.json"));
  EXPECT_EQ(json["format"], "boresight-bench");
  // Two stations as they are, by portable and by the best kernels, and both at household scale.
  ASSERT_EQ(json["localizations"].size(), 6u);
  for (const auto& one : json["localizations"]) {
    EXPECT_THAT(run.out, HasSubstr(one["name"].get<std::string>()));
    EXPECT_GT(one["per_second"], 0.0);
    EXPECT_GT(one["arena_bytes"], 1000000);
    EXPECT_EQ(one["digest"].get<std::string>().size(), 64u);
    for (const char* stage : {"initialization", "rendering", "matching", "pose", "refinement"})
      EXPECT_GT(one["mean_seconds"][stage], 0.0) << one["name"] << " " << stage;
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_EQ(json["localizations"][i]["kernels"], "portable");
    EXPECT_EQ(json["localizations"][i]["converged"], 1) << i;
    EXPECT_EQ(json["localizations"][i]["digest"], json["localizations"][i + 2]["digest"]);
  }
  EXPECT_EQ(json["localizations"][4]["width"], 640);
  EXPECT_EQ(json["localizations"][4]["height"], 480);
  EXPECT_EQ(json["localizations"][4]["runs"], 2);
  ASSERT_EQ(json["matching"].size(), 4u);
  for (const auto& one : json["matching"]) {
    EXPECT_GT(one["whs_ms"]["portable"], 0.0);
    EXPECT_GT(one["ncc_ms"], 0.0);
  }
}

TEST(WhsBench, GivesTheDigestOfTheRunItTimes) {
  const TemporaryFolder folder;
  const std::string dataset = (exampleFolder() / "dataset.json").string();
  ASSERT_EQ(runWhs({"evaluate", "--dataset", dataset, "--station", "os", "--out",
                    (folder / "r.sqlite").string(), "--jsonl", (folder / "r.jsonl").string()})
                .exit_code,
            0);
  const auto evaluated = nlohmann::json::parse(folder.read("r.jsonl"));
  ASSERT_EQ(runWhs({"bench", "--quick", "--case", evaluated["id"], "--json",
                    (folder / "bench.json").string()})
                .exit_code,
            0);
  const auto timed = nlohmann::json::parse(folder.read("bench.json"));
  EXPECT_EQ(timed["localizations"][0]["digest"], evaluated["digest"]);
}

TEST(WhsBench, RefusesCasesThatAreNotThere) {
  const ProgramRun run = runWhs({"bench", "--quick", "--case", "nowhere"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("nowhere"));
}

}  // namespace
}  // namespace boresight::test
