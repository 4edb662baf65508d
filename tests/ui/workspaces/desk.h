// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/record/record_writer.h"
#include "sessions/run/runner.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"

namespace boresight::test {

/// An example with a run of its first case, and the onboard record of the same run.
struct Desk {
  sessions::Session session;
  sessions::LocalizationTrace trace;
  std::vector<std::uint8_t> record = std::vector<std::uint8_t>(65536);

  explicit Desk(const char* example) {
    const auto file = std::filesystem::path(BORESIGHT_EXAMPLES) / example;
    session = sessions::SessionDocument::open(file, sessions::Access::kReadOnly).session();
    const auto loaded = sessions::loadCase(*session.cases.front());
    RecordWriter writer(record);
    sessions::RunSettings settings;
    settings.onboard_record = &writer;
    const sessions::RunPlan plan(sessions::caseOptions(session, *session.cases.front(), {}));
    trace = sessions::localize(loaded->problem(), plan, settings);
    record.resize(writer.bytes().size());
  }
  /// Annotated, and with a result.
  static const Desk& converged() {
    static const Desk desk("annotated.boresight.json");
    return desk;
  }
  /// Its seed is turned by 40 deg, where 2.2 deg are stated.
  static const Desk& failed() {
    static const Desk desk("turned.boresight.json");
    return desk;
  }
  /// The session with its run, whose trace lies next to this file.
  sessions::Session withItsRun(const std::filesystem::path& session_file) const {
    const std::string& id = session.cases.front()->id;
    return sessions::withRun(session, sessions::storeRun(session, id, trace, session_file));
  }
};

}  // namespace boresight::test
