// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/batch_facts.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/config_file.h"
#include "sessions/version.h"

#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

/// "value, not other", with words for what is empty.
std::string heldNotGiven(const std::string& held, const std::string& given) {
  return (held.empty() ? "none" : held) + ", not " + (given.empty() ? "none" : given);
}

/// The options in which two lists (JSON objects) differ: "pnp.seed=1, not 7".
std::string optionDifference(const std::string& held, const std::string& given) {
  const auto entry = nlohmann::json::parse(held, nullptr, false);
  const auto other = nlohmann::json::parse(given, nullptr, false);
  if (!entry.is_object() || !other.is_object()) return "others";
  nlohmann::json all = entry;
  all.update(other);
  std::string text;
  const auto value = [](const nlohmann::json& list, const std::string& name) {
    return list.contains(name) ? list[name].dump() : std::string("the profile's");
  };
  for (const auto& [name, unused] : all.items())
    if (value(entry, name) != value(other, name))
      text += (text.empty() ? "" : "; ") + name + " " + value(entry, name) + ", not " +
              value(other, name);
  return text.empty() ? "others" : text;
}

std::string processorName() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos)
      return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

MethodFacts methodFacts(const std::string& method, const std::string& profile,
                        const LocalizerOptions& options) {
  const LocalizerOptions defaults = profileOptions(profile).value_or(defaultProfile());
  MethodFacts facts;
  facts.method = method;
  facts.profile = profile;
  facts.options = toJson(changedOptions(options, defaults)).dump();
  facts.options_sha256 = optionsDigest(options);
  return facts;
}

void addMethodOptions(const OptionList& changed, MethodFacts& facts) {
  if (changed.empty()) return;
  auto all = nlohmann::ordered_json::parse(facts.options);
  all.update(toJson(changed));
  facts.options = all.dump();
  facts.options_sha256 = sha256Text(facts.options_sha256 + toJson(changed).dump());
}

DatasetFacts datasetFacts(const Dataset& dataset) {
  return {.dataset = std::filesystem::absolute(dataset.file).lexically_normal().string(),
          .dataset_sha256 = dataset.sha256,
          .cases = std::ssize(dataset.cases),
          .version = kVersion};
}

std::optional<std::string> contradiction(const DatasetFacts& held, const DatasetFacts& given) {
  if (held.dataset_sha256 != given.dataset_sha256)
    return "its runs belong to another dataset: " + held.dataset + " (SHA-256 " +
           held.dataset_sha256.substr(0, 12) + "), not " + given.dataset + " (" +
           given.dataset_sha256.substr(0, 12) + ")";
  if (held.version != given.version)
    return "its runs are from version " + heldNotGiven(held.version, given.version);
  return std::nullopt;
}

std::optional<std::string> contradiction(const MethodFacts& held, const MethodFacts& given) {
  const std::string runs = "its runs of " + held.method + " have ";
  if (held.profile != given.profile)
    return runs + "the profile " + heldNotGiven(held.profile, given.profile);
  if (held.options_sha256 != given.options_sha256)
    return runs + "other options: " + optionDifference(held.options, given.options);
  if (held.reseed_scale != given.reseed_scale)
    return runs + "further seeds drawn " + numberText(held.reseed_scale) + " times as far, not " +
           numberText(given.reseed_scale);
  if (held.mesh_of != given.mesh_of)
    return runs + "the mesh of another station: " + heldNotGiven(held.mesh_of, given.mesh_of);
  if (held.mirror != given.mirror)
    return runs + "a mirrored mesh: " + heldNotGiven(held.mirror, given.mirror);
  if (held.note != given.note) return runs + "been run with " + heldNotGiven(held.note, given.note);
  return std::nullopt;
}

BatchRun thisBatchRun() {
  BatchRun batch_run;
  batch_run.began = utcNowText();
  batch_run.version = kVersion;
  utsname name{};
  if (uname(&name) == 0) {
    batch_run.machine = name.nodename;
    batch_run.system = std::string(name.sysname) + " " + name.release + " " + name.machine;
  }
  batch_run.processor =
      processorName() + " x " + std::to_string(std::max(1U, std::thread::hardware_concurrency()));
  std::error_code error;
  batch_run.folder = std::filesystem::current_path(error).string();
  return batch_run;
}

}  // namespace boresight::sessions
