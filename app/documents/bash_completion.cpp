// SPDX-License-Identifier: Apache-2.0
#include "app/documents/completions.h"

namespace boresight::documents {
namespace {

/// Within single quotes.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + safe + "'";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> optionNames(const Program& program) {
  std::vector<std::string> names;
  for (const Argument& argument : program.arguments)
    names.insert(names.end(), argument.names.begin(), argument.names.end());
  return names;
}

/// What stands after an option: choices, a file (left to the shell, which knows spaces and
/// folders), or something that nobody can guess.
std::string afterOption(const Argument& argument) {
  if (!argument.choices.empty())
    return "COMPREPLY=($(compgen -W " + quoted(joined(argument.choices)) + " -- \"$current\")); ";
  return argument.takesPath() ? "" : "compopt +o default 2>/dev/null; ";
}

std::string valueCases(const Program& program, const std::string& command) {
  std::string text;
  for (const Argument& argument : program.arguments) {
    if (argument.isPositional() || argument.value.empty()) continue;
    std::string patterns;
    for (const std::string& name : argument.names)
      patterns += (patterns.empty() ? "" : "|") + quoted(command + " " + name);
    text += "    " + patterns + ") " + afterOption(argument) + "return ;;\n";
  }
  return text;
}

std::string wordCases(const Program& program) {
  std::string text;
  for (const Program& command : program.commands)
    text +=
        "    " + quoted(command.name) + ") words=" + quoted(joined(optionNames(command))) + " ;;\n";
  return text + "    *) words=" + quoted(joined(optionNames(program))) + " ;;\n";
}

std::string commandWords(const Program& program) {
  std::vector<std::string> names;
  for (const Program& command : program.commands) names.push_back(command.name);
  return joined(names);
}

std::string functionName(const Program& program) { return "_" + program.name + "_completion"; }

/// Sets `command` to the command that stands on the line before the cursor.
std::string findCommand(const Program& program) {
  return "  local commands=" + quoted(commandWords(program)) +
         "\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    case \" $commands \" in *\" $word \"*) command=$word; break ;; esac\n"
         "  done\n";
}

}  // namespace

std::string bashCompletion(const Program& program) {
  std::string text = "# Completion of " + program.name + " in bash.\n" + functionName(program) +
                     "() {\n"
                     "  local current=${COMP_WORDS[COMP_CWORD]} command= word words\n"
                     "  local previous=${COMP_WORDS[COMP_CWORD-1]}\n"
                     "  COMPREPLY=()\n";
  if (!program.commands.empty()) text += findCommand(program);
  text += "  case \"$command $previous\" in\n" + valueCases(program, "");
  for (const Program& command : program.commands) text += valueCases(command, command.name);
  text += "  esac\n  case $command in\n" + wordCases(program) + "  esac\n";
  if (!program.commands.empty()) {
    text +=
        "  if [[ -z $command && $current != -* ]]; then\n"
        "    COMPREPLY=($(compgen -W \"$commands\" -- \"$current\"))\n"
        "    return\n"
        "  fi\n";
  }
  text +=
      "  [[ $current == -* ]] && COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "  return 0\n"
      "}\n"
      "complete -o default -F " +
      functionName(program) + " " + program.name + "\n";
  return text;
}

}  // namespace boresight::documents
