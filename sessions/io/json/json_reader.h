// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {

/// Records which members of a document's objects its reader has accessed.
class JsonUse {
 public:
  void note(const nlohmann::json& object, std::string_view key);
  void noteAll(const nlohmann::json& object);
  /// "is not known ..." where a reader opened `object` and did not access `key`; else "".
  std::string refusal(const nlohmann::json& object, const std::string& key) const;

 private:
  struct Asked {
    bool all = false;
    std::vector<const std::string*> names;  ///< in names_
  };
  std::set<std::string, std::less<>> names_;
  std::map<const nlohmann::json*, Asked> asked_;
};

/// A value inside a JSON document together with its place, e.g. `cases[3].seed`. Every accessor
/// throws InputError (file, place, reason) when the value is not of the requested kind, so that
/// readers need no error handling. Points into the document, which must outlive it.
class JsonReader {
 public:
  /// `use` may be nullptr.
  JsonReader(const std::filesystem::path& file, const nlohmann::json& value, std::string place,
             JsonUse* use = nullptr)
      : file_(&file), value_(&value), place_(std::move(place)), use_(use) {}

  /// The result of `read` for this value. InputError for each member that `read` did not access: a
  /// misspelt member would be ignored, and lost when the file is written again.
  template <class Read>
  auto whole(Read&& read) const {
    JsonUse use;
    const JsonReader tracked(*file_, *value_, place_, &use);
    auto result = read(tracked);
    tracked.requireUsed();
    return result;
  }
  /// Whether this is an object that states this format.
  bool hasFormat(std::string_view format) const;
  /// InputError unless this is an object of this `format` and `version`.
  void requireFormat(std::string_view format, int version) const;

  /// Throws InputError for this place.
  [[noreturn]] void fail(const std::string& reason) const;
  /// Throws InputError for the member `key` of this object.
  [[noreturn]] void failMember(std::string_view key, const std::string& reason) const;

  bool has(std::string_view key) const { return find(key).has_value(); }
  /// Member of an object; must exist.
  JsonReader at(std::string_view key) const;
  /// Member of an object, or empty. A null counts as absent.
  std::optional<JsonReader> find(std::string_view key) const;
  /// Sets `value` to the result of `read` for the member `key`, if this object has it.
  template <class T, class Read>
  void optional(std::string_view key, T& value, const Read& read) const {
    if (const auto found = find(key)) value = std::invoke(read, *found);
  }
  std::vector<std::pair<std::string, JsonReader>> members() const;  ///< of an object, by key
  std::vector<JsonReader> elements() const;                         ///< of an array
  std::vector<JsonReader> elements(std::size_t count) const;        ///< of an array of `count`

  /// The parsed value, to ask its kind only: members read through it do not count as used.
  const nlohmann::json& value() const { return *value_; }

  double number() const;
  /// A number in [minimum, maximum].
  double number(double minimum, double maximum) const;
  /// A number above `bound`.
  double numberAbove(double bound) const;
  /// An integral number in [minimum, maximum]; 5.0 is accepted as 5.
  std::int64_t integer(std::int64_t minimum = std::numeric_limits<std::int64_t>::min(),
                       std::int64_t maximum = std::numeric_limits<std::int64_t>::max()) const;
  bool boolean() const;
  std::string text() const;
  std::string nonEmptyText() const;
  /// One of `choices`.
  std::string choice(std::initializer_list<const char*> choices) const;

  Eigen::Vector2d vector2() const;
  /// Three numbers, each in [minimum, maximum].
  Eigen::Vector3d vector3(double minimum = std::numeric_limits<double>::lowest(),
                          double maximum = std::numeric_limits<double>::max()) const;
  /// N rows of N numbers.
  template <int N>
  Eigen::Matrix<double, N, N> matrix() const {
    Eigen::Matrix<double, N, N> result;
    for (int row = 0; const JsonReader& cells : elements(N)) {
      for (int column = 0; const JsonReader& cell : cells.elements(N))
        result(row, column++) = cell.number();
      ++row;
    }
    return result;
  }

  /// A file named relative to the document's folder (or absolute): no output replaces it from now
  /// on (file_bytes.h).
  std::filesystem::path path(FileUse use = FileUse::kInput) const;

  const std::filesystem::path& file() const { return *file_; }
  const std::string& place() const { return place_; }

 private:
  JsonReader member(std::string_view key, const nlohmann::json& value) const;
  JsonReader element(std::size_t index) const;
  /// Rejects, here and below, members of opened objects that were not accessed.
  void requireUsed() const;
  void requireObject() const;
  /// "not a number (a string)" and the like.
  std::string mismatch(const char* wanted) const;

  const std::filesystem::path* file_;
  const nlohmann::json* value_;
  std::string place_;
  JsonUse* use_;  ///< or null
};

/// Shortest text that reads back as the same double.
std::string numberText(double value);
/// Several numbers, e.g. "0.5 -3 0.1".
template <class Numbers = std::initializer_list<double>>
std::string numbersText(const Numbers& numbers, const char* separator = " ") {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : separator) + numberText(number);
  return text;
}

inline constexpr std::size_t kMaxJsonBytes = 64 * kMegabyte;
inline constexpr std::size_t kMaxJsonDepth = 64;

/// A parsed JSON file. Rejected, each with the place in the file: text that is not JSON or not
/// UTF-8, a duplicate key, NaN or infinity, numbers that do not fit a double, more than
/// `kMaxJsonDepth` levels. Comments are not JSON.
class JsonDocument {
 public:
  /// Reads and parses `file`; InputError.
  explicit JsonDocument(const std::filesystem::path& file);
  /// Parses text; `file` only names it in messages.
  JsonDocument(const std::filesystem::path& file, std::string_view text);

  /// The top-level value, for formats that others define; valid as long as the document.
  JsonReader root() const;
  /// The result of `read` for the top-level object, which must have this `format` and `version` and
  /// no members that `read` does not access. InputError.
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
  std::shared_ptr<const nlohmann::json> value_;
};

}  // namespace boresight::sessions
