// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"

namespace boresight::test {

/// A station of the example that ships, as the desktop program holds a case.
inline std::shared_ptr<const sessions::LoadedCase> loadedExample(const std::string& station) {
  const sessions::Session session = sessions::makeSession(exampleFolder() / "dataset.json");
  for (const auto& session_case : session.cases) {
    if (session_case->station == station) return sessions::loadCase(*session_case);
  }
  return nullptr;
}

}  // namespace boresight::test
