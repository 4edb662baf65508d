// SPDX-License-Identifier: Apache-2.0
// The members of JSON objects, named once for writing and reading: `fields(archive, self)` of a
// struct names them in the order of the file. The archive is a FieldWriter (`self` is const) or a
// FieldReader, whose InputErrors name file and member.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/geometry/pose.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {

template <class Self, class Record>
concept ConstOr = std::same_as<std::remove_const_t<Self>, Record>;

/// Whether `text` is a SHA-256 in lower-case hexadecimal digits.
bool isSha256Text(const std::string& text);

/// {rotation_wxyz, translation_m}: reads back as the same bits.
nlohmann::ordered_json exactPoseJson(const Pose& pose);
/// Inverse of exactPoseJson. InputError.
Pose readExactPose(const JsonReader& json);
/// 64 lower-case hexadecimal digits. InputError.
std::string readSha256(const JsonReader& json);
/// UTC, in the format of utcNowText(). InputError.
std::string readTime(const JsonReader& json);
/// A text of localizationStatusText; InputError for any other.
std::string readRunStatus(const JsonReader& json);

/// Functions that write and read a member's value.
template <class Write, class Read>
struct Codec {
  Write write;
  Read read;

  auto operator()(const JsonReader& json) const { return read(json); }
};
template <class Write, class Read>
Codec(Write, Read) -> Codec<Write, Read>;

/// Writes the value unchanged.
template <class Read>
constexpr auto plainCodec(Read read) {
  return Codec{[](const auto& value) { return nlohmann::ordered_json(value); }, read};
}

inline constexpr auto kAnyText = plainCodec([](const JsonReader& json) { return json.text(); });
inline constexpr auto kNonEmptyText =
    plainCodec([](const JsonReader& json) { return json.nonEmptyText(); });
inline constexpr auto kFlag = plainCodec([](const JsonReader& json) { return json.boolean(); });
inline constexpr auto kSha256 = plainCodec(&readSha256);
inline constexpr auto kTime = plainCodec(&readTime);
inline constexpr auto kExactPose = Codec{&exactPoseJson, &readExactPose};

constexpr auto numberIn(double minimum, double maximum) {
  return plainCodec([=](const JsonReader& json) { return json.number(minimum, maximum); });
}
inline constexpr auto kNumber = plainCodec([](const JsonReader& json) { return json.number(); });
constexpr auto integerIn(int minimum, int maximum) {
  return plainCodec(
      [=](const JsonReader& json) { return static_cast<int>(json.integer(minimum, maximum)); });
}

/// An enumeration by the names of its values.
template <class Enum, class... Name>
constexpr auto choiceOf(Name... names) {
  return Codec{[=](Enum value) {
                 const char* const all[] = {names...};
                 return nlohmann::ordered_json(all[static_cast<std::size_t>(value)]);
               },
               [=](const JsonReader& json) {
                 const char* const all[] = {names...};
                 const std::string chosen = json.choice({names...});
                 return static_cast<Enum>(std::find(std::begin(all), std::end(all), chosen) -
                                          std::begin(all));
               }};
}

/// A value that `toJson` writes.
template <class Value, class Read>
constexpr auto jsonCodec(Read read) {
  return Codec{[](const Value& value) { return toJson(value); }, read};
}

template <class Element>
constexpr auto listOf(Element element) {
  return Codec{[=](const auto& values) {
                 auto json = nlohmann::ordered_json::array();
                 for (const auto& value : values) json.push_back(element.write(value));
                 return json;
               },
               [=](const JsonReader& json) {
                 std::vector<decltype(element.read(json))> values;
                 for (const JsonReader& item : json.elements())
                   values.push_back(element.read(item));
                 return values;
               }};
}

class PathWriter;
template <class T>
nlohmann::ordered_json fieldsJson(const T& value, const PathWriter* paths = nullptr);
template <class T>
T readFields(const JsonReader& json);

/// Writes paths relative to the folder of the session, where possible.
class PathWriter {
 public:
  /// `file` is the session's.
  explicit PathWriter(const std::filesystem::path& file);

  std::string operator()(const std::filesystem::path& file) const;

 private:
  std::filesystem::path folder_;
};

class FieldWriter {
 public:
  static constexpr bool kReads = false;
  /// `paths` may be nullptr for structs without paths.
  explicit FieldWriter(const PathWriter* paths) : paths_(paths) {}
  nlohmann::ordered_json take() { return std::move(json_); }

  template <class T, class Form>
  void field(const char* key, const T& value, const Form& codec) {
    json_[key] = codec.write(value);
  }
  /// The member may be missing in a file; the value is then unchanged.
  template <class T, class Form>
  void defaulted(const char* key, const T& value, const Form& codec) {
    field(key, value, codec);
  }
  /// Leaves the member out when there is no value, or the default of its type.
  template <class T, class Form>
  void optional(const char* key, const T& value, const Form& codec) {
    if (!(value == T())) json_[key] = codec.write(value);
  }
  template <class T, class Form>
  void optional(const char* key, const std::optional<T>& value, const Form& codec) {
    if (value) json_[key] = codec.write(*value);
  }
  void path(const char* key, const std::filesystem::path& value, FileUse = FileUse::kInput) {
    json_[key] = (*paths_)(value);
  }
  void optionalPath(const char* key, const std::optional<std::filesystem::path>& value, FileUse) {
    if (value) path(key, *value);
  }
  /// Writes a struct that has `fields`, as do the functions below.
  template <class T>
  void object(const char* key, const T& value) {
    json_[key] = fieldsJson(value, paths_);
  }
  template <class T>
  void object(const char* key, const std::optional<T>& value) {
    if (value) json_[key] = fieldsJson(*value, paths_);
  }
  template <class T>
  void list(const char* key, const std::vector<T>& values) {
    json_[key] = nlohmann::ordered_json::array();
    for (const T& value : values) json_[key].push_back(fieldsJson(value, paths_));
  }
  template <class T>
  void optionalList(const char* key, const std::vector<T>& values) {
    if (!values.empty()) list(key, values);
  }
  void add(const nlohmann::ordered_json& members) { json_.update(members); }

 private:
  const PathWriter* paths_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

class FieldReader {
 public:
  static constexpr bool kReads = true;
  explicit FieldReader(const JsonReader& json) : json_(json) {}
  const JsonReader& json() const { return json_; }

  template <class T, class Form>
  void field(const char* key, T& value, const Form& codec) {
    value = codec.read(json_.at(key));
  }
  template <class T, class Form>
  void optional(const char* key, T& value, const Form& codec) {
    json_.optional(key, value, codec);
  }
  template <class T, class Form>
  void defaulted(const char* key, T& value, const Form& codec) {
    optional(key, value, codec);
  }
  /// Reads a path as absolute and normalized.
  void path(const char* key, std::filesystem::path& value, FileUse use = FileUse::kInput) {
    value = std::filesystem::absolute(json_.at(key).path(use)).lexically_normal();
  }
  void optionalPath(const char* key, std::optional<std::filesystem::path>& value, FileUse use) {
    if (json_.has(key)) path(key, value.emplace(), use);
  }
  template <class T>
  void object(const char* key, T& value) {
    value = readFields<T>(json_.at(key));
  }
  template <class T>
  void object(const char* key, std::optional<T>& value) {
    json_.optional(key, value, readFields<T>);
  }
  template <class T>
  void list(const char* key, std::vector<T>& values) {
    for (const JsonReader& item : json_.at(key).elements()) values.push_back(readFields<T>(item));
  }
  template <class T>
  void optionalList(const char* key, std::vector<T>& values) {
    if (json_.has(key)) list(key, values);
  }

 private:
  JsonReader json_;
};

template <class T>
nlohmann::ordered_json fieldsJson(const T& value, const PathWriter* paths) {
  FieldWriter writer(paths);
  fields(writer, value);
  return writer.take();
}

template <class T>
T readFields(const JsonReader& json) {
  T value;
  FieldReader reader(json);
  fields(reader, value);
  return value;
}

}  // namespace boresight::sessions
