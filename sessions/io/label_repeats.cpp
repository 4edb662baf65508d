// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/label_repeats.h"

#include <set>
#include <string_view>

#include "sessions/io/label_values.h"

namespace boresight::sessions {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kProperty = "PROPERTY='";
constexpr std::size_t kLongestPds3Label = 4'000'000;

/// KEY = value, one after the other: a value is quoted, in parentheses, or ends with its line
/// (PDS3) or the next blank (VICAR).
class Statements {
 public:
  Statements(std::string_view text, LabelFormat format) : text_(text), format_(format) {}

  bool next() {
    skipBlanks();
    key = take(text_.substr(0, text_.find_first_of(" \t\r\n=")).size());
    skipBlanks();
    value = {};
    if (key.empty() || text_.empty() || text_.front() != '=') return !key.empty();
    take(1);
    skipBlanks();
    value = take(valueSize());
    if (format_ == LabelFormat::kPds3) take(text_.find_first_of("\r\n"));
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

  void skipBlanks() {
    take(text_.find_first_not_of(kBlanks));
    while (format_ == LabelFormat::kPds3 && text_.starts_with("/*")) {
      const auto end = text_.find("*/");
      take(end == std::string_view::npos ? end : end + 2);
      take(text_.find_first_not_of(kBlanks));
    }
  }

  bool isQuote(char c) const { return c == '\'' || (format_ == LabelFormat::kPds3 && c == '"'); }

  std::size_t valueSize() const {
    if (text_.empty()) return 0;
    const bool list = text_.front() == '(' || text_.front() == '{';
    if (!list && !isQuote(text_.front()))
      return text_.find_first_of(format_ == LabelFormat::kPds3 ? "\r\n" : kBlanks);
    char quote = '\0';
    int depth = 0;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote != '\0')
        quote = c == quote ? '\0' : quote;
      else if (isQuote(c))
        quote = c;
      else if (c == '(' || c == '{')
        ++depth;
      else if (c == ')' || c == '}')
        --depth;
      if (quote == '\0' && depth <= 0) return i + 1;
    }
    return text_.size();
  }

  std::string_view text_;
  LabelFormat format_;
};

bool isCameraModel(std::string_view group) {
  return group == "GEOMETRIC_CAMERA_MODEL" || group == "GEOMETRIC_CAMERA_MODEL_PARMS" ||
         group == "CAMERA_MODEL";
}

std::string twice(const std::string& what) {
  return "the label states " + what + " of its camera model twice";
}

/// What comes twice among the statements of one group; they end where another one opens.
std::string repeatedKey(Statements& statements, std::initializer_list<std::string_view> ends) {
  std::set<std::string> seen;
  while (statements.next()) {
    for (const std::string_view end : ends)
      if (statements.key == end) return "";
    if (!seen.insert(upperCase(statements.key)).second) return twice(upperCase(statements.key));
  }
  return "";
}

/// Properties stand in the label at the beginning and in that at the end, each after its name.
std::string repeatedInVicar(std::string_view bytes) {
  std::set<std::string> seen;
  for (auto at = bytes.find(kProperty); at != std::string_view::npos;
       at = bytes.find(kProperty, at + 1)) {
    std::string_view text = bytes.substr(at, bytes.find('\0', at) - at);
    Statements statements(text, LabelFormat::kVicar);
    statements.next();
    const std::string name(statements.value.substr(1, statements.value.size() - 2));
    if (!isCameraModel(name)) continue;
    if (!seen.insert(name).second) return "the label states the property " + name + " twice";
    const std::string repeated = repeatedKey(statements, {"PROPERTY", "TASK"});
    if (!repeated.empty()) return repeated;
  }
  return "";
}

std::string repeatedInPds3(std::string_view text) {
  Statements statements(text.substr(0, kLongestPds3Label), LabelFormat::kPds3);
  while (statements.next() && statements.key != "END") {
    if (statements.key != "GROUP" && statements.key != "OBJECT") continue;
    const std::string_view name =
        statements.value.substr(0, statements.value.find_first_of(kBlanks));
    if (!isCameraModel(name)) continue;
    const std::string repeated = repeatedKey(statements, {"END_GROUP", "END_OBJECT", "END"});
    if (!repeated.empty()) return repeated;
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
