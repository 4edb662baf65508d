// SPDX-License-Identifier: Apache-2.0
#include "app/describe_cli.h"

#include <string_view>

namespace boresight::app {
namespace {

using documents::Argument;
using documents::Program;

std::vector<std::string> splitAt(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
  }
  return parts;
}

/// "INT in [1 - 256]" as CLI11 words a range.
std::string rangeText(const std::string& check) {
  const std::size_t open = check.find(" in [");
  const std::size_t dash = check.find(" - ");
  if (open == std::string::npos || dash == std::string::npos) return {};
  const std::size_t first = open + std::string_view(" in [").size();
  const std::string last = check.substr(dash + 3);
  return check.substr(first, dash - first) + " to " + last.substr(0, last.find(']'));
}

/// CLI11 has the checks of a value in its type: "N:INT in [1 - 256]", "TEXT:{pdf,svg}".
void describeValue(const std::string& type, Argument& argument) {
  const std::vector<std::string> parts = splitAt(type, ':');
  argument.value = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string& check = parts[i];
    if (check.size() > 2 && check.front() == '{' && check.back() == '}') {
      argument.choices = splitAt(check.substr(1, check.size() - 2), ',');
    } else {
      argument.limits = rangeText(check);
    }
  }
}

Argument describe(const CLI::Option& option) {
  Argument argument;
  for (const std::string& name : option.get_snames()) argument.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) argument.names.push_back("--" + name);
  if (argument.names.empty()) argument.position = option.get_single_name();
  const bool is_switch = option.get_items_expected_max() == 0;
  if (!is_switch) describeValue(option.get_type_name(), argument);
  argument.help = option.get_description();
  argument.fallback = option.get_default_str();
  argument.required = option.get_required();
  argument.repeats = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  return argument;
}

}  // namespace

Program describe(const CLI::App& app) {
  Program program;
  program.name = app.get_name();
  program.help = app.get_description();
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) program.arguments.push_back(describe(*option));
  for (const CLI::App* part : app.get_subcommands([](const CLI::App*) { return true; })) {
    const bool is_group = part->get_name().empty();
    if (!is_group && part->get_group().empty()) continue;
    Program command = describe(*part);
    if (is_group) {
      program.arguments.insert(program.arguments.end(), command.arguments.begin(),
                               command.arguments.end());
    } else {
      program.commands.push_back(std::move(command));
    }
  }
  return program;
}

}  // namespace boresight::app
