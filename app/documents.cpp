// SPDX-License-Identifier: Apache-2.0
// Manual pages, completions and the manual, for those who build packages: hidden from the help.
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "app/commands.h"
#include "app/describe_cli.h"
#include "app/documents/manual_folder.h"
#include "app/documents/write_documents.h"
#include "app/options_page.h"
#include "sessions/version.h"

namespace boresight::app {
namespace {

struct DocumentsArguments {
  std::string folder;
  std::string source;              ///< whose manual is put together, or ""
  std::vector<std::string> pages;  ///< further pages of it, that other programs wrote
};

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The folder as it is installed.
std::string writeManual(const DocumentsArguments& arguments) {
  documents::WrittenPages pages = {{"options.md", optionsPage()}};
  for (const std::filesystem::path file : arguments.pages)
    pages[file.filename().string()] = read(file);
  return documents::assembleManual(arguments.source, pages, arguments.folder);
}

}  // namespace

void addDocuments(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "documents", "Writes manual pages and completions of whs, as its options are declared");
  command->group("");
  auto arguments = std::make_shared<DocumentsArguments>();
  command->add_option("folder", arguments->folder, "Where to")->required()->type_name("DIR");
  command
      ->add_option("--manual-of", arguments->source,
                   "Put the manual of this source together there, in place of the documents")
      ->type_name("DIR");
  command->add_option("--page", arguments->pages, "A further page of the manual")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  command->callback([arguments, &app, &exit_code] {
    documents::Program program = describe(app);
    program.exit_status = kExitStatusText;
    const std::string problem =
        arguments->source.empty()
            ? documents::writeDocuments(program, sessions::kVersion, arguments->folder)
            : writeManual(*arguments);
    exit_code = problem.empty() ? kDone : kBadInput;
    if (!problem.empty()) note(problem);
  });
}

}  // namespace boresight::app
