// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"

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
  run.error = sessions::PoseError{};
  run.error->normal_mm = normal_mm;
  run.error->lateral_mm = lateral_mm;
  run.error->rotation_mrad = rotation_mrad;
  run.seed_error = sessions::PoseError{};
  run.seed_error->normal_mm = 3.0;
  run.seed_error->lateral_mm = 4.0;
  run.seed_error->geodesic_mrad = 20.0;
  run.requirement = sessions::Requirement{0.4, 0.4, 0.25, std::nullopt};
  run.digest = case_id + method;
  sessions::judge(false, run);
  return run;
}

inline std::vector<const sessions::RunResult*> pointersTo(
    const std::vector<sessions::RunResult>& runs) {
  std::vector<const sessions::RunResult*> pointers;
  for (const sessions::RunResult& run : runs) pointers.push_back(&run);
  return pointers;
}

}  // namespace boresight::test
