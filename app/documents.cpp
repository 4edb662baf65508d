// SPDX-License-Identifier: Apache-2.0
// The manual's page of every command, and the manual's folder, for the build: hidden from the help.
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "app/commands.h"
#include "app/documents/manual_folder.h"

namespace boresight::app {
namespace {

using documents::markdownText;

struct DocumentsArguments {
  std::string folder;
  std::string source;              ///< of the manual's pages
  std::vector<std::string> pages;  ///< further pages, that other programs wrote
};

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A row for every option and positional argument of a command and its groups, each once.
std::string optionRows(const CLI::App& command, std::set<std::string>& listed) {
  const CLI::Formatter formatter;
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = formatter.make_option_name(option, option->get_positional());
    if (option->get_group().empty() || !listed.insert(name).second) continue;
    text += "| `" + name + formatter.make_option_opts(option) + "` | " +
            markdownText(option->get_description()) + " |\n";
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
    if (group->get_name().empty()) text += optionRows(*group, listed);
  return text;
}

std::string commandText(const CLI::App& command) {
  std::set<std::string> listed;
  const std::string help = command.get_description();
  return markdownText(help) + (help.ends_with('.') ? "" : ".") +
         "\n\n| option | meaning |\n|---|---|\n" + optionRows(command, listed);
}

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
  CLI::App* command = app.add_subcommand("documents", "Puts the manual's folder together");
  command->group("");
  auto arguments = std::make_shared<DocumentsArguments>();
  command->add_option("folder", arguments->folder, "Where to")->required()->type_name("DIR");
  command->add_option("--manual-of", arguments->source, "Source with the manual's pages")
      ->required()
      ->type_name("DIR");
  addFile(*command, "--page", arguments->pages, "A further page of the manual")
      ->check(CLI::ExistingFile);
  command->callback([arguments, &app, &exit_code] {
    documents::WrittenPages pages = {{"options.md", optionsPage()}, {"whs.md", commandsPage(app)}};
    for (const std::filesystem::path file : arguments->pages)
      pages[file.filename().string()] = read(file);
    const std::string problem =
        documents::assembleManual(arguments->source, pages, arguments->folder);
    exit_code = problem.empty() ? kDone : kBadInput;
    if (!problem.empty()) note(problem);
  });
}

}  // namespace boresight::app
