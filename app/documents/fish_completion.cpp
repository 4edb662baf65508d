// SPDX-License-Identifier: Apache-2.0
#include "app/documents/completions.h"

namespace boresight::documents {
namespace {

std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'' || c == '\\') safe += '\\';
    safe += c;
  }
  return "'" + safe + "'";
}

std::string nameFlags(const Argument& argument) {
  std::string flags;
  for (const std::string& name : argument.names)
    flags += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return flags;
}

/// -r: a value stands after it, a file unless -x says that it is none.
std::string valueFlags(const Argument& argument) {
  if (argument.value.empty()) return "";
  if (argument.takesPath()) return " -r -F";
  std::string choices;
  for (const std::string& choice : argument.choices)
    choices += (choices.empty() ? "" : " ") + choice;
  return choices.empty() ? " -x" : " -x -a " + quoted(choices);
}

std::string lines(const Program& program, const std::string& begin) {
  std::string text;
  for (const Argument& argument : program.arguments) {
    if (argument.isPositional()) continue;
    text += begin + nameFlags(argument) + valueFlags(argument) + " -d " +
            quoted(firstSentence(argument.help)) + "\n";
  }
  return text;
}

}  // namespace

std::string fishCompletion(const Program& program) {
  const std::string begin = "complete -c " + program.name;
  std::string text = "# Completion of " + program.name + " in fish.\n";
  if (program.commands.empty()) return text + lines(program, begin);
  const std::string first = begin + " -n __fish_use_subcommand";
  text += lines(program, first);
  for (const Program& command : program.commands) {
    text += first + " -f -a " + command.name + " -d " + quoted(firstSentence(command.help)) + "\n";
    text += lines(command, begin + " -n " + quoted("__fish_seen_subcommand_from " + command.name));
  }
  return text;
}

}  // namespace boresight::documents
