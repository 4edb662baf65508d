// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/batch.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "sessions/io/files/errors.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/run_batch.h"

namespace boresight::sessions {
namespace {

using test::runBatch;

Dataset exampleDataset() { return readDataset(test::exampleFolder() / "dataset.json"); }

/// Quick options: the runs need not converge.
BatchOptions quick() {
  BatchOptions options;
  options.localizer = defaultProfile();
  options.localizer.search.enabled = false;
  options.localizer.loop.max_attempts = 1;
  options.localizer.loop.max_iterations = 1;
  options.localizer.loop.max_rolled_hypotheses = 1;
  return options;
}

TEST(RunBatch, LocalizesTheExample) {
  BatchOptions options;
  options.localizer = defaultProfile();
  const auto results = runBatch(exampleDataset(), options, {});
  ASSERT_EQ(results.size(), 2u);
  for (const RunResult& result : results) {
    EXPECT_EQ(result.status, "converged") << result.case_id << ": " << result.message;
    EXPECT_EQ(result.success, true) << result.case_id;
    EXPECT_GT(result.matches, 6);
    EXPECT_GT(result.edge_support, 0.3);
    ASSERT_TRUE(result.error && result.seed_error);
    EXPECT_LT(*result.error->projection_px, 1.0);
    EXPECT_GT(*result.seed_error->projection_px, 5.0);
    EXPECT_EQ(result.digest.size(), 64u);
    EXPECT_GT(result.probability.value_or(0.0), 0.9);
    EXPECT_TRUE(result.image_quality);
  }
}

TEST(RunBatch, MeasuresCorrectionsAtTheEndEffectorOfTheCase) {
  Dataset dataset = exampleDataset();
  dataset.cases.resize(1);
  auto& camera_from_end_effector = dataset.cases.front().camera_from_end_effector;
  camera_from_end_effector.reset();
  BatchOptions options = quick();
  std::set<std::string> digests = {runBatch(dataset, options, {}).front().digest};
  options.localizer.loop.correction_point = CorrectionPoint::kEndEffector;
  EXPECT_THAT(runBatch(dataset, options, {}).front().message,
              HasSubstr("no end effector is known"));
  for (const double ahead_m : {0.3, 0.4}) {
    camera_from_end_effector.emplace().translation_m.z() = ahead_m;
    digests.insert(runBatch(dataset, options, {}).front().digest);
  }
  EXPECT_EQ(digests.size(), 3u);
}

TEST(RunBatch, GivesTheSameInTheSameOrderForAnyNumberOfJobs) {
  BatchOptions options = quick();
  options.reseeds = 2;
  const auto alone = runBatch(exampleDataset(), options, {});
  options.jobs = 3;
  std::size_t told = 0;
  const auto together = runBatch(exampleDataset(), options,
                                 [&told](std::size_t done, std::size_t total, const RunResult&) {
                                   EXPECT_EQ(done, ++told);
                                   EXPECT_EQ(total, 6u);
                                 });
  ASSERT_TRUE(alone.size() == 6 && together.size() == 6 && told == 6);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].case_id, together[i].case_id);
    EXPECT_EQ(alone[i].reseed, static_cast<std::int32_t>(i % 3));
    EXPECT_EQ(alone[i].reseed, together[i].reseed);
    EXPECT_EQ(alone[i].digest, together[i].digest);
  }
  EXPECT_NE(alone[0].digest, alone[1].digest);
}

TEST(RunBatch, StateOfACase_DecidesItsScene) {
  Dataset dataset = exampleDataset();
  const auto plain = runBatch(dataset, quick(), {});
  for (auto& [id, station] : dataset.stations) {
    PartSource held = station.parts.front();
    held.name = "held";
    held.frame = kCameraFrame;
    held.frame_from_mesh.translation_m.z() = 0.3;
    held.state = {PartRole::kOccludes, false};
    station.parts.push_back(held);
  }
  const auto off = runBatch(dataset, quick(), {});
  dataset.cases[1].part_states = {PartState(), PartState{PartRole::kOccludes, true}};
  const auto one_on = runBatch(dataset, quick(), {});
  const auto all_on = runBatch(withPartStates(dataset, {{"held", "on"}}), quick(), {});
  ASSERT_EQ(plain.size(), 2u);
  EXPECT_EQ(off[0].digest, plain[0].digest);
  EXPECT_EQ(off[1].digest, plain[1].digest);
  EXPECT_EQ(one_on[0].digest, plain[0].digest);
  EXPECT_NE(one_on[1].digest, plain[1].digest);
  EXPECT_NE(all_on[0].digest, plain[0].digest);
  EXPECT_EQ(all_on[1].digest, one_on[1].digest);
}

TEST(Mirrored, PartsFixedToTheCamera_StayAsTheyAre) {
  SceneMesh scene;
  scene.vertices_in_station_m = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {5, 0, 1}, {6, 0, 1}, {5, 1, 1}};
  scene.faces = {{{0, 1, 2}}, {{3, 4, 5}}};
  scene.part_of_face = {0, 1};
  scene.parts.resize(2);
  scene.parts[1].match = false;
  scene.parts[1].fixed_to_camera = true;
  const SceneMesh turned = mirrored(scene, MirrorAxis::kX);
  EXPECT_EQ(turned.vertices_in_station_m[0], Eigen::Vector3f(2, 0, 0));
  EXPECT_EQ(turned.faces[0].vertex, (std::array<std::int32_t, 3>{0, 2, 1}));
  EXPECT_EQ(turned.vertices_in_station_m[3], scene.vertices_in_station_m[3]);
  EXPECT_EQ(turned.faces[1].vertex, scene.faces[1].vertex);
}

TEST(RunBatch, RunsWithinTheMemoryOfOneThread) {
  const test::ExampleCase example("os");
  BatchOptions options;
  options.localizer = defaultProfile();
  options.localizer.search.enabled = false;
  options.localizer.templates.feature_size_m = 0.018;  // as the station's
  const LocalizationTrace alone =
      localize(example.problem(), options.localizer,
               RunSettings{RecordLevel::kSummary, 0, 1, Kernels::kPortable});
  options.memory_limit = alone.memory.total();
  options.stations = {"os"};
  for (const RunResult& result : runBatch(exampleDataset(), options, {}))
    EXPECT_EQ(result.status, "converged") << result.message;
}

TEST(RunBatch, FiltersByCaseStationAndTagAndRefusesWhatNamesNothing) {
  const Dataset dataset = exampleDataset();
  for (auto filter : {&BatchOptions::cases, &BatchOptions::stations, &BatchOptions::tags}) {
    BatchOptions options = quick();
    options.*filter = {"moon"};
    EXPECT_THROW(runBatch(dataset, options, {}), InputError);
  }
  BatchOptions options = quick();
  options.mesh_of = "moon";
  EXPECT_THROW(runBatch(dataset, options, {}), InputError);
  options.mesh_of = "os";
  const auto of_another_mesh = runBatch(dataset, options, {});
  ASSERT_EQ(of_another_mesh.size(), 1u);
  EXPECT_EQ(of_another_mesh.front().station, "bc");
  EXPECT_EQ(of_another_mesh.front().success, false);
  options = quick();
  options.stations = {"os"};
  EXPECT_EQ(runBatch(dataset, options, {}).size(), 1u);
  options.stations.clear();
  options.tags = {"half_size"};
  EXPECT_EQ(runBatch(dataset, options, {}).size(), 2u);
  options.cases = {dataset.cases.front().id};
  EXPECT_EQ(runBatch(dataset, options, {}).front().case_id, dataset.cases.front().id);
}

TEST(RunBatch, GoesOnAfterABadImageOrSeed) {
  Dataset dataset = exampleDataset();
  dataset.cases.push_back(dataset.cases.front());
  dataset.cases.back().id = "sees nothing";
  dataset.cases.back().seed_camera_from_station.translation_m = {5.0, 0.0, 0.4};
  dataset.cases.front().image = dataset.cases.front().image.parent_path() / "missing.png";
  BatchOptions options = quick();
  options.reseeds = 1;
  const auto results = runBatch(dataset, options, {});
  ASSERT_EQ(results.size(), 6u);
  EXPECT_TRUE(results[0].inputFailed() && results[1].inputFailed());
  EXPECT_THAT(results[0].message, HasSubstr("missing.png"));
  EXPECT_FALSE(results[2].inputFailed());
  EXPECT_EQ(results[4].status, "bad_seed");
  EXPECT_THAT(results[4].message, HasSubstr("out of view"));
  EXPECT_FALSE(results[4].completed);
  EXPECT_EQ(results[4].success, false);
}

TEST(RunBatch, StopsBetweenRuns) {
  std::stop_source stop;
  BatchOptions options = quick();
  options.reseeds = 20;
  const auto results = runBatch(
      exampleDataset(), options,
      [&stop](std::size_t done, std::size_t, const RunResult&) {
        if (done == 2) stop.request_stop();
      },
      stop.get_token());
  EXPECT_EQ(results.size(), 2u);
}

TEST(RunBatch, Batch_WithoutReceiver_EndsAndKeepsNoPlan) {
  const Dataset dataset = exampleDataset();
  BatchOptions options = quick();
  options.reseeds = 20;
  options.jobs = 2;
  int told = 0;
  const auto refuse = [&told](std::size_t, std::size_t, const RunResult&) {
    ++told;
    throw std::runtime_error("the disk is full");
  };
  EXPECT_THROW(runPlanned(dataset, options, planBatch(dataset, options), refuse),
               std::runtime_error);
  EXPECT_LE(told, 2) << "one for each job, and none begins another";
}

TEST(RunBatch, SaysWhatEachStepDid) {
  const Dataset dataset = exampleDataset();
  BatchOptions options = quick();
  options.stations = {"bc"};
  options.keep_matches = true;
  const RunResult result = runBatch(dataset, options, {}).front();
  const RunStep& first = result.steps.at(0);
  EXPECT_EQ(first.kind, "match");
  EXPECT_EQ(first.details.size(), static_cast<std::size_t>(first.templates));
  ASSERT_TRUE(first.error.has_value());
  EXPECT_LT(first.error->lateral_mm, result.seed_error->lateral_mm);
  options.keep_matches = false;
  const RunResult brief = runBatch(dataset, options, {}).front();
  EXPECT_EQ(brief.digest, result.digest);
  EXPECT_EQ(brief.steps.size(), result.steps.size());
  EXPECT_TRUE(brief.steps.front().details.empty());
}

TEST(RunBatch, StepsOfASymmetricStation_AreMeasuredToTheNearestEquivalentTruth) {
  Dataset dataset = exampleDataset();
  Pose half_turn;
  half_turn.rotation = Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0);
  dataset.stations.at("os").symmetries.discrete = {half_turn};
  BatchOptions options = quick();
  options.stations = {"os"};
  const RunResult plain = runBatch(dataset, options, {}).front();
  for (Case& dataset_case : dataset.cases)
    *dataset_case.truth_camera_from_station = *dataset_case.truth_camera_from_station * half_turn;
  const RunResult turned = runBatch(dataset, options, {}).front();
  ASSERT_EQ(turned.digest, plain.digest);
  ASSERT_FALSE(turned.steps.empty());
  for (std::size_t i = 0; i < turned.steps.size(); ++i) {
    const PoseError& error = turned.steps[i].error.value();
    EXPECT_NEAR(error.lateral_mm, plain.steps[i].error->lateral_mm, 1e-6);
    EXPECT_NEAR(error.projection_px.value(), plain.steps[i].error->projection_px.value(), 1e-6);
    EXPECT_LT(error.lateral_mm, turned.seed_error->lateral_mm);
  }
}

TEST(PlanBatch, PutsEveryCaseInExactlyOneShardWithAllItsSeeds) {
  Dataset dataset = exampleDataset();
  const Case first = dataset.cases.front();
  for (int i = 0; i < 5; ++i) {
    dataset.cases.push_back(first);
    dataset.cases.back().id = "more-" + std::to_string(i);
  }
  BatchOptions options = quick();
  options.reseeds = 2;
  options.shards = 3;
  std::vector<int> seen(dataset.cases.size() * 3, 0);
  std::size_t smallest = seen.size();
  for (options.shard = 1; options.shard <= 3; ++options.shard) {
    const auto plan = planBatch(dataset, options);
    smallest = std::min(smallest, plan.size());
    for (const PlannedRun& run : plan) {
      EXPECT_EQ(&dataset.cases[static_cast<std::size_t>(run.dataset_index)], run.input);
      ++seen[static_cast<std::size_t>(3 * run.dataset_index + run.reseed)];
    }
  }
  EXPECT_THAT(seen, testing::Each(1));
  EXPECT_EQ(smallest, 6u) << "7 cases are 3, 2 and 2";
  options.shards = 100;
  options.shard = 100;
  EXPECT_TRUE(planBatch(dataset, options).empty());
}

TEST(DurationText, ReadsAsAWait) {
  EXPECT_EQ(durationText(0.4), "0 s");
  EXPECT_EQ(durationText(59.0), "59 s");
  EXPECT_EQ(durationText(59.7), "1 min");
  EXPECT_EQ(durationText(150.0), "3 min");
  EXPECT_EQ(durationText(3600.0), "1 h 00 min");
  EXPECT_EQ(durationText(2 * 3600.0 + 5 * 60.0 + 10.0), "2 h 05 min");
  EXPECT_EQ(durationText(24 * 3600.0), "1 day 0 h");
  EXPECT_EQ(durationText(76 * 3600.0), "3 days 4 h");
  EXPECT_EQ(durationText(-1.0), "?");
}

TEST(BatchProgressText, TellsRateAndTimeLeft) {
  EXPECT_EQ(batchProgressText(0, 40, 0, 3.0), "0 of 40 runs, 0 completed");
  EXPECT_EQ(batchProgressText(12, 40, 11, 60.0),
            "12 of 40 runs, 11 completed, 720 an hour, 2 min left");
  EXPECT_EQ(batchProgressText(40, 40, 38, 200.0), "40 of 40 runs, 38 completed, 720 an hour");
}

}  // namespace
}  // namespace boresight::sessions
