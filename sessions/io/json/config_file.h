// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/localizer/localizer_options.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/option_value.h"

namespace boresight::sessions {

/// config.json (`boresight-config`, version 1): a profile and the options that differ from it.
/// `file` names it in messages.
struct Config {
  std::filesystem::path file;
  std::string profile = "default";
  OptionList options;
};

/// The options of a profile: "default" or "paper"; empty for another name.
std::optional<LocalizerOptions> profileOptions(const std::string& name);
/// "default, paper", for messages.
const char* profileNames();

/// Reads config.json, whose values are checked when they are applied, or a parameter table
/// (core/record/parameter_table.h) with every option. InputError.
Config readConfig(const std::filesystem::path& file);

/// SHA-256 over every option, by name and value: any difference makes a run stale.
std::string optionsDigest(const LocalizerOptions& options);

/// {name: value, ...}; a number that is not finite throws std::logic_error when written.
nlohmann::ordered_json toJson(const OptionList& options);
/// Inverse of toJson: each member must be true/false, a number, or a string.
OptionList readOptions(const JsonReader& json);

/// Sets the options that the config names. InputError (file, options.NAME, reason) when an option
/// does not exist or cannot have its value; then `options` is unchanged.
template <class Options>
void applyConfig(Options& options, const Config& config) {
  Options changed = options;
  for (const auto& [name, value] : config.options) {
    try {
      applyOption(changed, name, value);
    } catch (const OptionError& error) {
      throw InputError(config.file, "options." + name, error.reason());
    }
  }
  options = changed;
}

/// The options with a case's feature size where they state none.
LocalizerOptions withFeatureSize(LocalizerOptions options, std::optional<double> feature_size_m);

}  // namespace boresight::sessions
