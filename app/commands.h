// SPDX-License-Identifier: Apache-2.0
// Shared by the subcommands of whs: common arguments, messages.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/add_option.h"
#include "app/exit_codes.h"
#include "app/log_option.h"
#include "core/base/kernels.h"
#include "core/localizer/localizer_options.h"
#include "sessions/baselines/methods.h"
#include "sessions/evaluation/bop_dataset.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/session/session_document.h"

namespace boresight::sessions {
struct MethodOptions;
}

namespace boresight::app {

/// Each adds its subcommand, which sets `exit_code` when it is called.
using AddCommand = void(CLI::App& app, int& exit_code);
AddCommand addLocalize, addEvaluate, addMerge, addTables, addCompare, addCheck, addDecide;
AddCommand addVerify, addViews, addReport, addQueue, addSolve, addRender, addCamera, addInfo;
AddCommand addOptions, addNew, addRun, addPack, addExport, addImport, addProblem, addBench;
AddCommand addDocuments, addTrends, addCalibrate, addHandEye, addFollow;

/// Adds a subcommand. `Arguments::addTo` adds its options; the arguments live as long as the
/// subcommand and are passed to `run`.
template <class Arguments>
void addCommand(CLI::App& app, int& exit_code, const std::string& name, const std::string& help,
                int (*run)(Arguments&)) {
  auto arguments = std::make_shared<std::remove_const_t<Arguments>>();
  CLI::App* command = app.add_subcommand(name, help);
  arguments->addTo(*command);
  addLogLevel(*command)->group("");
  command->callback([command, arguments, run, &exit_code] {
    if (!command->get_group().empty()) beginLog("whs");  // not of commands that build documents
    exit_code = run(*arguments);
  });
}

/// Print a readable line to stderr and to stdout. Text from outside cannot break the line.
void note(const std::string& line);
void print(const std::string& line);

/// OutputError unless all of these files can be written; empty names are outputs that were not
/// requested.
void requireWritable(const std::vector<std::string>& files);

/// "normal 0.012 mm, lateral 0.034 mm, rotation 0.567 mrad".
std::string errorText(const sessions::PoseError& error);

/// Help of --mesh and of --mesh-unit.
inline constexpr const char* kMeshHelp = "Mesh of the station: PLY, OBJ, STL, glTF or GLB";
inline constexpr const char* kMeshUnitHelp =
    "Unit of the mesh's coordinates: m, mm, cm, in, ... (required unless glTF)";

/// --mesh-unit: a known unit of length.
CLI::Option* addMeshUnit(CLI::App& command, std::string& unit, const std::string& help);

/// Accepts a finite number in this range.
CLI::Validator numberIn(double least, double most);

/// --uncertainty: three lengths in m, three angles in deg.
CLI::Option* addUncertainty(CLI::App& command, std::vector<double>& values,
                            const std::string& help);
/// CLI::ValidationError.
void setUncertainty(const std::vector<double>& values, sessions::DeclaredUncertainty& uncertainty);

/// --threads: largest number of threads of a run.
void addThreads(CLI::App& command, int& threads);

/// The kernels that are available on this machine.
std::vector<Kernels> availableKernels();

/// --recover: accepts unsaved edits of a session.
void addRecover(CLI::App& command, bool& recover);

/// --kernels, for comparisons: hidden from the help.
void addKernels(CLI::App& command, Kernels& kernels);

/// --profile, --config and --set: source of the parameters of a run.
struct OptionArguments {
  std::string profile;
  std::string config;
  std::vector<std::string> assignments;

  void addTo(CLI::App& command);
  /// Profile, then config, then --set. InputError for the config, CLI::ValidationError for --set.
  LocalizerOptions read() const;
  /// Options of the other methods, from the same sources.
  sessions::MethodOptions readMethodOptions() const;
  /// "paper", "default" or "flight": the profile requested, else the config's.
  std::string profileName() const;
  /// Bytes for a run and its inputs; 0 where the profile sets no limit.
  std::size_t memoryLimit() const;
  /// For commands without that limit: prints a note where the profile sets it.
  void noteUnlimited() const;
};

/// --frames: transforms that join the frame of a pose to that of a camera model.
struct FrameArguments {
  std::vector<std::string> files;

  void addTo(CLI::App& command);
  /// InputError.
  sessions::PoseFrames of(const sessions::CameraFile& camera) const;
};

/// Values of --camera, for its help.
inline constexpr const char* kCameraHelp =
    "camera.json, a .cahvor file, or an image whose label has a camera model";
/// The same where the image's label is the default.
inline constexpr const char* kOwnCameraHelp =
    "camera.json, a .cahvor file, or an image whose label has a camera model; without it the "
    "label of the image itself";

/// --method and --matcher: how to localize.
struct MethodArguments {
  std::vector<std::string> methods = {sessions::kWhs};
  std::string matcher;

  /// Unknown names are rejected with a list of the known ones.
  void addTo(CLI::App& command, bool several);
  bool needsSetup() const;
  /// Includes the options of methods from `options`. InputError, CLI::ValidationError.
  sessions::MethodSetup setup(const OptionArguments& options) const;
  /// Options of methods other than WHS that differ from their defaults.
  sessions::OptionList changedOptions(const sessions::MethodOptions& options) const;
};

/// The dataset of --dataset: a dataset.json, or a selection of a BOP folder.
struct DatasetArguments {
  std::string path;
  sessions::BopSelection selection;  ///< except uncertainty and pivot
  std::vector<double> uncertainty;
  std::string pivot;
  std::vector<std::string> parts;  ///< NAME=STATE

  /// --part, --split, --scene, --obj, --sensor, --every-instance, --uncertainty and --pivot. The
  /// caller adds the option of the path.
  void addTo(CLI::App& command);
  /// InputError; CLI::ValidationError when a selection is given for a path that is not a folder.
  sessions::Dataset open() const;
};

/// Opens a session to be read only; prints its notices to stderr. InputError when it has unsaved
/// edits to be recovered.
sessions::SessionDocument openToRead(const std::string& file);

/// Opens a session to be changed. InputError as above unless `recover` accepts these edits, which
/// are then saved and printed to stderr; OutputError when another program has the session open or
/// it cannot be written.
sessions::SessionDocument openToEdit(const std::string& file, bool recover,
                                     sessions::Access access = sessions::Access::kEdit);

/// InputError when the session has no such case.
const sessions::SessionCase& requireCase(const sessions::SessionDocument& document,
                                         const std::string& case_id);

/// `case_ids`, or the ids of all cases if it is empty. InputError when the session lacks one.
std::vector<std::string> requestedCases(const sessions::SessionDocument& document,
                                        const std::vector<std::string>& case_ids);

/// The recorded run whose digest begins with `beginning`; InputError unless there is exactly one.
const sessions::RunRecord& recordedRun(const sessions::SessionDocument& document,
                                       const std::string& beginning);

LocalizerOptions profileOptions(const std::string& name);
/// Options of the other methods: `paper` as published, otherwise tuned.
sessions::MethodOptions methodProfile(const std::string& name);

}  // namespace boresight::app
