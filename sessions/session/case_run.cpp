// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_run.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/datasets/symmetries.h"
#include "sessions/io/files/created_folder.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/log/program_log.h"
#include "sessions/run/problem.h"
#include "sessions/run/runner.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_file.h"
#include "sessions/trace/trace_file.h"

#include "sessions/text/utc_time.h"
#include "sessions/trace/run_text.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::optional<IgnoreMask> loadMask(const SessionCase& session_case, const GrayImage& image) {
  if (!session_case.ignore && session_case.ignore_strokes.empty()) return std::nullopt;
  IgnoreMask mask = readKnownMask(session_case, image.width, image.height);
  applyStrokes(session_case.ignore_strokes, image.view(), mask);
  return mask;
}

/// "case ID: inputs SHA-256 ...; image FILE, SHA-256 ...; mesh FILE, SHA-256 ...".
std::string inputsText(const SessionCase& session_case) {
  const auto named = [](const fs::path& file, const std::string& sha256) {
    return " " + file.string() + ", SHA-256 " + sha256;
  };
  std::string text = "case " + session_case.id + ": inputs SHA-256 " + inputsDigest(session_case);
  text += "; image" + named(session_case.image.source.file, session_case.image.source.sha256);
  for (const MeshInput& part : session_case.parts)
    text += "; mesh" + named(part.source.mesh, part.sha256);
  return text;
}

std::shared_ptr<const LoadedCase> completed(const SessionCase& session_case, GrayImage image,
                                            SceneMesh scene) {
  auto loaded = std::make_shared<LoadedCase>();
  loaded->source = session_case;
  loaded->image = std::move(image);
  loaded->scene = std::move(scene);
  requireInPlace(session_case.symmetries, matchedBounds(loaded->scene.view()),
                 "case " + session_case.id);
  loaded->ignore = loadMask(session_case, loaded->image);
  if (loaded->ignore) loaded->ignore_bits = loaded->ignore->view();
  logEvent(LogLevel::kInfo, [&session_case] { return inputsText(session_case); });
  return loaded;
}

GrayImage loadImage(const ImageInput& input) {
  GrayImage image = readKnownImage(input, input.eight_bit);
  requireKnown(input.source.file, "its 8-bit pixels", image.pixels_sha256, input.pixels_sha256);
  if (!input.color_sha256.empty())
    requireKnown(input.source.file, "its 8-bit colours", image.color_sha256, input.color_sha256);
  return image;
}

}  // namespace

LocalizationProblem LoadedCase::problem() const {
  return problemOf(image, ignore ? &ignore_bits : nullptr, source.camera, scene.view(),
                   source.camera_from_station_seed, source.uncertainty,
                   source.camera_from_end_effector);
}

std::shared_ptr<const LoadedCase> loadCase(const SessionCase& session_case) {
  GrayImage image = loadImage(session_case.image);
  return completed(session_case, std::move(image), readKnownScene(session_case));
}

std::shared_ptr<const LoadedCase> reloadCase(const LoadedCase& before,
                                             const SessionCase& session_case) {
  const bool same_image = session_case.image == before.source.image;
  const bool same_scene = sameScene(session_case, before.source);
  GrayImage image = same_image ? before.image : loadImage(session_case.image);
  SceneMesh scene = same_scene ? before.scene : readKnownScene(session_case);
  return completed(session_case, std::move(image), std::move(scene));
}

void requireRunnable(const LoadedCase& loaded) {
  const SessionCase& session_case = loaded.source;
  if (!session_case.has_seed)
    throw InputError("case " + session_case.id, "seed",
                     "there is none: annotate the case and use the solved pose as its seed");
  requireSameSize(loaded.image, session_case.camera);
  requireField("case " + session_case.id, "camera", session_case.camera);
  requireSensibleSeed(session_case.camera, loaded.scene, session_case.camera_from_station_seed,
                      "case " + session_case.id, "seed");
}

LocalizationTrace runCase(const Session& session, const LoadedCase& loaded, RecordLevel level,
                          const std::stop_token& stop) {
  return runCase(loaded, caseOptions(session, loaded.source, "session"), level, stop);
}

LocalizationTrace runCase(const LoadedCase& loaded, const RunPlan& plan, RecordLevel level,
                          const std::stop_token& stop) {
  requireRunnable(loaded);
  LocalizationTrace trace = localize(loaded.problem(), plan, level, stop);
  const fs::path& image = loaded.source.image.source.file;
  const fs::path& mesh = loaded.source.parts.front().source.mesh;
  requireAccepted(trace, {{image, ""}, {image, "camera"}, {mesh, ""}, {image, "seed"}});
  return trace;
}

LocalizationTrace runCase(const Session& session, const std::string& case_id, RecordLevel level,
                          const std::stop_token& stop) {
  return runCase(session, *loadCase(knownCase(session, case_id)), level, stop);
}

namespace {

/// Options are stored as differences from a profile, which a version may change.
std::string otherOptionsText(const RunRecord& run) {
  if (run.version == kVersion) return "the session's options have changed since the run";
  return "it had other options than the session has now: it is from version " + run.version +
         ", whose profiles may differ from those of " + kVersion + "; run and decide again";
}

}  // namespace

RunPlan planOf(const RunRecord& run, const Session& session, const fs::path& file) {
  const SessionCase& session_case = knownCase(session, run.case_id);
  const std::string place = "run " + run.digest;
  if (run.inputs_sha256 != inputsDigest(session_case) || endEffectorChangedSince(run, session))
    throw InputError(file, place,
                     "the inputs of case " + run.case_id + " have changed since the run");
  if (run.together && run.together->inputs_sha256 != viewsDigest(session, casesOf(*run.together)))
    throw InputError(file, place,
                     "it was made " + togetherText(run.together->views, run.case_id) +
                         ", and one of these views has changed or is missing");
  if (run.rerun) return *run.rerun;
  const LocalizerOptions options = caseOptions(session, session_case, file);
  if (run.options_sha256 != optionsDigest(options))
    throw InputError(file, place, otherOptionsText(run));
  return options;
}

RunRecord storeRun(const Session& session, const std::string& case_id,
                   const LocalizationTrace& trace, const fs::path& session_file,
                   const std::string& from) {
  if (trace.status == LocalizationStatus::kRunning)
    throw std::logic_error("a run that was stopped cannot be stored");
  const SessionCase& session_case = knownCase(session, case_id);
  RunRecord run;
  run.case_id = case_id;
  run.digest = trace.digest;
  run.file = fs::absolute(runFileOf(session_file, trace.digest)).lexically_normal();
  run.status = localizationStatusText(trace.status);
  run.version = trace.version;
  run.time = utcNowText();
  run.inputs_sha256 = inputsDigest(session_case);
  run.options_sha256 = optionsDigest(trace.lastOptions());
  const bool own_options =
      !sameOptions(trace.options, caseOptions(session, session_case, session_file));
  if (own_options || !trace.changes.empty()) run.rerun = RerunRecord{trace.plan(), from};
  if (session_case.camera_from_end_effector &&
      trace.options.loop.correction_point == CorrectionPoint::kEndEffector)
    run.end_effector_in_camera_m = session_case.camera_from_end_effector->translation_m;
  if (!isSha256Text(run.digest))
    throw OutputError(session_file, "case " + case_id + ": the run ended before it had a digest (" +
                                        statusText(trace.fault) + ")");
  try {
    if (loadRun(run).digest == run.digest) return run;
  } catch (const InputError&) {
    // not there, or damaged: it is written now
  }
  const CreatedFolder folder(run.file.parent_path());
  saveTrace(run.file, trace);
  return run;
}

Session withRun(const Session& session, RunRecord run) {
  Session next = session;
  next.runs.eraseIf(run.case_id, [&run](const RunRecord& other) {
    return other.digest == run.digest && other.inputs_sha256 == run.inputs_sha256 &&
           other.options_sha256 == run.options_sha256;
  });
  next.runs.push_back(std::move(run));
  return next;
}

LocalizationTrace loadSnapshot(const RunRecord& run) {
  LocalizationTrace snapshot = loadRun(run);
  if (!run.together) return snapshot;
  snapshot.views = run.together->views;
  for (std::size_t i = 0; i < snapshot.views.size(); ++i)
    if (snapshot.views[i].case_id == run.case_id) snapshot.own_view = i;
  return snapshot;
}

LocalizationTrace loadRun(const RunRecord& run) {
  LocalizationTrace trace = loadTrace(run.file);
  if (trace.digest != run.digest)
    throw InputError(run.file, "digest",
                     "is " + trace.digest + ", but the session names " + run.digest);
  if (localizationStatusText(trace.status) != run.status)
    throw InputError(run.file, "status",
                     std::string("is ") + localizationStatusText(trace.status) +
                         ", but the session states " + run.status);
  return trace;
}

}  // namespace boresight::sessions
