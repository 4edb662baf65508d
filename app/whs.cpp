// SPDX-License-Identifier: Apache-2.0
// whs: localization without a window.
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>

#include "app/commands.h"
#include "app/complete.h"
#include "app/plain_output.h"
#include "sessions/io/errors.h"
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
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
    add(optionsNaming(*group, file));
  return names;
}

int run(int argc, char** argv) {
  CLI::App app("Localizes a camera relative to a known object by render and compare.", "whs");
  app.set_version_flag("--version", std::string("whs ") + sessions::kVersion);
  app.set_help_all_flag("--help-all", "Help of every subcommand");
  app.require_subcommand(1);
  app.footer(std::string("Exit status: ") + kExitStatusText);
  app.failure_message([](const CLI::App* parsed, const CLI::Error& error) {
    const std::string what = sessions::plainText(error.what());
    return CLI::FailureMessage::simple(parsed, {error.get_name(), what, error.get_exit_code()});
  });
  int exit_code = kDone;
  addLocalize(app, exit_code);
  addEvaluate(app, exit_code);
  addMerge(app, exit_code);
  addTables(app, exit_code);
  addCompare(app, exit_code);
  addCheck(app, exit_code);
  addDecide(app, exit_code);
  addVerify(app, exit_code);
  addViews(app, exit_code);
  addReport(app, exit_code);
  addQueue(app, exit_code);
  addSolve(app, exit_code);
  addRender(app, exit_code);
  addCamera(app, exit_code);
  addInfo(app, exit_code);
  addOptions(app, exit_code);
  addNew(app, exit_code);
  addRun(app, exit_code);
  addPack(app, exit_code);
  addExport(app, exit_code);
  addImport(app, exit_code);
  addProblem(app, exit_code);
  addBench(app, exit_code);
  addDocuments(app, exit_code);
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

/// The exit status, whatever happens; a failure is told in one line.
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
  const PlainOutput plain_errors(std::cerr);
  const int exit_code = runGuarded(argc, argv);
  if (std::cout.flush()) return exit_code;
  note("cannot write standard output: not all of the output got there; is its device full?");
  return exit_code == kDone ? kBadInput : exit_code;
}
