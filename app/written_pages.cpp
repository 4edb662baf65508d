// SPDX-License-Identifier: Apache-2.0
#include "app/written_pages.h"

#include <fstream>
#include <iostream>
#include <set>
#include <string_view>

#include "app/exit_codes.h"

namespace boresight::app {
namespace {

/// A row for every option and positional argument of a command and its groups, each once.
std::string optionRows(const CLI::App& command, std::set<std::string>& listed) {
  const CLI::Formatter formatter;
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = formatter.make_option_name(option, option->get_positional());
    if (option->get_group().empty() || !listed.insert(name).second) continue;
    text += "| `" + name + formatter.make_option_opts(option) + "` | " +
            markdownText(option->get_description()) + " |\n";
  }
  for (const CLI::App* group : command.get_subcommands({}))
    if (group->get_name().empty()) text += optionRows(*group, listed);
  return text;
}

}  // namespace

std::string markdownText(const std::string& text) {
  constexpr std::string_view kMeant = "\\|<*`[_";
  std::string safe;
  for (const char c : text) {
    if (kMeant.find(c) != std::string_view::npos) safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe;
}

std::string commandText(const CLI::App& command) {
  std::set<std::string> listed;
  const std::string help = command.get_description();
  return markdownText(help) + (help.ends_with('.') ? "" : ".") +
         "\n\n| option | meaning |\n|---|---|\n" + optionRows(command, listed);
}

int writePages(const std::filesystem::path& folder,
               const std::map<std::string, std::string>& pages) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const auto& [name, text] : pages) {
    std::ofstream stream(folder / name, std::ios::binary | std::ios::trunc);
    stream << text;
    stream.close();
    if (stream) continue;
    std::cerr << (folder / name).string() << ": cannot be written\n";
    return kBadInput;
  }
  return kDone;
}

}  // namespace boresight::app
