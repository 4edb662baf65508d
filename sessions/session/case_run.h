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

/// The inputs of a case, read and verified by the session's hashes. Immutable; shared by runs,
/// views and renderers.
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

/// Reads a case's inputs. InputError when one is missing, invalid, or changed since the session was
/// made. An image whose size differs from its camera's is loaded, too.
std::shared_ptr<const LoadedCase> loadCase(const SessionCase& session_case);
/// The same for a case that was edited; inputs that the edit did not change are taken from
/// `before`.
std::shared_ptr<const LoadedCase> reloadCase(const LoadedCase& before,
                                             const SessionCase& session_case);

/// InputError when the case cannot be run: image and camera differ in size, the camera's distortion
/// folds back in the image, the station is out of view, behind the camera, or of a size that only a
/// wrong unit explains.
void requireRunnable(const LoadedCase& loaded);

/// Runs a case with the session's options. `whs run` and the desktop program both use this
/// function, so that they get the same digest. A stop leaves the status at kRunning. InputError for
/// inputs or options that cannot be run.
LocalizationTrace runCase(const Session& session, const LoadedCase& loaded,
                          RecordLevel level = RecordLevel::kFull, const std::stop_token& stop = {});
/// The same with a plan instead of the session's options.
LocalizationTrace runCase(const LoadedCase& loaded, const RunPlan& plan,
                          RecordLevel level = RecordLevel::kFull, const std::stop_token& stop = {});
/// The same, with the inputs read first.
LocalizationTrace runCase(const Session& session, const std::string& case_id,
                          RecordLevel level = RecordLevel::kFull, const std::stop_token& stop = {});

/// The plan of a recorded run: its own when it changed options during the run, else the session's.
/// InputError when the case's inputs or the session's options have changed since the run.
RunPlan planOf(const RunRecord& run, const Session& session, const std::filesystem::path& file);

/// Writes the trace into the session's folder of runs, unless a run with this digest exists, and
/// returns its record. `session` is the one that ran. OutputError; std::logic_error for a run that
/// was stopped. `from`: digest of the run that it continued, for a run that changed options on the
/// way.
RunRecord storeRun(const Session& session, const std::string& case_id,
                   const LocalizationTrace& trace, const std::filesystem::path& session_file,
                   const std::string& from = {});

/// The session with the run added; a run of the same case, digest, inputs and options is moved to
/// the end.
Session withRun(const Session& session, RunRecord run);

/// The trace of a run. InputError when the file is missing, damaged, of another run, or does not
/// end as the record states.
LocalizationTrace loadRun(const RunRecord& run);
/// The same for display, with the views that were solved with it.
LocalizationTrace loadSnapshot(const RunRecord& run);

}  // namespace boresight::sessions
