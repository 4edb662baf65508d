// SPDX-License-Identifier: Apache-2.0
#include "app/complete.h"

#include <algorithm>
#include <sstream>

namespace boresight::app {
namespace {

/// "pdf", "svg" of an option's type "TEXT:{pdf,svg}".
std::vector<std::string> choicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  std::vector<std::string> choices;
  if (open == std::string::npos) return choices;
  std::istringstream list(type.substr(open + 1, type.find('}') - open - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

/// The option of the command, or of one of its groups, with this name.
const CLI::Option* findOption(const CLI::App& command, const std::string& name) {
  return name.starts_with("-") ? command.get_option_no_throw(name) : nullptr;
}

void addOptionNames(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
    if (group->get_name().empty()) addOptionNames(*group, names);
}

/// Every word that may follow, whatever its beginning.
std::vector<std::string> candidates(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> found;
  if (words.size() <= 1 && (words.empty() || !words.back().starts_with("-"))) {
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      if (!command->get_group().empty()) found.push_back(command->get_name());
    return found;
  }
  const auto named = app.get_subcommands(
      [&words](const CLI::App* command) { return command->get_name() == words.front(); });
  if (words.size() > 1 && named.empty()) return found;
  const CLI::App* command = words.size() > 1 ? named.front() : &app;
  if (words.size() > 2)
    if (const CLI::Option* option = findOption(*command, words[words.size() - 2]))
      if (option->get_items_expected_max() > 0) return choicesOf(*option);
  if (words.back().starts_with("-")) addOptionNames(*command, found);
  return found;
}

}  // namespace

std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> found = candidates(app, words);
  const std::string begin = words.empty() ? "" : words.back();
  std::erase_if(found, [&begin](const std::string& word) { return !word.starts_with(begin); });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace boresight::app
