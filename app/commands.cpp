// SPDX-License-Identifier: Apache-2.0
#include "app/commands.h"

#include <algorithm>
#include <iostream>
#include <map>

#include "sessions/baselines/method_options.h"
#include "sessions/io/mesh_container.h"
#include "sessions/run/runner.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::app {

void FrameArguments::addTo(CLI::App& command) {
  command
      .add_option("--transform", files,
                  "transform.json between the frame that a pose names and that of the camera "
                  "model; may be repeated")
      ->type_name("FILE");
}

sessions::PoseFrames FrameArguments::of(const sessions::CameraFile& camera) const {
  return {camera.reference, sessions::readFrameTransforms(files)};
}

void MethodArguments::addTo(CLI::App& command, bool several) {
  CLI::Option* option =
      command.add_option("--method", methods,
                         std::string(several ? "How to localize, one after the other; there are: "
                                             : "How to localize; there are: ") +
                             sessions::methodNames());
  option->type_name("M")->default_str(sessions::kWhs)->check([](const std::string& name) {
    return sessions::isMethod(name)
               ? std::string()
               : "there is no method \"" + name + "\"; there are: " + sessions::methodNames();
  });
  if (!several) option->expected(1);
  command
      .add_option("--matcher", matcher,
                  "Command of the external matcher of the methods external, loftr-r and loftr-s, "
                  "e.g. \"node resources/matchers/loftr/loftr.js --model M.onnx\"")
      ->type_name("COMMAND");
}

bool MethodArguments::needsSetup() const {
  return std::any_of(methods.begin(), methods.end(),
                     [](const std::string& name) { return name != sessions::kWhs; });
}

sessions::MethodSetup MethodArguments::setup(const OptionArguments& options) const {
  for (const std::string& name : methods)
    if (sessions::needsMatcher(name) && matcher.empty())
      throw CLI::ValidationError("--matcher",
                                 "the method " + name + " needs its matcher's command");
  sessions::MethodSetup made;
  made.matcher = matcher;
  made.options = options.readMethodOptions();
  return made;
}

sessions::OptionList MethodArguments::changedOptions(const sessions::MethodOptions& options) const {
  if (!needsSetup()) return {};
  return sessions::changedOptions(options, sessions::MethodOptions());
}

namespace {

constexpr const char* kDefaultProfile = "default";
constexpr const char* kFlightProfile = "flight";

bool isMethodOption(const std::string& name) {
  const auto all = sessions::listOptions(sessions::MethodOptions());
  return std::any_of(all.begin(), all.end(),
                     [&name](const sessions::OptionDescription& one) { return one.name == name; });
}

/// Sets what the config, then the assignments name: options of methods, or all others.
template <class Options>
void applyTo(Options& options, const std::string& config, const std::vector<std::string>& set,
             bool of_methods) {
  if (!config.empty()) {
    sessions::Config read = sessions::readConfig(config);
    std::erase_if(read.options,
                  [=](const auto& one) { return isMethodOption(one.first) != of_methods; });
    sessions::applyConfig(options, read);
  }
  for (const std::string& assignment : set) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw CLI::ValidationError("--set", "needs NAME=VALUE");
    const std::string name = assignment.substr(0, equals);
    if (isMethodOption(name) != of_methods) continue;
    try {
      sessions::applyOptionText(options, name, std::string_view(assignment).substr(equals + 1));
    } catch (const sessions::OptionError& error) {
      throw CLI::ValidationError("--set", error.what());
    }
  }
}

}  // namespace

void note(const std::string& line) { std::cerr << "whs: " << sessions::plainLine(line); }

void print(const std::string& line) { std::cout << sessions::plainLine(line) << std::flush; }

std::string millimetresText(double length_m) {
  return sessions::fixedText(length_m * 1e3, 3) + " mm";
}

CLI::Option* addMeshUnit(CLI::App& command, std::string& unit, const std::string& help) {
  return command.add_option("--mesh-unit", unit, help)
      ->check([](const std::string& text) {
        return sessions::metresPerUnit(text)
                   ? std::string()
                   : "unknown unit \"" + text + "\" (m, dm, cm, mm, um, in, ft, yd, km)";
      })
      ->type_name("UNIT");
}

void MeshArguments::addTo(CLI::App& command) {
  command.add_option("--mesh", mesh, "Mesh of the station: PLY, OBJ, STL, glTF or GLB")
      ->required()
      ->type_name("FILE");
  addMeshUnit(command, unit,
              "Unit of the mesh's coordinates: m, mm, cm, in, ... (required unless glTF)");
}

sessions::SceneMesh MeshArguments::read() const {
  sessions::PartSource part;
  part.mesh = mesh;
  part.mesh_unit = unit;
  return sessions::readScene({&part, 1});
}

CLI::Validator numberIn(double least, double most) {
  const std::string first = sessions::numberText(least), last = sessions::numberText(most);
  return {[=](std::string& text) {
            double value = 0.0;
            const bool good =
                CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
            return good ? std::string()
                        : "\"" + text + "\" is not a number from " + first + " to " + last;
          },
          "FLOAT in [" + first + " - " + last + "]"};
}

CLI::Option* addUncertainty(CLI::App& command, std::vector<double>& values,
                            const std::string& help) {
  return command.add_option("--uncertainty", values, help)
      ->expected(6)
      ->check(numberIn(0.0, 1000.0))
      ->type_name("TX TY TZ RX RY RZ");
}

void setUncertainty(const std::vector<double>& values, sessions::DeclaredUncertainty& uncertainty) {
  if (values.empty()) return;
  uncertainty.translation_m = {values[0], values[1], values[2]};
  uncertainty.rotation_deg = {values[3], values[4], values[5]};
  if (uncertainty.rotation_deg.maxCoeff() > 180.0)
    throw CLI::ValidationError("--uncertainty", "the angles are at most 180 deg");
}

void addThreads(CLI::App& command, int& threads) {
  command
      .add_option("--threads", threads,
                  "Threads of a run; 0: one per core. The result is the same with any number")
      ->check(CLI::Range(0, Localizer::kMaxWorkers))
      ->capture_default_str()
      ->type_name("N");
}

void addKernels(CLI::App& command, Kernels& kernels) {
  std::map<std::string, Kernels> named = {{"best", bestKernels()}};
  std::string names = "best";
  for (int k = 0; k < kKernelSets; ++k) {
    const Kernels one = static_cast<Kernels>(k);
    if (!kernelsAvailable(one)) continue;
    named.emplace(kernelsName(one), one);
    names += std::string(", ") + kernelsName(one);
  }
  command
      .add_option_function<std::string>(
          "--kernels",
          [&kernels, named, names](const std::string& name) {
            const auto found = named.find(name);
            if (found == named.end())
              throw CLI::ValidationError("--kernels", "this machine has " + names);
            kernels = found->second;
          },
          "What to use of the processor; the result is the same")
      ->group("");
}

LocalizerOptions profileOptions(const std::string& name) {
  LocalizerOptions options = sessions::profileOptions(name).value_or(defaultProfile());
  if (name == kFlightProfile) options.search.color = false;
  return options;
}

void OptionArguments::addTo(CLI::App& command) {
  command
      .add_option(
          "--profile", profile,
          "Set of parameters: default (whatever is best), paper (as published), or flight "
          "(the default's on gray images, within 10,000,000 bytes of memory, image and mesh "
          "included)")
      ->check(CLI::IsMember({"default", "paper", "flight"}));
  command.add_option("--config", config, "config.json: a profile and the options that differ")
      ->type_name("FILE");
  command
      .add_option("--set", assignments,
                  "Option that differs, e.g. pnp.seed=7; `whs options` lists them all")
      ->type_name("NAME=VALUE");
}

LocalizerOptions OptionArguments::read() const {
  LocalizerOptions options = profileOptions(profileName());
  applyTo(options, config, assignments, false);
  return options;
}

sessions::MethodOptions OptionArguments::readMethodOptions() const {
  sessions::MethodOptions options;
  applyTo(options, config, assignments, true);
  return options;
}

std::string OptionArguments::profileName() const {
  if (!profile.empty()) return profile;
  if (config.empty()) return kDefaultProfile;
  const sessions::Config read = sessions::readConfig(config);
  if (read.profile != "default" && read.profile != "paper" && read.profile != kFlightProfile)
    throw sessions::InputError(
        config, "profile",
        "there is no profile \"" + read.profile + "\"; there are: default, paper, flight");
  return read.profile;
}

std::size_t OptionArguments::memoryLimit() const {
  return profileName() == kFlightProfile ? sessions::kFlightMemoryBytes : 0;
}

}  // namespace boresight::app
