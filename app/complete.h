// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace boresight::app {

/// What a shell offers for the last of the words after the program's name: commands, options of the
/// command, or the choices of the option before. Nothing for files, which shells know themselves.
std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace boresight::app
