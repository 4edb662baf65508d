// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/config_file.h"

#include <nlohmann/json.hpp>

#include "core/base/digest.h"
#include "core/record/parameter_table.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr const char* kConfigFormat = "boresight-config";
constexpr int kConfigVersion = 1;

OptionValue readValue(const JsonReader& json) {
  if (json.value().is_boolean()) return json.boolean();
  if (json.value().is_number_integer()) return json.integer();
  if (json.value().is_number()) return json.number();
  if (json.value().is_string()) return json.text();
  json.fail("not a number, true, false, or a name");
}

}  // namespace

std::optional<LocalizerOptions> profileOptions(const std::string& name) {
  if (name == "default") return defaultProfile();
  if (name == "paper") return paperProfile();
  return std::nullopt;
}

const char* profileNames() { return "default, paper"; }

OptionList readOptions(const JsonReader& json) {
  OptionList options;
  for (const auto& [name, value] : json.members()) options.emplace_back(name, readValue(value));
  return options;
}

namespace {

/// Every option of a parameter table.
Config readParameters(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  LocalizerOptions options;
  const ProblemCheck check = decodeParameters(bytes, options);
  if (check.fault != ProblemFault::kNone)
    throw InputError(file, check.option != nullptr ? check.option : "",
                     problemFaultText(check.fault));
  Config config;
  config.file = file;
  for (const OptionDescription& option : listOptions(options))
    config.options.emplace_back(option.name, option.value);
  return config;
}

}  // namespace

Config readConfig(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes);
  if (isParameterTable(bytes)) return readParameters(file, bytes);
  const JsonDocument document(file, asText(bytes));
  return document.read(kConfigFormat, kConfigVersion, [&file](const JsonReader& json) {
    Config config;
    config.file = file;
    json.optional("profile", config.profile, &JsonReader::nonEmptyText);
    json.optional("options", config.options, readOptions);
    return config;
  });
}

nlohmann::ordered_json toJson(const OptionList& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : options)
    std::visit([&json, &key = name](const auto& plain) { json[key] = plain; }, value);
  return json;
}

std::string optionsDigest(const LocalizerOptions& options) {
  DigestWriter writer;
  LocalizerOptions::visitFields(options, [&writer](const OptionInfo& info, const auto& field) {
    writer.tag(info.name);
    writer.f64(static_cast<double>(field));
  });
  return hexText(writer.digest()).data();
}

LocalizerOptions withFeatureSize(LocalizerOptions options, std::optional<double> feature_size_m) {
  if (options.templates.feature_size_m == 0.0)
    options.templates.feature_size_m = feature_size_m.value_or(0.0);
  return options;
}

}  // namespace boresight::sessions
