// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boresight::sessions {

/// `text` on one line: control characters become spaces, runs of blanks one blank.
std::string oneLine(std::string_view text);

/// What is wrong with a file from outside; `what()` is one line for stderr.
class FileError : public std::runtime_error {
 public:
  const std::string& file() const { return file_; }
  const std::string& field() const { return field_; }
  const std::string& reason() const { return reason_; }

 protected:
  FileError(const std::string& line, std::string file, std::string field, std::string reason);

 private:
  std::string file_;
  std::string field_;
  std::string reason_;
};

/// Bad input: "FILE: FIELD: REASON", or "FILE: REASON" when the file as a whole is wrong, e.g.
/// "seed.json: camera_from_station[1][3]: not a finite number".
class InputError : public FileError {
 public:
  InputError(const std::filesystem::path& file, const std::string& field,
             const std::string& reason);
  InputError(const std::filesystem::path& file, const std::string& reason);
};

/// An output that cannot be written: "cannot write FILE: REASON".
class OutputError : public FileError {
 public:
  OutputError(const std::filesystem::path& file, const std::string& reason);
};

}  // namespace boresight::sessions
