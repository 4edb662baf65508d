// SPDX-License-Identifier: Apache-2.0
#include "app/documents/manual_page.h"

#include <algorithm>
#include <cctype>

namespace boresight::documents {
namespace {

/// Text that roff shows as it is: hyphens stay hyphens, and no line is taken for a macro.
std::string shown(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) {
      safe += std::string("\\&") + c;
    } else {
      safe += c;
    }
  }
  return safe;
}

/// As the argument of a macro.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : shown(text)) safe += c == '"' ? std::string("\\(dq") : std::string(1, c);
  return "\"" + safe + "\"";
}

std::string bold(const std::string& text) { return "\\fB" + shown(text) + "\\fR"; }
std::string slanted(const std::string& text) { return "\\fI" + shown(text) + "\\fR"; }

/// A help text as a sentence.
std::string sentence(const std::string& help) {
  if (help.empty() || help.back() == '.') return help;
  return help + ".";
}

std::string upperCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string titleLine(const Argument& argument) {
  if (argument.isPositional()) return slanted(argument.position);
  std::string line;
  for (const std::string& name : argument.names) line += (line.empty() ? "" : ", ") + bold(name);
  return argument.value.empty() ? line : line + " " + slanted(argument.value);
}

std::string remarks(const Argument& argument) {
  std::string text;
  if (!argument.choices.empty()) {
    text += " One of:";
    for (const std::string& choice : argument.choices)
      text += (&choice == &argument.choices.front() ? " " : ", ") + choice;
    text += ".";
  }
  if (!argument.limits.empty()) text += " Value: " + argument.limits + ".";
  if (!argument.fallback.empty()) text += " Default: " + argument.fallback + ".";
  if (argument.required && !argument.isPositional()) text += " Required.";
  if (argument.repeats) text += " May be repeated.";
  return text;
}

std::string argumentList(const Program& program) {
  std::string text;
  for (const Argument& argument : program.arguments)
    text += ".TP\n" + titleLine(argument) + "\n" +
            shown(sentence(argument.help) + remarks(argument)) + "\n";
  return text;
}

std::string synopsis(const Program& program, const std::string& title) {
  std::string text = bold(title);
  bool optional = false;
  for (const Argument& argument : program.arguments) {
    if (argument.isPositional()) continue;
    if (argument.required) {
      text += " " + titleLine(argument);
    } else {
      optional = true;
    }
  }
  if (optional) text += " [" + slanted("option") + " ...]";
  if (!program.commands.empty()) text += " " + slanted("command") + " ...";
  for (const Argument& argument : program.arguments) {
    if (!argument.isPositional()) continue;
    const std::string one = slanted(argument.position) + (argument.repeats ? " ..." : "");
    text += argument.required ? " " + one : " [" + one + "]";
  }
  return text;
}

/// The page of a program, or of a command of `parent`.
ManualPage page(const Program& program, const Program* parent, const std::string& version) {
  const std::string name = (parent != nullptr ? parent->name + "-" : "") + program.name;
  const std::string title = (parent != nullptr ? parent->name + " " : "") + program.name;
  std::string text = ".TH " + quoted(upperCase(name)) + " 1 \"\" " +
                     quoted("Boresight " + version) + " \"User Commands\"\n";
  text += ".SH NAME\n" + shown(name) + " \\- " + shown(firstSentence(program.help)) + "\n";
  text += ".SH SYNOPSIS\n" + synopsis(program, title) + "\n";
  text += ".SH DESCRIPTION\n" + shown(sentence(program.help)) + "\n";
  if (!program.commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const Program& command : program.commands)
      text += ".TP\n" + bold(title + " " + command.name) + "\n" + shown(sentence(command.help)) +
              " See " + bold(name + "-" + command.name) + "(1).\n";
  }
  if (!program.arguments.empty()) text += ".SH OPTIONS\n" + argumentList(program);
  const std::string& status = parent != nullptr ? parent->exit_status : program.exit_status;
  if (!status.empty()) text += ".SH EXIT STATUS\n" + shown(status) + "\n";
  text += ".SH SEE ALSO\n" +
          bold(parent != nullptr ? parent->name
               : name == "whs"   ? "boresight"
                                 : "whs") +
          "(1)\n.PP\nThe manual, task by task: Help > Manual in boresight.\n";
  return {name + ".1", text};
}

}  // namespace

std::vector<ManualPage> manualPages(const Program& program, const std::string& version) {
  std::vector<ManualPage> pages = {page(program, nullptr, version)};
  for (const Program& command : program.commands) pages.push_back(page(command, &program, version));
  return pages;
}

}  // namespace boresight::documents
