// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace boresight::app {

/// Escapes text so that Markdown shows it unchanged, also in a table cell.
std::string markdownText(const std::string& text);

/// Description of a command, and a table of its options, including those of its groups.
std::string commandText(const CLI::App& command);

/// Writes pages of the manual, by file name ("options.md"), into a folder that is created if
/// needed. Returns the exit status; an error is printed to stderr as one line.
int writePages(const std::filesystem::path& folder,
               const std::map<std::string, std::string>& pages);

}  // namespace boresight::app
