// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "sessions/io/files/file_bytes.h"
#include "sessions/session/session.h"

namespace boresight::test {

/// A converged run of a case that does not exist on the disk.
inline sessions::RunRecord runWithoutFile(const std::string& case_id, std::int64_t number) {
  sessions::RunRecord run;
  run.case_id = case_id;
  run.digest = sessions::sha256Text(case_id + " " + std::to_string(number));
  run.file = "/runs/" + run.digest + ".trace";
  run.status = "converged";
  run.version = "2.0.0";
  run.time = "2026-01-31T23:59:59Z";
  run.inputs_sha256 = run.options_sha256 = run.digest;
  return run;
}

/// Cases "case-0", "case-1", ... with the inputs of the session's cases in turn, each with a seed
/// and a run of its own.
inline sessions::Session manyCases(const sessions::Session& few, std::int64_t count) {
  sessions::Session many = few;
  many.cases.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    sessions::SessionCase session_case = *few.cases[static_cast<std::size_t>(i) % few.cases.size()];
    session_case.id = "case-" + std::to_string(i);
    session_case.camera_from_station_seed.translation_m.x() += 1e-7 * static_cast<double>(i);
    many.cases.push_back(session_case);
    many.runs.push_back(runWithoutFile(session_case.id, 0));
  }
  return many;
}

}  // namespace boresight::test
