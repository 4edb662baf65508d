// SPDX-License-Identifier: Apache-2.0
// whs: localization without a window.
#include <exception>
#include <iostream>
#include <new>

#include "app/commands.h"
#include "app/results_commands.h"
#include "sessions/baselines/matching_method.h"
#include "sessions/io/errors.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Localizes a camera relative to a known object by render and compare.", "whs");
  app.set_version_flag("--version", std::string("whs ") + sessions::kVersion);
  app.set_help_all_flag("--help-all", "Help of every subcommand");
  app.require_subcommand(1);
  app.footer(std::string("Exit status: ") + kExitStatusText);
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
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    app.exit(error, std::cout, std::cerr);
    return asked ? kDone : kUsage;
  }
  return exit_code;
}

}  // namespace
}  // namespace boresight::app

int main(int argc, char** argv) {
  using boresight::app::note;
  try {
    return boresight::app::run(argc, argv);
  } catch (const boresight::sessions::FileError& error) {
    std::cerr << error.what() << std::endl;
    return boresight::app::kBadInput;
  } catch (const boresight::sessions::MethodError& error) {
    note(error.what());
    return boresight::app::kNotConverged;
  } catch (const std::bad_alloc&) {
    note("not enough memory");
    return boresight::app::kInternalFault;
  } catch (const std::exception& error) {
    note(std::string("internal fault: ") + error.what());
    return boresight::app::kInternalFault;
  }
}
