// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/json_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

/// nlohmann's message, which states line and column, without its error number.
std::string explanation(const nlohmann::json::exception& error) {
  constexpr std::size_t kMost = 200;
  const std::string message = error.what();
  if (message.find("unexpected end of input") != std::string::npos) return "the file is truncated";
  const std::size_t end_of_number = message.find("] ");
  const std::string text =
      end_of_number == std::string::npos ? message : message.substr(end_of_number + 2);
  return text.size() > kMost ? text.substr(0, kMost) + "..." : text;
}

/// Refuses what nlohmann's parser takes: it keeps the last of several members of one name, and
/// follows any depth. A pass of its own, as nlohmann's callback looks at every element of an array
/// again whenever one of them ends.
class JsonCheck : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit JsonCheck(const std::filesystem::path& file) : file_(file) {}

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*elements*/) override {
    open();
    names_.emplace_back();
    return true;
  }
  bool key(string_t& name) override {
    if (!names_.back().insert(name).second) throw InputError(file_, name, "given twice");
    return true;
  }
  bool end_object() override {
    names_.pop_back();
    --depth_;
    return true;
  }
  bool start_array(std::size_t /*elements*/) override {
    open();
    return true;
  }
  bool end_array() override {
    --depth_;
    return true;
  }
  /// The parser that builds the values reports the error.
  bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                   const nlohmann::json::exception& /*error*/) override {
    return false;
  }

 private:
  void open() {
    if (depth_ >= kMaxJsonDepth)
      throw InputError(file_, "nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
    ++depth_;
  }

  const std::filesystem::path& file_;
  std::size_t depth_ = 0;
  std::vector<std::set<std::string>> names_;  ///< of the open objects
};

/// Of a text in memory; most files are limited to kMaxJsonBytes when they are read.
constexpr std::size_t kMaxTextBytes = 8 * kMaxJsonBytes;

nlohmann::json parse(const std::filesystem::path& file, std::string_view text) {
  if (text.size() > kMaxTextBytes)
    throw InputError(
        file, "larger than the limit of " + std::to_string(kMaxTextBytes / kMegabyte) + " MB");
  JsonCheck check(file);
  nlohmann::json::sax_parse(text, &check);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "not JSON: " + explanation(error));
  }
}

}  // namespace

void JsonUse::note(const nlohmann::json& object, std::string_view key) {
  auto known = names_.find(key);
  if (known == names_.end()) known = names_.emplace(key).first;
  std::vector<const std::string*>& names = asked_[&object].names;
  if (std::find(names.begin(), names.end(), &*known) == names.end()) names.push_back(&*known);
}

void JsonUse::noteAll(const nlohmann::json& object) { asked_[&object].all = true; }

std::string JsonUse::refusal(const nlohmann::json& object, const std::string& key) const {
  const auto found = asked_.find(&object);
  if (found == asked_.end() || found->second.all) return "";
  const std::vector<const std::string*>& names = found->second.names;
  const auto is = [&key](const std::string* name) { return *name == key; };
  if (std::any_of(names.begin(), names.end(), is)) return "";
  std::string others;
  for (const std::string* name : names)
    if (!object.contains(*name)) others += (others.empty() ? "" : ", ") + *name;
  return "is not known to this version of the format" +
         (others.empty() ? "" : ", which also has: " + others);
}

std::string numberText(double value) {
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return {buffer, result.ptr};
}

void JsonReader::fail(const std::string& reason) const { throw InputError(*file_, place_, reason); }

void JsonReader::failMember(std::string_view key, const std::string& reason) const {
  member(key, *value_).fail(reason);
}

std::string JsonReader::mismatch(const char* wanted) const {
  std::string found = value_->type_name();
  if (value_->is_array()) found = "list of " + std::to_string(value_->size());
  const bool vowel = found.starts_with("o") || found.starts_with("a");
  return std::string("not ") + wanted + " (is " +
         (value_->is_null() ? "null" : (vowel ? "an " : "a ") + found) + ")";
}

JsonReader JsonReader::member(std::string_view key, const nlohmann::json& value) const {
  return {*file_, value, place_.empty() ? std::string(key) : place_ + "." + std::string(key), use_};
}

JsonReader JsonReader::element(std::size_t index) const {
  return {*file_, (*value_)[index], place_ + "[" + std::to_string(index) + "]", use_};
}

void JsonReader::requireUsed() const {
  if (value_->is_array())
    for (std::size_t i = 0; i < value_->size(); ++i)
      if ((*value_)[i].is_structured()) element(i).requireUsed();
  if (!value_->is_object()) return;
  for (auto it = value_->begin(); it != value_->end(); ++it) {
    const std::string refusal = use_->refusal(*value_, it.key());
    if (!refusal.empty()) failMember(it.key(), refusal);
    if (it->is_structured()) member(it.key(), *it).requireUsed();
  }
}

bool JsonReader::hasFormat(std::string_view format) const {
  const auto found = value_->is_object() ? find("format") : std::nullopt;
  return found && found->value_->is_string() && found->text() == format;
}

void JsonReader::requireFormat(std::string_view format, int version) const {
  if (!value_->is_object()) fail("not a JSON object");
  for (const char* key : {"format", "version"})
    if (!find(key))
      failMember(key, "missing: a file of its own begins with \"format\": \"" +
                          std::string(format) + "\", \"version\": " + std::to_string(version));
  const std::string found = at("format").text();
  if (found != format)
    failMember("format", "is '" + found + "', not '" + std::string(format) + "'");
  const std::int64_t found_version = at("version").integer();
  if (found_version != version)
    failMember("version", "version " + std::to_string(found_version) +
                              " is not supported (this program reads version " +
                              std::to_string(version) + ")");
}

void JsonReader::requireObject() const {
  if (!value_->is_object()) fail(mismatch("an object"));
}

JsonReader JsonReader::at(std::string_view key) const {
  const std::optional<JsonReader> found = find(key);
  if (!found) failMember(key, "missing");
  return *found;
}

std::optional<JsonReader> JsonReader::find(std::string_view key) const {
  requireObject();
  if (use_ != nullptr) use_->note(*value_, key);
  const auto found = value_->find(key);
  if (found == value_->end() || found->is_null()) return std::nullopt;
  return member(key, *found);
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const {
  requireObject();
  if (use_ != nullptr) use_->noteAll(*value_);
  std::vector<std::pair<std::string, JsonReader>> all;
  for (auto it = value_->begin(); it != value_->end(); ++it)
    all.emplace_back(it.key(), member(it.key(), it.value()));
  return all;
}

std::vector<JsonReader> JsonReader::elements() const {
  if (!value_->is_array()) fail(mismatch("a list"));
  std::vector<JsonReader> all;
  all.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) all.push_back(element(i));
  return all;
}

std::vector<JsonReader> JsonReader::elements(std::size_t count) const {
  if (!value_->is_array() || value_->size() != count)
    fail(mismatch(("a list of " + std::to_string(count)).c_str()));
  return elements();
}

double JsonReader::number() const {
  if (!value_->is_number()) fail(mismatch("a number"));
  const auto value = value_->get<double>();
  if (!std::isfinite(value)) fail("not a finite number");
  return value;
}

double JsonReader::number(double minimum, double maximum) const {
  const double value = number();
  if (!(value >= minimum && value <= maximum))
    fail(numberText(value) + " is outside " + numberText(minimum) + " .. " + numberText(maximum));
  return value;
}

double JsonReader::numberAbove(double bound) const {
  const double value = number();
  if (!(value > bound)) fail(numberText(value) + " is not above " + numberText(bound));
  return value;
}

std::int64_t JsonReader::integer(std::int64_t minimum, std::int64_t maximum) const {
  if (!value_->is_number()) fail(mismatch("an integer"));
  std::int64_t value = 0;
  if (value_->is_number_float()) {
    // Above 2^53 a double stands for several integers.
    const auto real = value_->get<double>();
    if (!(std::abs(real) <= 9007199254740992.0) || std::floor(real) != real)
      fail("not an integer (is " + numberText(real) + ")");
    value = static_cast<std::int64_t>(real);
  } else if (value_->is_number_unsigned() &&
             value_->get<std::uint64_t>() >
                 static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    fail("the integer is too large");
  } else {
    value = value_->get<std::int64_t>();
  }
  if (value < minimum || value > maximum)
    fail(std::to_string(value) + " is outside " + std::to_string(minimum) + " .. " +
         std::to_string(maximum));
  return value;
}

bool JsonReader::boolean() const {
  if (!value_->is_boolean()) fail(mismatch("true or false"));
  return value_->get<bool>();
}

std::string JsonReader::text() const {
  if (!value_->is_string()) fail(mismatch("a string"));
  return value_->get<std::string>();
}

std::string JsonReader::nonEmptyText() const {
  std::string value = text();
  if (value.empty()) fail("is empty");
  return value;
}

std::string JsonReader::choice(std::initializer_list<const char*> choices) const {
  std::string value = text();
  std::string list;
  for (const char* candidate : choices) {
    if (value == candidate) return value;
    list += (list.empty() ? "'" : ", '") + std::string(candidate) + "'";
  }
  fail("'" + value + "' is none of " + list);
}

Eigen::Vector2d JsonReader::vector2() const {
  const std::vector<JsonReader> all = elements(2);
  return {all[0].number(), all[1].number()};
}

Eigen::Vector3d JsonReader::vector3(double minimum, double maximum) const {
  const std::vector<JsonReader> all = elements(3);
  return {all[0].number(minimum, maximum), all[1].number(minimum, maximum),
          all[2].number(minimum, maximum)};
}

std::filesystem::path JsonReader::path(FileUse use) const {
  const std::filesystem::path named = nonEmptyText();
  const auto whole =
      (named.is_absolute() ? named : file_->parent_path() / named).lexically_normal();
  noteInput(whole, use);
  return whole;
}

JsonDocument::JsonDocument(const std::filesystem::path& file, std::string_view text)
    : file_(file),
      value_(std::make_shared<const nlohmann::json>(parse(file, textOf(file, text)))) {}

JsonDocument::JsonDocument(const std::filesystem::path& file)
    : JsonDocument(file, asText(readFileBytes(file, kMaxJsonBytes))) {}

JsonReader JsonDocument::root() const { return {file_, *value_, ""}; }

}  // namespace boresight::sessions
