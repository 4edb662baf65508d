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

OverwriteError::OverwriteError(const std::filesystem::path& file,
                               const std::filesystem::path& input)
    : OutputError(
          file, "it is the input " + input.string() + ", which would be lost; name another file") {}

}  // namespace boresight::sessions
