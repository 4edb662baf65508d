// SPDX-License-Identifier: Apache-2.0
// Made-up results, for tests of what is done with results.
#pragma once

#include <string>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"

namespace boresight::test {

inline sessions::DatasetFacts sampleDataset() { return {"/data/dataset.json", "d1", 3, "1.0"}; }

inline sessions::MethodFacts sampleMethod(const std::string& method) {
  sessions::MethodFacts facts;
  facts.method = method;
  facts.profile = "default";
  facts.options = "{\"pnp.seed\":7}";
  facts.options_sha256 = "o1";
  return facts;
}

inline sessions::RunResult sampleRun(const std::string& case_id = "bc-1",
                                     std::int64_t dataset_index = 0, std::int32_t reseed = 2,
                                     const std::string& method = "whs") {
  sessions::RunResult run;
  run.case_id = case_id;
  run.dataset_index = dataset_index;
  run.reseed = reseed;
  run.station = case_id.substr(0, 2);
  run.method = method;
  run.status = "converged";
  run.message = "it's \"quoted\"";
  run.tags = {"far", "low_sun"};
  run.completed = true;
  run.success = true;
  run.matches = 96;
  run.inliers = 88;
  run.edge_support = 0.5;
  run.error = sessions::PoseError{};
  run.error->lateral_mm = 0.25;
  run.requirement = sessions::Requirement{};
  run.requirement->normal_mm = 0.4;
  run.seconds.matching = 1.5;
  run.digest = "abc";
  return run;
}

}  // namespace boresight::test
