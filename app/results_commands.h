// SPDX-License-Identifier: Apache-2.0
// The subcommands that work on results of `whs evaluate`.
#pragma once

#include <CLI/CLI.hpp>

namespace boresight::app {

void addMerge(CLI::App& app, int& exit_code);
void addTables(CLI::App& app, int& exit_code);

}  // namespace boresight::app
