// SPDX-License-Identifier: Apache-2.0
// What a program says of its own command line, whichever library reads it: the source of manual
// pages and completions, so that these know every option that the program knows.
#pragma once

#include <string>
#include <vector>

namespace boresight::documents {

/// An option, or a positional argument.
struct Argument {
  std::vector<std::string> names;    ///< "-v", "--version"; none: a positional argument
  std::string position;              ///< the name of a positional argument, "session"
  std::string value;                 ///< what stands after or for it, "FILE"; "" for a switch
  std::vector<std::string> choices;  ///< the values that there are; empty: others, too
  std::string limits;                ///< of the value, for people: "1 to 256", or ""
  std::string fallback;              ///< the value without the option, or ""
  std::string help;
  bool required = false;
  bool repeats = false;

  bool isPositional() const { return names.empty(); }
  /// By what stands after it.
  bool takesPath() const;
  bool takesFolder() const { return value == "DIR" || value == "FOLDER"; }
};

/// A program, or one of its commands.
struct Program {
  std::string name;  ///< "whs", "localize"
  std::string help;
  std::string exit_status;  ///< what the exit status says, or ""
  std::vector<Argument> arguments;
  std::vector<Program> commands;
};

/// The first sentence of a help text, without its stop, for places with a single line.
std::string firstSentence(const std::string& help);

}  // namespace boresight::documents
