// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace boresight::app {

/// Text that a Markdown reader shows unchanged, also in a table cell.
std::string markdownText(const std::string& text);

/// What a command does, and a table of its options, those of its groups included.
std::string commandText(const CLI::App& command);

/// Writes pages of the manual, by file name ("options.md"), into a folder that is made if needed.
/// The exit status; an error is printed to stderr as one line.
int writePages(const std::filesystem::path& folder,
               const std::map<std::string, std::string>& pages);

}  // namespace boresight::app
