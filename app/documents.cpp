// SPDX-License-Identifier: Apache-2.0
// The manual's pages of commands and options, for the build: hidden from the help.
#include <memory>

#include "app/commands.h"
#include "app/written_pages.h"

namespace boresight::app {
namespace {

/// Every command under a heading of its own, as `--help` tells of it.
std::string commandsPage(const CLI::App& app) {
  std::string text = "# whs, command by command\n\nExit status: " + markdownText(kExitStatusText) +
                     "\n\n" + commandText(app);
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty())
      text += "\n## whs " + command->get_name() + "\n\n" + commandText(*command);
  return text;
}

}  // namespace

void addDocuments(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("documents", "Writes pages of the manual");
  command->group("");
  auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "Where to")->required()->type_name("DIR");
  command->callback([folder, &app, &exit_code] {
    exit_code = writePages(*folder, {{"options.md", optionsPage()}, {"whs.md", commandsPage(app)}});
  });
}

}  // namespace boresight::app
