// SPDX-License-Identifier: Apache-2.0
// Options of the programs' command lines.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace boresight::app {

/// Adds an option, or a positional argument; the help calls its value `type`, e.g. "ID".
template <class Value>
CLI::Option* addOption(CLI::App& command, const std::string& name, const std::string& type,
                       Value& value, const std::string& help) {
  return command.add_option(name, value, help)->type_name(type);
}

/// Adds an option whose value is the name of a file.
template <class Value>
CLI::Option* addFile(CLI::App& command, const std::string& name, Value& value,
                     const std::string& help) {
  return addOption(command, name, "FILE", value, help);
}

/// Adds an option that accepts only `choices`; a list accepts several. The help shows its default.
template <class Value>
CLI::Option* addChoice(CLI::App& command, const std::string& name, Value& value,
                       const std::vector<std::string>& choices, const std::string& help) {
  return command.add_option(name, value, help)
      ->check(CLI::IsMember(choices))
      ->capture_default_str();
}

}  // namespace boresight::app
