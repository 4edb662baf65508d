// SPDX-License-Identifier: Apache-2.0
#include "app/log_option.h"

#include <algorithm>
#include <string>

#include "app/add_option.h"
#include "app/batch_output.h"
#include "sessions/log/program_log.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

std::string& logLevel() {
  static std::string level = "info";
  return level;
}

}  // namespace

CLI::Option* addLogLevel(CLI::App& app) {
  return addChoice(app, "--log-level", logLevel(),
                   {sessions::kLogLevelNames.begin(), sessions::kLogLevelNames.end()},
                   "Log in ~/.local/state/boresight: nothing, messages, also runs and files "
                   "written, also files read");
}

void beginLog(const std::string& program) {
  const auto found = std::ranges::find(sessions::kLogLevelNames, logLevel());
  sessions::startLog(sessions::userLogFile(),
                     static_cast<sessions::LogLevel>(found - sessions::kLogLevelNames.begin()));
  sessions::logEvent(sessions::LogLevel::kInfo, [&program] {
    return program + " " + sessions::kVersion + " begins: " + typedCommand();
  });
}

void endLog(const std::string& program, int exit_code) {
  sessions::logEvent(sessions::LogLevel::kInfo, [&] {
    return program + " ends with exit status " + std::to_string(exit_code);
  });
}

}  // namespace boresight::app
