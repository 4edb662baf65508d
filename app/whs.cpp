// SPDX-License-Identifier: Apache-2.0
// whs: localization without a window.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>
#include <string_view>

#include "app/batch_output.h"
#include "app/commands.h"
#include "app/plain_output.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/matching_method.h"
#include "sessions/text/plain_text.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

/// "--image and --overlay": the options of a command, and of its groups, that name this file by any
/// of its links.
std::string optionsNaming(const CLI::App& command, const std::filesystem::path& file) {
  std::string names;
  const auto add = [&names](const std::string& name) {
    if (!name.empty()) names += (names.empty() ? "" : " and ") + name;
  };
  std::error_code error;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& value : option->results())
      if (std::filesystem::equivalent(value, file, error)) add(option->get_name());
  for (const CLI::App* group : command.get_subcommands({})) add(optionsNaming(*group, file));
  return names;
}

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

void addOptionNames(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const CLI::App* group : command.get_subcommands({}))
    if (group->get_name().empty()) addOptionNames(*group, names);
}

/// Every word that may follow, regardless of the letters typed so far.
std::vector<std::string> candidates(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> found;
  if (words.size() <= 1 && (words.empty() || !words.back().starts_with("-"))) {
    for (const CLI::App* command : app.get_subcommands({}))
      if (!command->get_group().empty()) found.push_back(command->get_name());
    return found;
  }
  const auto named = app.get_subcommands(
      [&words](const CLI::App* command) { return command->get_name() == words.front(); });
  if (words.size() > 1 && named.empty()) return found;
  const CLI::App* command = words.size() > 1 ? named.front() : &app;
  if (words.size() > 2 && words[words.size() - 2].starts_with("-"))
    if (const CLI::Option* option = command->get_option_no_throw(words[words.size() - 2]))
      if (option->get_items_expected_max() > 0) return choicesOf(*option);
  if (words.back().starts_with("-")) addOptionNames(*command, found);
  return found;
}

/// What a shell offers for the last of the words after the program's name: commands, options of the
/// command, or the choices of the option before. Nothing for files, which shells complete
/// themselves.
std::vector<std::string> completions(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> found = candidates(app, words);
  const std::string begin = words.empty() ? "" : words.back();
  std::erase_if(found, [&begin](const std::string& word) { return !word.starts_with(begin); });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

int run(int argc, char** argv) {
  CLI::App app("Localizes a camera relative to a known object by render and compare.", "whs");
  app.set_version_flag("--version", std::string("whs ") + sessions::kVersion);
  app.set_help_all_flag("--help-all", "Help of every subcommand");
  addLogLevel(app);
  app.require_subcommand(1);
  app.footer(std::string("Exit status: ") + kExitStatusText);
  app.failure_message([](const CLI::App* parsed, const CLI::Error& error) {
    const std::string what = sessions::plainText(error.what());
    return CLI::FailureMessage::simple(parsed, {error.get_name(), what, error.get_exit_code()});
  });
  int exit_code = kDone;
  for (AddCommand* add :
       {addLocalize, addEvaluate, addMerge,     addTables, addCompare,   addCheck,   addDecide,
        addVerify,   addViews,    addReport,    addQueue,  addSolve,     addRender,  addCamera,
        addInfo,     addOptions,  addNew,       addRun,    addPack,      addExport,  addImport,
        addProblem,  addBench,    addDocuments, addTrends, addCalibrate, addHandEye, addFollow})
    add(app, exit_code);
  for (CLI::App* command : app.get_subcommands({}))
    command->set_version_flag("--version", std::string("whs ") + sessions::kVersion);
  if (argc > 1 && std::string_view(argv[1]) == "--complete") {  // what completions of shells call
    for (const std::string& word : completions(app, {argv + 2, argv + argc}))
      std::cout << word << "\n";
    return kDone;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    app.exit(error, std::cout, std::cerr);
    return asked ? kDone : kUsage;
  } catch (const sessions::OverwriteError& error) {
    const std::string names = optionsNaming(*app.get_subcommands().front(), error.file());
    throw sessions::InputError(names.empty() ? "whs" : names, error.what());
  }
  return exit_code;
}

/// The exit status. Catches every exception and reports it in one line.
int runGuarded(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const sessions::FileError& error) {
    std::cerr << error.what() << std::endl;
    return kBadInput;
  } catch (const sessions::MethodError& error) {
    note(error.what());
    return kNotConverged;
  } catch (const std::bad_alloc&) {
    note("not enough memory");
    return kInternalFault;
  } catch (const std::exception& error) {
    note(std::string("internal fault: ") + error.what());
    return kInternalFault;
  }
}

}  // namespace
}  // namespace boresight::app

int main(int argc, char** argv) {
  using namespace boresight::app;
  const PlainOutput plain_output(std::cout);
  const PlainOutput plain_errors(std::cerr, PlainOutput::Lines::kMessages);
  const SignalEnd signal_end;
  const int exit_code = runGuarded(argc, argv);
  endLog("whs", exit_code);
  constexpr int kBySignal = 128;  // exit codes above: also of a reader that closed the pipe
  if (std::cout.flush() || exit_code > kBySignal) return exit_code;
  note("cannot write standard output: the output is incomplete; is the device full?");
  return exit_code == kDone ? kBadInput : exit_code;
}
