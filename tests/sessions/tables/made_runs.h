// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/tables/table.h"

namespace boresight::test {

/// A run with these errors and the requirement 0.4 mm, 0.4 mm, 0.25 deg (4.363 mrad).
inline sessions::RunResult madeRun(const std::string& case_id, const std::string& method,
                                   bool completed = true, double normal_mm = 0.0,
                                   double lateral_mm = 0.0, double rotation_mrad = 0.0) {
  sessions::RunResult run;
  run.case_id = case_id;
  run.station = case_id.substr(0, 2);
  run.method = method;
  run.status = completed ? "converged" : "pnp_failed";
  run.completed = completed;
  run.error = {normal_mm, lateral_mm, rotation_mrad, 0.0, 0.0, std::nullopt};
  run.seed_error = {3.0, 4.0, 0.0, 0.0, 20.0, std::nullopt};
  run.requirement = sessions::Requirement{0.4, 0.4, 0.25, std::nullopt};
  run.digest = case_id + method;
  sessions::judge(false, run);
  return run;
}

/// A run without the truth of its case.
inline sessions::RunResult blindRun(const std::string& case_id) {
  sessions::RunResult run = madeRun(case_id, "whs");
  run.error.reset();
  run.seed_error.reset();
  run.success.reset();
  return run;
}

inline std::string csvOf(const sessions::Table& table) {
  return tableText(table, sessions::TableFormat::kCsv);
}

inline std::vector<const sessions::RunResult*> pointersTo(
    const std::vector<sessions::RunResult>& runs) {
  std::vector<const sessions::RunResult*> pointers;
  for (const sessions::RunResult& run : runs) pointers.push_back(&run);
  return pointers;
}

}  // namespace boresight::test
