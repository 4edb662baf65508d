// SPDX-License-Identifier: Apache-2.0
#include "app/commands.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

#include "sessions/baselines/method_options.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/run/runner.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::app {

void FrameArguments::addTo(CLI::App& command) {
  addFile(command, "--frames", files,
          "frames.json or transform.json: transforms between named frames; may be repeated");
}

sessions::PoseFrames FrameArguments::of(const sessions::CameraFile& camera) const {
  return {camera.reference, sessions::readFrameTransforms(files)};
}

void MethodArguments::addTo(CLI::App& command, bool several) {
  CLI::Option* option = command.add_option(
      "--method", methods,
      std::string(several ? "Methods to run, one after the other: " : "Method to run: ") +
          sessions::methodNames());
  option->type_name("M")->default_str(sessions::kWhs)->check([](const std::string& name) {
    return sessions::isMethod(name)
               ? std::string()
               : "there is no method \"" + name + "\"; there are: " + sessions::methodNames();
  });
  if (!several) option->expected(1);
  addOption(command, "--matcher", "COMMAND", matcher,
            "Command of the external matcher (methods external, loftr-r, loftr-s), e.g. "
            "\"node resources/matchers/loftr/loftr.js --model M.onnx\"");
}

bool MethodArguments::needsSetup() const {
  return std::ranges::any_of(methods,
                             [](const std::string& name) { return name != sessions::kWhs; });
}

sessions::MethodSetup MethodArguments::setup(const OptionArguments& options) const {
  for (const std::string& name : methods)
    if (sessions::needsMatcher(name) && matcher.empty())
      throw CLI::ValidationError("--matcher",
                                 "the method " + name + " needs its matcher's command");
  return {options.readMethodOptions(), matcher};
}

sessions::OptionList MethodArguments::changedOptions(const sessions::MethodOptions& options) const {
  if (!needsSetup()) return {};
  return sessions::changedOptions(options, sessions::MethodOptions());
}

namespace {

constexpr const char* kFlightProfile = "flight";

bool isMethodOption(const std::string& name) {
  const auto all = sessions::listOptions(sessions::MethodOptions());
  return std::ranges::find(all, name, &sessions::OptionDescription::name) != all.end();
}

/// Sets what the config, then the assignments name: options of methods, or all others.
template <class Options>
void applyTo(Options& options, const std::string& config, const std::vector<std::string>& set,
             bool of_methods) {
  if (!config.empty()) {
    sessions::Config read = sessions::readConfig(config);
    std::erase_if(read.options,
                  [=](const auto& item) { return isMethodOption(item.first) != of_methods; });
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

void requireWritable(const std::vector<std::string>& files) {
  for (const std::string& file : files)
    if (!file.empty()) sessions::requireWritable(file);
}

std::string errorText(const sessions::PoseError& error) {
  return "normal " + sessions::fixedText(error.normal_mm, 3) + " mm, lateral " +
         sessions::fixedText(error.lateral_mm, 3) + " mm, rotation " +
         sessions::fixedText(error.rotation_mrad, 3) + " mrad";
}

CLI::Option* addMeshUnit(CLI::App& command, std::string& unit, const std::string& help) {
  return addOption(command, "--mesh-unit", "UNIT", unit, help)->check([](const std::string& text) {
    return sessions::metresPerUnit(text)
               ? std::string()
               : "unknown unit \"" + text + "\" (m, dm, cm, mm, um, in, ft, yd, km)";
  });
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
  return addOption(command, "--uncertainty", "TX TY TZ RX RY RZ", values, help)
      ->expected(6)
      ->check(numberIn(0.0, 1000.0));
}

void setUncertainty(const std::vector<double>& values, sessions::DeclaredUncertainty& uncertainty) {
  if (values.empty()) return;
  uncertainty.translation_m = {values[0], values[1], values[2]};
  uncertainty.rotation_deg = {values[3], values[4], values[5]};
  if (uncertainty.rotation_deg.maxCoeff() > 180.0)
    throw CLI::ValidationError("--uncertainty", "the angles are at most 180 deg");
}

void addThreads(CLI::App& command, int& threads) {
  addOption(command, "--threads", "N", threads,
            "Threads of a run; 0: one per core. The result is the same with any number")
      ->check(CLI::Range(0, Localizer::kMaxWorkers))
      ->capture_default_str();
}

void addRecover(CLI::App& command, bool& recover) {
  command.add_flag("--recover", recover,
                   "Recover edits that a killed program left in the session's journal");
}

std::vector<Kernels> availableKernels() {
  std::vector<Kernels> available;
  for (int set = 0; set < kKernelSets; ++set)
    if (kernelsAvailable(static_cast<Kernels>(set))) available.push_back(static_cast<Kernels>(set));
  return available;
}

void addKernels(CLI::App& command, Kernels& kernels) {
  std::map<std::string, Kernels> named = {{"best", bestKernels()}};
  std::string names = "best";
  for (const Kernels item : availableKernels()) {
    named.emplace(kernelsName(item), item);
    names += std::string(", ") + kernelsName(item);
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
          "Instruction set that is used; the result is the same")
      ->group("");
}

LocalizerOptions profileOptions(const std::string& name) {
  LocalizerOptions options = sessions::profileOptions(name).value_or(defaultProfile());
  if (name == kFlightProfile) options.search.color = false;
  return options;
}

sessions::MethodOptions methodProfile(const std::string& name) {
  return name == "paper" ? sessions::publishedMethods() : sessions::MethodOptions();
}

void OptionArguments::addTo(CLI::App& command) {
  addChoice(command, "--profile", profile, {"default", "paper", "flight"},
            "Set of options: default (recommended settings), paper (as published), or flight "
            "(default for gray images; localize, follow and evaluate stay within 10,000,000 bytes "
            "including image and mesh)");
  addFile(command, "--config", config, "config.json: a profile and options that differ from it");
  addOption(command, "--set", "NAME=VALUE", assignments,
            "Sets an option, e.g. pnp.seed=7; `whs options` lists all");
}

LocalizerOptions OptionArguments::read() const {
  LocalizerOptions options = profileOptions(profileName());
  applyTo(options, config, assignments, false);
  return options;
}

sessions::MethodOptions OptionArguments::readMethodOptions() const {
  sessions::MethodOptions options = methodProfile(profileName());
  applyTo(options, config, assignments, true);
  return options;
}

std::string OptionArguments::profileName() const {
  if (!profile.empty()) return profile;
  if (config.empty()) return "default";
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

void OptionArguments::noteUnlimited() const {
  if (memoryLimit() > 0)
    note("only localize, follow and evaluate have the memory limit of profile " + profileName());
}

namespace {

/// CLI::ValidationError.
std::vector<sessions::PartChange> partChanges(const std::vector<std::string>& texts) {
  std::vector<sessions::PartChange> changes;
  for (const std::string& text : texts) {
    const std::size_t sign = text.rfind('=');
    if (sign == std::string::npos || sign == 0)
      throw CLI::ValidationError("--part", "\"" + text + "\" is not NAME=STATE, e.g. lid=off");
    changes.push_back({text.substr(0, sign), text.substr(sign + 1)});
  }
  return changes;
}

}  // namespace

void DatasetArguments::addTo(CLI::App& command) {
  addOption(command, "--part", "NAME=STATE", parts,
            std::string("State of a part of the station in all cases, e.g. lid=off: ") +
                sessions::kStateChanges);
  const char* group = "Of a BOP folder";
  addOption(command, "--split", "NAME", selection.split,
            "Split of a BOP folder, e.g. val (default: test, or the only one)")
      ->group(group);
  addOption(command, "--scene", "N", selection.scenes, "Only these scenes")->group(group);
  addOption(command, "--obj", "N", selection.objects, "Only these objects")->group(group);
  addOption(command, "--sensor", "NAME", selection.sensor,
            "Sensor of a BOP folder with several: scene_camera_NAME.json")
      ->group(group);
  command
      .add_flag("--every-instance", selection.every_instance,
                "Includes instances that the challenge leaves out or that are hardly visible")
      ->group(group);
  addUncertainty(command, uncertainty,
                 "Largest error of the drawn seeds along and about x, y, z of the camera: three "
                 "lengths in m, three angles in deg (default: 0.03 m, 10 deg)")
      ->group(group);
  addChoice(command, "--pivot", pivot, {"camera", "station"},
            "Centre of the seed's rotation uncertainty (default: station)")
      ->group(group);
}

sessions::Dataset DatasetArguments::open() const {
  const bool chooses = !selection.split.empty() || !selection.sensor.empty() ||
                       !selection.scenes.empty() || !selection.objects.empty() ||
                       !uncertainty.empty() || !pivot.empty() || selection.every_instance;
  if (chooses && !std::filesystem::is_directory(path))
    throw CLI::ValidationError(
        "--split, --scene, --obj, --sensor, --every-instance, "
        "--uncertainty, --pivot",
        "choose of a BOP folder, which " + path + " is not");
  sessions::BopSelection chosen = selection;
  setUncertainty(uncertainty, chosen.uncertainty);
  if (pivot == "camera") chosen.uncertainty.pivot = sessions::UncertaintyPivot::kCamera;
  return sessions::withPartStates(sessions::openDataset(path, chosen), partChanges(parts));
}

namespace {

void sayNotices(const sessions::SessionDocument& document, std::size_t first = 0) {
  for (std::size_t i = first; i < document.notices().size(); ++i) note(document.notices()[i]);
}

}  // namespace

sessions::SessionDocument openToRead(const std::string& file) {
  auto document = sessions::SessionDocument::open(file, sessions::Access::kReadOnly);
  sayNotices(document);
  document.requireNothingUnsaved();
  return document;
}

sessions::SessionDocument openToEdit(const std::string& file, bool recover,
                                     sessions::Access access) {
  auto document = sessions::SessionDocument::open(file, access);
  if (document.readOnly()) throw sessions::OutputError(document.file(), document.readOnlyReason());
  sayNotices(document);
  if (!recover) document.requireNothingUnsaved();
  if (!document.recovery()) return document;
  const std::vector<std::string> edits = document.recovery()->edits;
  const std::size_t said = document.notices().size();
  document.saveRecovery();
  sayNotices(document, said);
  for (const std::string& edit : edits) note("edit taken from the journal and saved: " + edit);
  return document;
}

const sessions::SessionCase& requireCase(const sessions::SessionDocument& document,
                                         const std::string& case_id) {
  const sessions::SessionCase* found = document.session().findCase(case_id);
  if (found == nullptr)
    throw sessions::InputError(document.file(), "cases", "there is no case '" + case_id + "'");
  return *found;
}

std::vector<std::string> requestedCases(const sessions::SessionDocument& document,
                                        const std::vector<std::string>& case_ids) {
  for (const std::string& id : case_ids) (void)requireCase(document, id);
  if (!case_ids.empty()) return case_ids;
  std::vector<std::string> all;
  for (const auto& session_case : document.session().cases) all.push_back(session_case->id);
  return all;
}

const sessions::RunRecord& recordedRun(const sessions::SessionDocument& document,
                                       const std::string& beginning) {
  const sessions::RunRecord* found = nullptr;
  for (const sessions::RunRecord& run : document.session().runs) {
    if (!run.digest.starts_with(beginning)) continue;
    if (found != nullptr && found->digest != run.digest)
      throw sessions::InputError(document.file(), "runs",
                                 "more than one digest begins with " + beginning);
    found = &run;
  }
  if (found == nullptr)
    throw sessions::InputError(document.file(), "runs", "no digest begins with " + beginning);
  return *found;
}

}  // namespace boresight::app
