// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>

namespace boresight::sessions {

/// Writes a zip archive (with zip64 where it is needed) under a temporary name; `commit` proves it
/// readable and gives it its own. Without a commit nothing stays behind. The same entries make the
/// same bytes: no times are stored.
class ZipWriter {
 public:
  /// OutputError when it cannot be written.
  explicit ZipWriter(const std::filesystem::path& archive);
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;
  ~ZipWriter();

  /// Adds a file; one of the same name as before is left out. OutputError.
  void add(const std::string& name, std::span<const std::uint8_t> bytes);
  void add(const std::string& name, std::string_view text);

  /// OutputError; then the old file of that name is as it was.
  void commit();

 private:
  void requireReadable() const;

  std::filesystem::path archive_;
  std::filesystem::path temporary_;
  void* zip_ = nullptr;
  std::set<std::string> names_;
};

}  // namespace boresight::sessions
