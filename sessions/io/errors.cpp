// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/errors.h"

#include <utility>

namespace boresight::sessions {
namespace {

std::string inputLine(const std::string& file, const std::string& field,
                      const std::string& reason) {
  return oneLine(field.empty() ? file + ": " + reason : file + ": " + field + ": " + reason);
}

}  // namespace

std::string oneLine(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    const char printable = code < 0x20 || code == 0x7f ? ' ' : c;
    if (printable == ' ' && (line.empty() || line.back() == ' ')) continue;
    line.push_back(printable);
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

FileError::FileError(const std::string& line, std::string file, std::string field,
                     std::string reason)
    : std::runtime_error(line),
      file_(std::move(file)),
      field_(std::move(field)),
      reason_(std::move(reason)) {}

InputError::InputError(const std::filesystem::path& file, const std::string& field,
                       const std::string& reason)
    : FileError(inputLine(file.string(), field, reason), file.string(), field, reason) {}

InputError::InputError(const std::filesystem::path& file, const std::string& reason)
    : InputError(file, std::string(), reason) {}

OutputError::OutputError(const std::filesystem::path& file, const std::string& reason)
    : FileError(oneLine("cannot write " + file.string() + ": " + reason), file.string(), "",
                reason) {}

}  // namespace boresight::sessions
