// SPDX-License-Identifier: Apache-2.0
#include "app/documents/markdown_page.h"

#include <set>
#include <string_view>

namespace boresight::documents {
namespace {

/// A help text as a sentence.
std::string sentence(const std::string& help) {
  if (help.empty() || help.back() == '.') return help;
  return help + ".";
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string title(const Argument& argument) {
  if (argument.isPositional()) return argument.position;
  const std::string names = joined(argument.names);
  return argument.value.empty() ? names : names + " " + argument.value;
}

std::string remarks(const Argument& argument) {
  std::string text;
  if (!argument.choices.empty()) text += " One of: " + joined(argument.choices) + ".";
  if (!argument.limits.empty()) text += " Value: " + argument.limits + ".";
  if (!argument.fallback.empty()) text += " Default: " + argument.fallback + ".";
  if (argument.required && !argument.isPositional()) text += " Required.";
  if (argument.repeats && argument.help.find("may be repeated") == std::string::npos)
    text += " May be repeated.";
  return text;
}

std::string argumentTable(const Program& program) {
  std::string text = "\n| option | meaning |\n|---|---|\n";
  std::set<std::string> told;  // groups of options repeat --help
  for (const Argument& argument : program.arguments) {
    if (!told.insert(title(argument)).second) continue;
    text += "| `" + title(argument) + "` | " +
            markdownText(sentence(argument.help) + remarks(argument)) + " |\n";
  }
  return program.arguments.empty() ? "" : text;
}

std::string synopsis(const Program& program, const std::string& name) {
  std::string text = name;
  bool optional = false;
  for (const Argument& argument : program.arguments) {
    if (argument.isPositional()) continue;
    if (argument.required) text += " " + argument.names.back() + " " + argument.value;
    optional = optional || !argument.required;
  }
  if (optional) text += " [option ...]";
  if (!program.commands.empty()) text += " command ...";
  for (const Argument& argument : program.arguments) {
    if (!argument.isPositional()) continue;
    const std::string one = argument.position + (argument.repeats ? " ..." : "");
    text += argument.required ? " " + one : " [" + one + "]";
  }
  return "\n`" + text + "`\n";
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

std::string markdownPage(const Program& program) {
  std::string text = "# " + program.name + ", command by command\n\n";
  if (program.commands.empty()) text = "# " + program.name + " on the command line\n\n";
  text += markdownText(sentence(program.help)) + "\n";
  if (!program.exit_status.empty())
    text += "\nExit status: " + markdownText(program.exit_status) + "\n";
  text += synopsis(program, program.name) + argumentTable(program);
  if (!program.commands.empty()) text += "\n| command | what it does |\n|---|---|\n";
  for (const Program& command : program.commands)
    text += "| [" + program.name + " " + command.name + "](#" + program.name + "-" + command.name +
            ") | " + markdownText(sentence(command.help)) + " |\n";
  for (const Program& command : program.commands) {
    const std::string name = program.name + " " + command.name;
    text += "\n## " + name + "\n\n" + markdownText(sentence(command.help)) + "\n" +
            synopsis(command, name) + argumentTable(command);
  }
  return text;
}

}  // namespace boresight::documents
