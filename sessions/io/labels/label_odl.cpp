// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_odl.h"

#include <algorithm>

#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kMostDepth = 64;  ///< of objects within objects

bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

/// The name of an object, which may stand in quotes.
std::string nameIn(std::string_view value) {
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
    value = value.substr(1, value.size() - 2);
  return upperCase(value);
}

}  // namespace

void OdlReader::skipLine() {
  while (at_ < text_.size() && !isLineEnd(here()) && here() != '\0') ++at_;
}

/// Blanks, comments /* ... */ with the rest of their line, and those from '#' on.
void OdlReader::skip() {
  while (at_ < text_.size()) {
    if (here() == '/' && here(1) == '*') {
      at_ = std::min(text_.find("*/", at_ + 2), text_.size());
      skipLine();
    } else if (isBlank(here()) && here(1) == '#') {
      ++at_;
      skipLine();
    } else if (isBlank(here())) {
      ++at_;
    } else {
      return;
    }
  }
}

/// A text in quotes, or all up to a blank or '='.
std::string_view OdlReader::word() {
  const std::size_t begin = at_;
  const char quote = here();
  if (quote == '"' || quote == '\'') {
    const auto end = text_.find(quote, at_ + 1);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    return text_.substr(begin, at_ - begin);
  }
  while (at_ < text_.size() && here() != '\0' && here() != '=' && !isBlank(here())) ++at_;
  return text_.substr(begin, at_ - begin);
}

/// From a bracket to the one that closes it; brackets in quotes are none.
std::string_view OdlReader::list() {
  const std::size_t begin = at_;
  const char open = here();
  const char close = open == '(' ? ')' : '}';
  int depth = 0;
  while (at_ < text_.size() && here() != '\0') {
    const char c = here();
    if (c == '"') {
      (void)word();
      continue;
    }
    ++at_;
    if (c == open) ++depth;
    if (c == close && --depth == 0) break;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view OdlReader::value() { return here() == '(' || here() == '{' ? list() : word(); }

void OdlReader::readUnit(OdlStatement& statement) {
  const std::size_t behind_value = at_;
  skip();
  if (here() != '<') {
    at_ = behind_value;
    return;
  }
  const auto end = std::min(text_.find('>', at_), text_.size());
  statement.unit = text_.substr(at_ + 1, end - at_ - 1);
  at_ = std::min(end + 1, text_.size());
}

bool OdlReader::enter(std::string_view name) {
  if (parents_.size() == kMostDepth) return false;
  parents_.push_back(object_.size());
  object_ += (object_.empty() ? "" : ".") + nameIn(name);
  return true;
}

void OdlReader::leave() {
  leaves_ = false;
  if (parents_.empty()) return;
  object_.resize(parents_.back());
  parents_.pop_back();
}

bool OdlReader::next(OdlStatement& statement) {
  if (leaves_) leave();
  skip();
  statement = OdlStatement();
  statement.begin = at_;
  statement.key = upperCase(word());
  ended_ = statement.key == "END";
  if (ended_ || statement.key.empty()) return false;
  skip();
  leaves_ = statement.key == "END_OBJECT" || statement.key == "END_GROUP";
  if (here() != '=' && !leaves_) return false;
  if (here() == '=') {
    ++at_;
    skip();
    statement.value = value();
    readUnit(statement);
  }
  statement.end = at_;
  if ((statement.key == "OBJECT" || statement.key == "GROUP") && !enter(statement.value))
    return false;
  statement.object = object_;
  return true;
}

}  // namespace boresight::sessions
