// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {

/// Error of an external file; `what()` is one line for stderr.
class FileError : public std::runtime_error {
 public:
  const std::string& file() const { return file_; }
  const std::string& field() const { return field_; }
  const std::string& reason() const { return reason_; }

 protected:
  FileError(const std::string& line, std::string file, std::string field, std::string reason)
      : std::runtime_error(oneLine(line)),
        file_(std::move(file)),
        field_(std::move(field)),
        reason_(std::move(reason)) {}

 private:
  std::string file_;
  std::string field_;
  std::string reason_;
};

/// Bad input: "FILE: FIELD: REASON", or "FILE: REASON" when the file as a whole is wrong, e.g.
/// "camera.json: fx: -3100 is outside 0.001 .. 1e+07".
class InputError : public FileError {
 public:
  InputError(const std::filesystem::path& file, const std::string& field, const std::string& reason)
      : FileError(file.string() + ": " + (field.empty() ? "" : field + ": ") + reason,
                  file.string(), field, reason) {}
  InputError(const std::filesystem::path& file, const std::string& reason)
      : InputError(file, "", reason) {}
};

/// An output that cannot be written: "cannot write FILE: REASON".
class OutputError : public FileError {
 public:
  OutputError(const std::filesystem::path& file, const std::string& reason)
      : FileError("cannot write " + file.string() + ": " + reason, file.string(), "", reason) {}
};

/// An output that would replace an input: "cannot write FILE: it is the input INPUT, ...".
class OverwriteError : public OutputError {
 public:
  OverwriteError(const std::filesystem::path& file, const std::filesystem::path& input)
      : OutputError(file, "it is the input " + input.string() +
                              ", which would be overwritten; give another file") {}
};

}  // namespace boresight::sessions
