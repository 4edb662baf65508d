// SPDX-License-Identifier: Apache-2.0
// What the subcommands of whs share: common arguments, messages.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/exit_codes.h"
#include "core/base/kernels.h"
#include "core/localizer/localizer_options.h"
#include "sessions/baselines/methods.h"
#include "sessions/io/config_file.h"
#include "sessions/io/pose_file.h"
#include "sessions/io/scene_mesh.h"

namespace boresight::sessions {
struct MethodOptions;
}

namespace boresight::app {

/// Each adds its subcommand; what that returns when it was called goes to `exit_code`.
void addLocalize(CLI::App& app, int& exit_code);
void addEvaluate(CLI::App& app, int& exit_code);
void addCompare(CLI::App& app, int& exit_code);
void addCheck(CLI::App& app, int& exit_code);
void addDecide(CLI::App& app, int& exit_code);
void addReport(CLI::App& app, int& exit_code);
void addVerify(CLI::App& app, int& exit_code);
void addViews(CLI::App& app, int& exit_code);
void addQueue(CLI::App& app, int& exit_code);
void addSolve(CLI::App& app, int& exit_code);
void addRender(CLI::App& app, int& exit_code);
void addCamera(CLI::App& app, int& exit_code);
void addInfo(CLI::App& app, int& exit_code);
void addOptions(CLI::App& app, int& exit_code);
void addBench(CLI::App& app, int& exit_code);
void addNew(CLI::App& app, int& exit_code);
void addRun(CLI::App& app, int& exit_code);
void addPack(CLI::App& app, int& exit_code);
void addExport(CLI::App& app, int& exit_code);
void addImport(CLI::App& app, int& exit_code);
void addProblem(CLI::App& app, int& exit_code);
void addMerge(CLI::App& app, int& exit_code);
void addTables(CLI::App& app, int& exit_code);
void addDocuments(CLI::App& app, int& exit_code);

/// A line to stderr for people, and one to stdout. What text from outside has in it does not break
/// the line.
void note(const std::string& line);
void print(const std::string& line);

/// --mesh-unit: a unit of length that is known.
CLI::Option* addMeshUnit(CLI::App& command, std::string& unit, const std::string& help);

/// --mesh and --mesh-unit.
struct MeshArguments {
  std::string mesh;
  std::string unit;

  void addTo(CLI::App& command);
  /// One matched part in its own frame. InputError.
  sessions::SceneMesh read() const;
};

/// What an option must be: a finite number of this range.
CLI::Validator numberIn(double least, double most);

/// --uncertainty: three lengths in m, three angles in deg.
CLI::Option* addUncertainty(CLI::App& command, std::vector<double>& values,
                            const std::string& help);
/// CLI::ValidationError.
void setUncertainty(const std::vector<double>& values, sessions::DeclaredUncertainty& uncertainty);

/// --threads: how many a run may use.
void addThreads(CLI::App& command, int& threads);

/// --kernels, for those who compare them: hidden from the help.
void addKernels(CLI::App& command, Kernels& kernels);

/// --profile, --config and --set: where the parameters of a run come from.
struct OptionArguments {
  std::string profile;
  std::string config;
  std::vector<std::string> assignments;

  void addTo(CLI::App& command);
  /// Profile, then config, then --set. InputError for the config, CLI::ValidationError for --set.
  LocalizerOptions read() const;
  /// The same for the methods beside WHS, whose options stand in the same places.
  sessions::MethodOptions readMethodOptions() const;
  /// "paper", "default" or "flight": the one asked for, else the config's.
  std::string profileName() const;
  /// Bytes for a run and its inputs; 0 where the profile sets no limit.
  std::size_t memoryLimit() const;
};

/// --transform: what joins the frame of a pose to that of a camera model.
struct FrameArguments {
  std::vector<std::string> files;

  void addTo(CLI::App& command);
  /// InputError.
  sessions::PoseFrames of(const sessions::CameraFile& camera) const;
};

/// What --camera takes, for its help.
inline constexpr const char* kCameraHelp =
    "camera.json, a .cahvor file, or an image whose label has a camera model";
/// The same where the image's own label does without it.
inline constexpr const char* kOwnCameraHelp =
    "camera.json, a .cahvor file, or an image whose label has a camera model; without it the "
    "label of the image itself";

/// --method and --matcher: how to localize.
struct MethodArguments {
  std::vector<std::string> methods = {sessions::kWhs};
  std::string matcher;

  /// Names that do not exist are refused with those that do.
  void addTo(CLI::App& command, bool several);
  bool needsSetup() const;
  /// With the options of the methods among `options`. InputError, CLI::ValidationError.
  sessions::MethodSetup setup(const OptionArguments& options) const;
  /// What differs from their defaults, of methods that are not WHS.
  sessions::OptionList changedOptions(const sessions::MethodOptions& options) const;
};

LocalizerOptions profileOptions(const std::string& name);

/// "12.3 mm" for people.
std::string millimetresText(double length_m);

}  // namespace boresight::app
