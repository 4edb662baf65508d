// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/file_bytes.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {

inline constexpr std::size_t kMaxJsonBytes = 64 * kMegabyte;
inline constexpr std::size_t kMaxJsonDepth = 64;

/// A parsed JSON file. Refused, each with the place in the file: anything that is not JSON or not
/// UTF-8, a key given twice, NaN or infinity, numbers that do not fit a double, more than
/// `kMaxJsonDepth` levels. Comments are not JSON.
class JsonDocument {
 public:
  /// Reads and parses `file`; InputError.
  explicit JsonDocument(const std::filesystem::path& file);
  /// Parses text; `file` only names it in messages.
  JsonDocument(const std::filesystem::path& file, std::string_view text);
  JsonDocument(JsonDocument&&) noexcept;
  JsonDocument& operator=(JsonDocument&&) noexcept;
  ~JsonDocument();

  /// The value at the top, of a format that others define; lives as long as the document.
  JsonReader root() const;
  /// What `read` makes of the top, an object of this `format` and `version` without members that
  /// `read` does not ask for. InputError.
  template <class Read>
  auto read(std::string_view format, int version, Read&& read) const {
    return root().whole([&](const JsonReader& top) {
      top.requireFormat(format, version);
      return read(top);
    });
  }

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::unique_ptr<nlohmann::json> value_;
};

}  // namespace boresight::sessions
