// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json_reader.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

using Json = nlohmann::json;

/// Builds the document and knows the place of every value, which nlohmann's own builder does not
/// tell: duplicates and bad numbers are reported by field, syntax errors by line and column.
class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(const std::filesystem::path& file, std::string_view text)
      : file_(file), text_(text) {}

  Json takeRoot() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    key_ = name;
    if (open_.back()->contains(name)) throw InputError(file_, place(), "given twice");
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const Json::exception& error) override {
    const bool number_overflow = error.id == 406;
    if (number_overflow || stopsInNonFinite(position))
      throw InputError(file_, place(), "not a finite number");
    throw InputError(file_, lineAndColumn(position), "not JSON: " + explanation(error));
  }

 private:
  static constexpr std::size_t kDetail = 160;

  bool add(Json value) {
    place_value(std::move(value));
    return true;
  }

  Json* place_value(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[key_] = std::move(value));
  }

  bool open(Json value) {
    if (open_.size() >= kMaxJsonDepth)
      throw InputError(file_, place(),
                       "nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
    // Names are kept per level: `key_` is only that of the innermost object.
    names_.push_back(ownName());
    open_.push_back(place_value(std::move(value)));
    return true;
  }

  bool close() {
    open_.pop_back();
    names_.pop_back();
    return true;
  }

  /// ".key" or "[index]" of the value that comes next in the innermost container.
  std::string ownName() const {
    if (open_.empty()) return "";
    if (open_.back()->is_array()) return "[" + std::to_string(open_.back()->size()) + "]";
    return "." + key_;
  }

  std::string place() const {
    std::string whole;
    for (const std::string& name : names_) whole += name;
    whole += ownName();
    return !whole.empty() && whole.front() == '.' ? whole.substr(1) : whole;
  }

  /// Whether the bad token is the NaN or Infinity that some writers put into JSON; the parser stops
  /// somewhere within it.
  bool stopsInNonFinite(std::size_t position) const {
    std::size_t start = std::min(position, text_.size());
    while (start > 0 && std::isalpha(static_cast<unsigned char>(text_[start - 1])) != 0) --start;
    const std::string_view token = text_.substr(start);
    return token.starts_with("NaN") || token.starts_with("nan") || token.starts_with("Inf") ||
           token.starts_with("inf");
  }

  std::string lineAndColumn(std::size_t position) const {
    const std::string_view before = text_.substr(0, std::min(position, text_.size()));
    std::size_t line = 1;
    std::size_t column = 0;
    for (const char c : before) {
      ++column;
      if (c == '\n') {
        ++line;
        column = 0;
      }
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
  }

  /// nlohmann's message without its error number and position.
  static std::string explanation(const Json::exception& error) {
    std::string message = error.what();
    if (message.find("unexpected end of input") != std::string::npos)
      return "the file ends in the middle; it was cut short, or not written to its end";
    const std::size_t column = message.find("column ");
    const std::size_t colon = message.find(": ", column == std::string::npos ? 0 : column);
    if (colon != std::string::npos) message = message.substr(colon + 2);
    return message.size() > kDetail ? message.substr(0, kDetail) + "..." : message;
  }

  const std::filesystem::path& file_;
  std::string_view text_;
  Json root_;
  std::vector<Json*> open_;  ///< stays valid: only the innermost container grows
  std::vector<std::string> names_;
  std::string key_;
};

Json parse(const std::filesystem::path& file, std::string_view text) {
  if (text.size() > kMaxJsonBytes)
    throw InputError(
        file, "larger than the limit of " + std::to_string(kMaxJsonBytes / kMegabyte) + " MB");
  DocumentBuilder builder(file, text);
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) throw InputError(file, "not JSON");
  return builder.takeRoot();
}

}  // namespace

JsonDocument::JsonDocument(const std::filesystem::path& file, std::string_view text)
    : file_(file), value_(std::make_unique<Json>(parse(file, text))) {}

JsonDocument::JsonDocument(const std::filesystem::path& file)
    : JsonDocument(file, asText(readFileBytes(file, kMaxJsonBytes))) {}

JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

JsonReader JsonDocument::root() const { return {file_, *value_, ""}; }

}  // namespace boresight::sessions
