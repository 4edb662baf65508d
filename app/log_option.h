// SPDX-License-Identifier: Apache-2.0
// The log of both programs.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace boresight::app {

/// Adds --log-level to a program or to one of its commands, where its help does not repeat it.
CLI::Option* addLogLevel(CLI::App& app);

/// Starts the log in the user's state folder, at the level of --log-level, with the program's
/// version and command line. No error when it cannot be written.
void beginLog(const std::string& program);
/// The last line.
void endLog(const std::string& program, int exit_code);

}  // namespace boresight::app
