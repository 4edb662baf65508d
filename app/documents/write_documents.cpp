// SPDX-License-Identifier: Apache-2.0
#include "app/documents/write_documents.h"

#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "app/documents/completions.h"
#include "app/documents/manual_page.h"
#include "app/documents/markdown_page.h"

namespace boresight::documents {
namespace {

std::string write(const std::filesystem::path& file, const std::string& text) {
  std::error_code fault;
  std::filesystem::create_directories(file.parent_path(), fault);
  if (fault) return file.parent_path().string() + ": cannot be made: " + fault.message();
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  return stream ? "" : file.string() + ": cannot be written";
}

}  // namespace

std::string writeDocuments(const Program& program, const std::string& version,
                           const std::filesystem::path& folder) {
  std::vector<std::pair<std::filesystem::path, std::string>> files = {
      {folder / "bash" / program.name, bashCompletion(program)},
      {folder / "zsh" / ("_" + program.name), zshCompletion(program)},
      {folder / "fish" / (program.name + ".fish"), fishCompletion(program)},
      {folder / "manual" / (program.name + ".md"), markdownPage(program)}};
  for (const auto& [name, text] : manualPages(program, version))
    files.emplace_back(folder / "man1" / name, text);
  for (const auto& [file, text] : files) {
    const std::string problem = write(file, text);
    if (!problem.empty()) return problem;
  }
  return {};
}

}  // namespace boresight::documents
