// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/views_run.h"

#include <algorithm>
#include <utility>

#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/runner.h"
#include "sessions/session/rig_links.h"

namespace boresight::sessions {
namespace {

/// The same meshes in the same places and states, whatever they and their files are called. Each
/// case places the parts of named frames by its own transforms.
bool sameStation(const SessionCase& a, const SessionCase& b) {
  const auto same = [](const MeshInput& mesh_input, MeshInput other) {
    other.source.mesh = mesh_input.source.mesh;
    other.source.name = mesh_input.source.name;
    return mesh_input == other;
  };
  return a.feature_size_m == b.feature_size_m &&
         std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(), same);
}

/// A rig frame that is the first camera's own changes no bit of the seed.
Pose rigSeed(const SessionCase& first) {
  const Pose& camera_from_rig = first.rig->camera_from_rig;
  if (camera_from_rig == Pose()) return first.camera_from_station_seed;
  return camera_from_rig.inverse() * first.camera_from_station_seed;
}

View viewOf(const LoadedCase& loaded) {
  return {loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr, loaded.source.camera,
          loaded.scene.view(), loaded.source.rig->camera_from_rig};
}

std::vector<LocalizationTrace> runLoaded(const LoadedViews& loaded, const LocalizerOptions& options,
                                         const std::stop_token& stop) {
  const std::string place = "case " + loaded.cases.front()->source.id;
  Runner run(loaded.problem(), options, loaded.ids());
  run.advance(StepUntil::kEnd, stop);
  const LocalizationTrace& first = run.trace();
  if (first.digest.empty() && first.finished) throw InputError(place, statusText(first.fault));
  return run.traces();
}

}  // namespace

std::string whyAlone(const Session& session, const std::string& case_id) {
  const SessionCase* session_case = session.findCase(case_id);
  if (session_case == nullptr) return "There is no such case.";
  if (!session_case->rig)
    return "The case has no rig: link it to the other views (Annotation, Rig), or state a rig in "
           "dataset.json.";
  const std::vector<std::string> others = casesOfRig(session, case_id);
  if (others.empty()) return "The session has no other view of rig " + session_case->rig->id + ".";
  if (others.size() + 1 > kMaxViews)
    return "Rig " + session_case->rig->id + " has " + std::to_string(others.size() + 1) +
           " views; at most " + std::to_string(kMaxViews) + " are solved together.";
  for (const std::string& id : others)
    if (!sameStation(*session_case, *session.findCase(id)))
      return "Case " + id + " of the same rig has another station.";
  return "";
}

ViewsProblem LoadedViews::problem() const {
  const LocalizationProblem first = cases.front()->problem();
  return {views, rigSeed(cases.front()->source), first.uncertainty, first.end_effector_in_camera_m};
}

std::vector<std::string> LoadedViews::ids() const {
  std::vector<std::string> ids;
  for (const auto& session_case : cases) ids.push_back(session_case->source.id);
  return ids;
}

std::vector<SessionCase> otherViews(const Session& session, const std::string& case_id) {
  std::vector<SessionCase> others;
  for (const std::string& id : casesOfRig(session, case_id))
    others.push_back(*session.findCase(id));
  return others;
}

std::shared_ptr<const LoadedViews> loadViews(std::shared_ptr<const LoadedCase> first,
                                             const std::vector<SessionCase>& others) {
  auto loaded = std::make_shared<LoadedViews>();
  loaded->cases.push_back(std::move(first));
  // What the first has of the same files is taken from there.
  for (const SessionCase& session_case : others)
    loaded->cases.push_back(reloadCase(*loaded->cases.front(), session_case));
  for (const auto& session_case : loaded->cases) {
    requireSameSize(session_case->image, session_case->source.camera);
    requireField("case " + session_case->source.id, "camera", session_case->source.camera);
    loaded->views.push_back(viewOf(*session_case));
  }
  return loaded;
}

std::vector<LocalizationTrace> runViews(const Session& session, const std::string& case_id,
                                        const std::stop_token& stop) {
  const std::string alone = whyAlone(session, case_id);
  if (!alone.empty()) throw InputError("case " + case_id, "rig", alone);
  const SessionCase& session_case = *session.findCase(case_id);
  const LocalizerOptions options = caseOptions(session, session_case, "session");
  const auto first = loadCase(session_case);
  requireRunnable(*first);
  return runLoaded(*loadViews(first, otherViews(session, case_id)), options, stop);
}

std::vector<RunRecord> storeViews(const Session& session,
                                  const std::vector<LocalizationTrace>& views,
                                  const std::filesystem::path& session_file) {
  std::vector<RunRecord> records;
  for (const LocalizationTrace& view : views) {
    TogetherRecord together{view.views, {}};
    together.inputs_sha256 = viewsDigest(session, casesOf(together));
    const std::string& id = view.views[view.own_view].case_id;
    records.push_back(storeRun(session, id, view, session_file));
    records.back().end_effector_in_camera_m = records.front().end_effector_in_camera_m;
    records.back().together = std::move(together);
  }
  return records;
}

LocalizationTrace repeatRun(const RunRecord& run, const Session& session,
                            const std::filesystem::path& session_file, RecordLevel level) {
  const RunPlan plan = planOf(run, session, session_file);
  if (!run.together) return runCase(*loadCase(*session.findCase(run.case_id)), plan, level);
  const std::vector<std::string> ids = casesOf(*run.together);
  std::vector<SessionCase> others;
  for (std::size_t i = 1; i < ids.size(); ++i) others.push_back(*session.findCase(ids[i]));
  const auto views = loadViews(loadCase(*session.findCase(ids.front())), others);
  for (const LocalizationTrace& trace : runLoaded(*views, plan.options, {})) {
    if (trace.views[trace.own_view].case_id != run.case_id) continue;
    if (trace.views != run.together->views)
      throw InputError(session_file, "run " + run.digest,
                       "its views contradict its member together");
    return trace;
  }
  throw InputError(session_file, "run " + run.digest, "its own case is not among its views");
}

}  // namespace boresight::sessions
