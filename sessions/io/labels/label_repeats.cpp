// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_files.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "sessions/io/labels/label_odl.h"
#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kProperty = "PROPERTY='";

/// Items of a VICAR label, KEY=VALUE one after the other: a value is in quotes or parentheses, or
/// ends at the next blank.
class VicarItems {
 public:
  explicit VicarItems(std::string_view text) : text_(text) {}

  bool next() {
    skipBlanks();
    key = take(std::min(text_.find_first_of(" \t\r\n="), text_.size()));
    skipBlanks();
    value = {};
    if (key.empty() || text_.empty() || text_.front() != '=') return !key.empty();
    take(1);
    skipBlanks();
    value = take(valueSize());
    return true;
  }

  std::string_view key;
  std::string_view value;

 private:
  std::string_view take(std::size_t count) {
    const std::string_view taken = text_.substr(0, count);
    text_.remove_prefix(taken.size());
    return taken;
  }
  void skipBlanks() { take(std::min(text_.find_first_not_of(kBlanks), text_.size())); }

  std::size_t valueSize() const {
    if (text_.empty() || (text_.front() != '(' && text_.front() != '\''))
      return std::min(text_.find_first_of(kBlanks), text_.size());
    bool quoted = false;
    int depth = 0;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      const char c = text_[i];
      if (c == '\'') quoted = !quoted;
      if (!quoted) depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (!quoted && depth <= 0) return i + 1;
    }
    return text_.size();
  }

  std::string_view text_;
};

bool isCameraModel(std::string_view group) {
  return group == "GEOMETRIC_CAMERA_MODEL" || group == "GEOMETRIC_CAMERA_MODEL_PARMS" ||
         group == "CAMERA_MODEL";
}

std::string twice(const std::string& what) {
  return "the label states " + what + " of its camera model twice";
}

/// Properties stand in the label at the beginning and in that at the end, each after its name.
std::string repeatedInVicar(std::string_view bytes) {
  std::set<std::string> properties;
  for (auto at = bytes.find(kProperty); at != std::string_view::npos;
       at = bytes.find(kProperty, at + 1)) {
    VicarItems items(bytes.substr(at, bytes.find('\0', at) - at));
    items.next();
    const std::string name(items.value.substr(1, items.value.size() - 2));
    if (!isCameraModel(name)) continue;
    if (!properties.insert(name).second) return "the label states the property " + name + " twice";
    std::set<std::string> keys;
    while (items.next() && items.key != "PROPERTY" && items.key != "TASK")
      if (!keys.insert(upperCase(items.key)).second) return twice(upperCase(items.key));
  }
  return "";
}

std::string repeatedInPds3(std::string_view text) {
  OdlReader reader(text);
  OdlStatement statement;
  std::set<std::string> keys;
  while (reader.next(statement)) {
    if (statement.key == "GROUP" || statement.key == "OBJECT") keys.clear();
    if (isCameraModel(statement.object) && !keys.insert(statement.key).second)
      return twice(statement.key);
  }
  return "";
}

}  // namespace

std::string repeatedInCameraModel(const LabelFiles& files) {
  const auto bytes = files.labelBytes();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (files.format == LabelFormat::kVicar) return repeatedInVicar(text);
  return files.format == LabelFormat::kPds3 ? repeatedInPds3(text) : "";
}

}  // namespace boresight::sessions
