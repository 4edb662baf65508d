// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "core/base/digest.h"
#include "core/localizer/run_digest.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/session/session_difference.h"
#include "sessions/session/session_file.h"

namespace boresight::sessions {
namespace {

/// The value of a case, or nullptr.
template <class Value>
const Value* valueOf(const std::string& id, const BlockMap<std::string, Value>& values) {
  const auto found = values.find(id);
  return found == values.end() ? nullptr : &found->second;
}

template <class Value>
bool same(const Value* a, const Value* b) {
  return a && b ? *a == *b : a == b;
}

/// Empty values are not kept.
template <class Value>
void put(const std::string& id, Value value, BlockMap<std::string, SharedValue<Value>>& values) {
  if (value == Value())
    values.erase(id);
  else
    values.insert_or_assign(id, std::move(value));
}

}  // namespace

const SessionCase* Session::findCase(const std::string& id) const {
  const SharedValue<SessionCase>* found = cases.find(id);
  return found == nullptr ? nullptr : &**found;
}

const Decision* Session::decisionOn(const std::string& case_id) const {
  return decisions.find(case_id);
}

const RunRecord* Session::lastRunOf(const std::string& case_id) const { return runs.find(case_id); }

FrameTree framesOf(const SessionCase& session_case) {
  return frameTree(session_case.camera_reference, session_case.frames);
}

std::vector<PartSource> partsOf(const SessionCase& session_case) {
  std::vector<PartSource> parts;
  for (const MeshInput& part : session_case.parts) parts.push_back(part.source);
  return parts;
}

bool sameScene(const SessionCase& a, const SessionCase& b) {
  return a.parts == b.parts && a.frames == b.frames && a.camera_reference == b.camera_reference;
}

bool sameMeshes(const SessionCase& a, const SessionCase& b) {
  const auto same = [](const MeshInput& part, const MeshInput& other) {
    return part.sha256 == other.sha256 && part.source.mesh_unit == other.source.mesh_unit &&
           part.source.frame == other.source.frame &&
           part.source.frame_from_mesh == other.source.frame_from_mesh;
  };
  return std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(), same);
}

void setCamera(SessionCase& session_case, const CameraFile& camera) {
  session_case.camera = camera.camera;
  session_case.camera_reference = camera.reference;
  session_case.calibration_sigma = camera.calibration_sigma;
  session_case.camera_covariance = camera.covariance;
}

void setSeed(SessionCase& session_case, const Pose& camera_from_station) {
  session_case.has_seed = true;
  session_case.camera_from_station_seed = camera_from_station;
  session_case.station_frame.reset();
  session_case.camera_from_station_working.reset();
}

void setTruth(SessionCase& session_case, const Pose& camera_from_station, const TruthSource& source,
              const std::optional<Matrix6d>& covariance) {
  session_case.camera_from_station_truth = camera_from_station;
  session_case.truth_frame.reset();
  session_case.truth_covariance = covariance;
  session_case.truth_source = source;
}

std::string truthSourceText(const SessionCase& session_case) {
  if (!session_case.camera_from_station_truth || !session_case.truth_source) return "";
  const TruthSource& source = *session_case.truth_source;
  if (source.origin == TruthOrigin::kRun) return "the pose of run " + source.run.substr(0, 16);
  constexpr const char* kNames[] = {"given", "annotated", "imported"};
  const std::string name = kNames[static_cast<std::size_t>(source.origin)];
  return source.file.empty() ? name : name + ", " + source.file;
}

const Pose* judgingTruth(const SessionCase& session_case) {
  const bool of_run =
      session_case.truth_source && session_case.truth_source->origin == TruthOrigin::kRun;
  return session_case.camera_from_station_truth && !of_run
             ? &*session_case.camera_from_station_truth
             : nullptr;
}

const RunRecord* findRun(const Session& session, const std::string& case_id,
                         const std::string& digest) {
  const RunRecord* found = nullptr;
  for (const RunRecord* run : session.runs.findAll(case_id))
    if (digest.empty() || run->digest == digest) found = run;
  return found;
}

const SessionCase& knownCase(const Session& session, const std::string& case_id) {
  const SessionCase* found = session.findCase(case_id);
  if (found == nullptr) throw InputError("session", "cases", "there is no case '" + case_id + "'");
  return *found;
}

Session withChanged(const Session& session, const std::string& case_id,
                    const std::function<void(SessionCase&)>& change) {
  const SessionCase* found = session.findCase(case_id);
  if (found == nullptr) return session;
  SessionCase changed = *found;
  change(changed);
  return withCase(session, std::move(changed));
}

Session withCase(const Session& session, SessionCase changed) {
  Session next = session;
  next.cases.put(std::move(changed));
  return next;
}

std::string freeCaseId(const Session& session, const std::string& id) {
  std::string free = id;
  for (int number = 2; session.findCase(free) != nullptr; ++number)
    free = id + "-" + std::to_string(number);
  return free;
}

Session withoutCase(const Session& session, const std::string& case_id) {
  Session next = session;
  const auto any = [](const auto& /*element*/) { return true; };
  next.cases.eraseIf(case_id, any);
  next.annotations.erase(case_id);
  next.rounds.erase(case_id);
  next.decisions.eraseIf(case_id, any);
  next.runs.eraseIf(case_id, any);
  if (next.view.case_id == case_id) next.view = {};
  return next;
}

Session withAnnotations(const Session& session, const std::string& case_id,
                        Annotations annotations) {
  Session next = session;
  put(case_id, std::move(annotations), next.annotations);
  return next;
}

Session withRounds(const Session& session, const std::string& case_id, AnnotationRounds rounds) {
  Session next = session;
  put(case_id, std::move(rounds), next.rounds);
  return next;
}

Session withPartState(const Session& session, const std::string& case_id, std::size_t part_index,
                      const PartState& state) {
  const SessionCase& session_case = knownCase(session, case_id);
  const std::string place = "case " + case_id;
  if (part_index >= session_case.parts.size())
    throw InputError(place, "parts", "there is no part " + std::to_string(part_index));
  std::vector<PartSource> parts = partsOf(session_case);
  parts[part_index].state = state;
  const PartConcern concern = partConcern(parts[part_index], framesOf(session_case));
  if (concern.member == "role")
    throw InputError(place, partName(parts[part_index]), concern.reason);
  if (!anyMatched(parts))
    throw InputError(place, partName(parts[part_index]),
                     "is the only matched part: switch another one on first");
  return withChanged(session, case_id,
                     [&](SessionCase& changed) { changed.parts[part_index].source.state = state; });
}

Session withOptions(const Session& session, const std::string& profile,
                    const LocalizerOptions& options) {
  Session next = session;
  next.profile = profile;
  next.options = changedOptions(options, profileOptions(profile).value());
  std::ranges::sort(next.options, {}, &OptionList::value_type::first);
  return next;
}

LocalizerOptions sessionOptions(const Session& session, const std::filesystem::path& file) {
  std::optional<LocalizerOptions> options = profileOptions(session.profile);
  if (!options)
    throw InputError(
        file, "profile",
        "there is no profile \"" + session.profile + "\"; there are: " + profileNames());
  applyConfig(*options, {file, session.profile, session.options});
  return *options;
}

LocalizerOptions caseOptions(const Session& session, const SessionCase& session_case,
                             const std::filesystem::path& file) {
  return withFeatureSize(sessionOptions(session, file), session_case.feature_size_m);
}

std::string inputsDigest(const SessionCase& session_case) {
  SessionCase inputs;
  inputs.image.pixels_sha256 = session_case.image.pixels_sha256;
  inputs.image.color_sha256 = session_case.image.color_sha256;
  inputs.camera = session_case.camera;
  inputs.has_seed = session_case.has_seed;
  inputs.camera_from_station_seed = session_case.camera_from_station_seed;
  inputs.uncertainty = session_case.uncertainty;
  inputs.ignore = session_case.ignore;
  inputs.ignore_strokes = session_case.ignore_strokes;
  // Where the files are makes no difference.
  inputs.image.source.file = "/";
  if (inputs.ignore) inputs.ignore->file = "/";
  for (MaskStroke& stroke : inputs.ignore_strokes) stroke.name.clear();
  nlohmann::ordered_json json = toJson(inputs, PathWriter("/"));
  json["parts"] = fingerprintParts(session_case);
  return sha256Text(json.dump());
}

bool RerunRecord::operator==(const RerunRecord& other) const {
  const auto same = [](const OptionChange& a, const OptionChange& b) {
    return a.iteration == b.iteration && sameOptions(a.options, b.options);
  };
  return from == other.from && sameOptions(options, other.options) &&
         std::equal(changes.begin(), changes.end(), other.changes.begin(), other.changes.end(),
                    same);
}

std::vector<std::string> casesOf(const TogetherRecord& record) {
  std::vector<std::string> ids;
  for (const ViewOutcome& view : record.views) ids.push_back(view.case_id);
  return ids;
}

std::string viewsDigest(const Session& session, const std::vector<std::string>& case_ids) {
  DigestWriter writer;
  writer.tag("views");
  for (std::size_t i = 0; i < case_ids.size(); ++i) {
    const SessionCase* found = session.findCase(case_ids[i]);
    if (found == nullptr || !found->rig) return "";
    SessionCase session_case = *found;
    if (i > 0) {
      session_case.has_seed = true;
      session_case.camera_from_station_seed = Pose();
      session_case.uncertainty = {};
    }
    writer.tag(inputsDigest(session_case).c_str());
    digestPose(found->rig->camera_from_rig, writer);
  }
  return hexText(writer.digest()).data();
}

bool endEffectorChangedSince(const RunRecord& run, const Session& session) {
  if (!run.end_effector_in_camera_m) return false;
  const SessionCase* first =
      session.findCase(run.together ? run.together->views.front().case_id : run.case_id);
  return first == nullptr || !first->camera_from_end_effector ||
         first->camera_from_end_effector->translation_m != *run.end_effector_in_camera_m;
}

bool inputsChangedSince(const RunRecord& run, const Session& session) {
  const SessionCase* session_case = session.findCase(run.case_id);
  if (session_case == nullptr || run.inputs_sha256 != inputsDigest(*session_case) ||
      endEffectorChangedSince(run, session))
    return true;
  return run.together &&
         run.together->inputs_sha256 != viewsDigest(session, casesOf(*run.together));
}

const RunRecord& currentRunOf(const Session& session, const std::string& case_id) {
  const RunRecord* run = session.lastRunOf(case_id);
  if (run == nullptr) throw InputError("case " + case_id, "runs", "it has no run: run it first");
  if (inputsChangedSince(*run, session))
    throw InputError("case " + case_id, "runs",
                     "the inputs have changed since the last run: run it again");
  return *run;
}

Staleness stalenessOf(const RunRecord& run, const Session& session,
                      const std::filesystem::path& file) {
  const SessionCase* session_case = session.findCase(run.case_id);
  if (session_case == nullptr) return {true, false};
  return {inputsChangedSince(run, session),
          run.options_sha256 != optionsDigest(caseOptions(session, *session_case, file))};
}

std::vector<std::string> changedCases(const Session& before, const Session& after) {
  std::vector<std::string> changed;
  const std::set<std::string> differing = differenceOf(before, after).cases;
  if (differing.empty()) return changed;
  for (const auto& session_case : after.cases) {
    if (!differing.contains(session_case->id)) continue;
    const SessionCase* former = before.findCase(session_case->id);
    const auto& id = session_case->id;
    const bool kept = former && *former == *session_case &&
                      same(valueOf(id, before.annotations), valueOf(id, after.annotations)) &&
                      same(valueOf(id, before.rounds), valueOf(id, after.rounds)) &&
                      same(before.decisionOn(id), after.decisionOn(id));
    if (!kept) changed.push_back(id);
  }
  return changed;
}

void StaleRuns::takeOptions(const Session& session) {
  if (profile_ == session.profile && options_ == session.options) return;
  profile_ = session.profile;
  options_ = session.options;
  options_digests_.clear();
}

bool StaleRuns::isStale(const RunRecord& run, const SharedValue<SessionCase>& shared_value,
                        const Session& session, const std::filesystem::path& file) {
  // Of a run together the other cases count, too.
  if (run.together || run.end_effector_in_camera_m) return stalenessOf(run, session, file).stale();
  takeOptions(session);
  auto known = inputs_.find(shared_value->id);
  if (known == inputs_.end() || !known->second.of_case.sharesWith(shared_value))
    known =
        inputs_
            .insert_or_assign(shared_value->id, Inputs{shared_value, inputsDigest(*shared_value)})
            .first;
  if (run.inputs_sha256 != known->second.digest) return true;
  std::string& options = options_digests_[shared_value->feature_size_m.value_or(0.0)];
  if (options.empty()) options = optionsDigest(caseOptions(session, *shared_value, file));
  return run.options_sha256 != options;
}

Requirement requirementOf(const Session& session, const SessionCase& session_case) {
  if (session_case.requirement) return *session_case.requirement;
  const CheckPreset* preset = findCheckPreset(session.review.preset);
  if (preset == nullptr)
    throw InputError("session", "review.preset",
                     "there is no preset '" + session.review.preset + "'");
  return preset->requirement;
}

}  // namespace boresight::sessions
