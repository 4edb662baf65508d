// SPDX-License-Identifier: Apache-2.0
// Manual pages and completions, for those who build packages: hidden from the help.
#include <memory>

#include "app/commands.h"
#include "app/describe_cli.h"
#include "app/documents/write_documents.h"
#include "sessions/version.h"

namespace boresight::app {

void addDocuments(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "documents", "Writes manual pages and completions of whs, as its options are declared");
  command->group("");
  auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "Where to")->required()->type_name("DIR");
  command->callback([folder, &app, &exit_code] {
    documents::Program program = describe(app);
    program.exit_status = kExitStatusText;
    const std::string problem = documents::writeDocuments(program, sessions::kVersion, *folder);
    exit_code = problem.empty() ? kDone : kBadInput;
    if (!problem.empty()) note(problem);
  });
}

}  // namespace boresight::app
