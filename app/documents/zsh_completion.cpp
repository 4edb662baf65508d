// SPDX-License-Identifier: Apache-2.0
#include "app/documents/completions.h"

namespace boresight::documents {
namespace {

/// A part of a specification of _arguments, within single quotes of the shell.
std::string part(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
    safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return safe;
}

std::string action(const Argument& argument) {
  if (argument.takesFolder()) return "_files -/";
  if (argument.takesPath()) return "_files";
  if (argument.choices.empty()) return " ";
  std::string text = "(";
  for (const std::string& choice : argument.choices)
    text += (text.size() > 1 ? " " : "") + part(choice);
  return text + ")";
}

std::string specifications(const Argument& argument, const std::string& indent) {
  if (argument.isPositional())
    return indent + "'" + (argument.repeats ? "*" : "") + ":" + part(argument.position) + ":" +
           action(argument) + "' \\\n";
  const std::string value =
      argument.value.empty() ? "" : ":" + part(argument.value) + ":" + action(argument);
  std::string text;
  for (const std::string& name : argument.names)
    text += indent + "'" + (argument.repeats ? "*" : "") + name + "[" +
            part(firstSentence(argument.help)) + "]" + value + "' \\\n";
  return text;
}

std::string allSpecifications(const Program& program, const std::string& indent) {
  std::string text;
  for (const Argument& argument : program.arguments) text += specifications(argument, indent);
  return text;
}

/// _arguments ends without a further line.
std::string ended(std::string text) {
  text.erase(text.size() - 3);  // " \", newline
  return text + "\n";
}

std::string commandCases(const Program& program) {
  std::string text;
  for (const Program& command : program.commands)
    text += "        " + command.name + ")\n" +
            ended("          _arguments \\\n" + allSpecifications(command, "            ")) +
            "          ;;\n";
  return text;
}

std::string commandList(const Program& program) {
  std::string text = "      local -a commands=(\n";
  for (const Program& command : program.commands)
    text += "        '" + command.name + ":" + part(firstSentence(command.help)) + "'\n";
  return text + "      )\n      _describe command commands\n";
}

}  // namespace

std::string zshCompletion(const Program& program) {
  std::string text = "#compdef " + program.name + "\n_" + program.name + "() {\n";
  if (program.commands.empty()) {
    text += ended("  _arguments \\\n" + allSpecifications(program, "    ")) + "}\n";
  } else {
    text += "  local state\n  _arguments -C \\\n" + allSpecifications(program, "    ") +
            "    '1: :->command' \\\n    '*:: :->rest'\n"
            "  case $state in\n    command)\n" +
            commandList(program) + "      ;;\n    rest)\n      case $words[1] in\n" +
            commandCases(program) + "      esac\n      ;;\n  esac\n}\n";
  }
  return text + "_" + program.name + " \"$@\"\n";
}

}  // namespace boresight::documents
