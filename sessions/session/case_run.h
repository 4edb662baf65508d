// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/io/images/image_file.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/session/session.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// What a case names, read and found to be what the session knows. Immutable; shared by those who
/// run it, show it and render it.
struct LoadedCase {
  SessionCase source;
  GrayImage image;
  SceneMesh scene;
  std::optional<IgnoreMask> ignore;  ///< mask image and strokes together
  BitImage ignore_bits;              ///< of `ignore`; must not be written through

  /// Points into this object.
  LocalizationProblem problem() const;

  LoadedCase() = default;
  LoadedCase(const LoadedCase&) = delete;
  LoadedCase& operator=(const LoadedCase&) = delete;
};

/// The image of a case, which is the one that the session knows. InputError.
GrayImage loadImage(const ImageInput& input);

/// Reads a case's inputs. InputError when one is missing, wrong, or no longer the one that the
/// session was made with. An image of another size than its camera is loaded all the same.
std::shared_ptr<const LoadedCase> loadCase(const SessionCase& session_case);
/// The same for a case that was edited, where what an edit left alone is taken from what was read
/// before.
std::shared_ptr<const LoadedCase> reloadCase(const LoadedCase& before,
                                             const SessionCase& session_case);

/// InputError when a run makes no sense: image and camera differ in size, the camera's distortion
/// folds back in the image, the station is out of view, behind the camera, or of a size that only a
/// wrong unit explains.
void requireRunnable(const LoadedCase& loaded);

/// Runs a case of the session as it is: the one function behind `whs run` and the desktop program,
/// so that both get the same digest. A stop leaves the status at kRunning. InputError for inputs
/// or options that cannot be run.
LocalizationTrace runCase(const Session& session, const LoadedCase& loaded,
                          RecordLevel level = RecordLevel::kFull, const std::stop_token& stop = {});
/// The same with a plan of its own instead of the session's options.
LocalizationTrace runCase(const LoadedCase& loaded, const RunPlan& plan,
                          RecordLevel level = RecordLevel::kFull, const std::stop_token& stop = {});
/// The same, with the inputs read first.
LocalizationTrace runCase(const Session& session, const std::string& case_id,
                          RecordLevel level = RecordLevel::kFull, const std::stop_token& stop = {});

/// The plan by which a recorded run was run: its own when it took up options on its way, else the
/// session's. InputError when the case's inputs are no longer those of the run, or the session's
/// options are not.
RunPlan planOf(const RunRecord& run, const Session& session, const std::filesystem::path& file);

/// Writes the trace into the session's folder of runs, unless a run of the same digest is there
/// already, and says what to note of it. `session` is the one that ran. OutputError. A run that was
/// stopped is no run: std::logic_error. `from` is the digest of the run that it went on from, for
/// one that took up options on its way.
RunRecord storeRun(const Session& session, const std::string& case_id,
                   const LocalizationTrace& trace, const std::filesystem::path& session_file,
                   const std::string& from = {});

/// Notes a run; one of the same case, digest, inputs and options is moved to the end.
Session withRun(const Session& session, RunRecord run);

/// The trace of a run. InputError when the file is missing, damaged, of another run, or ended
/// otherwise than the record states.
LocalizationTrace loadRun(const RunRecord& run);
/// The same to be looked at, with the views that it was made together with.
LocalizationTrace loadSnapshot(const RunRecord& run);

}  // namespace boresight::sessions
