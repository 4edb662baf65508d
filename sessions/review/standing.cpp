// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/standing.h"

#include <set>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/annotation/marks_file.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_writer.h"
#include "sessions/session/decision.h"
#include "sessions/session/json_fields.h"
#include "sessions/session/rig_links.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

CaseStanding undecided(const Session& session, const std::string& case_id) {
  if (const RunRecord* run = session.lastRunOf(case_id))
    return run->status == "converged" ? CaseStanding::kConverged : CaseStanding::kFailed;
  return session.annotations.count(case_id) > 0 ? CaseStanding::kAnnotated : CaseStanding::kNew;
}

/// Why a decision no longer holds, or "".
std::string droppedText(const Session& session, const Decision& decision) {
  if (decision.grounds.empty() || (decision.verdict == Verdict::kValidated && !decision.pose))
    return "it does not say what it is of";
  const bool of_run = !decision.digest.empty();
  const RunRecord* last = session.lastRunOf(decision.case_id);
  if (of_run && last == nullptr) return "its run is no longer there";
  if (of_run && last->digest != decision.digest) return "there is a later run";
  return changedGroundsText(decision.grounds,
                            judgedGrounds(session, decision.case_id, decision.digest));
}

std::string byText(const Decision& decision) {
  std::string text = " by " + decision.by;
  if (decision.approval) text += ", approved by " + decision.approval->by;
  return text;
}

std::string sha256Of(const ordered_json& json) { return sha256Text(json.dump()); }

ordered_json poseJson(const std::optional<Pose>& pose) {
  return pose ? exactPoseJson(*pose) : ordered_json();
}

ordered_json truthJson(const SessionCase& one) {
  ordered_json json = poseJson(one.camera_from_station_truth);
  if (one.truth_covariance) json["covariance"] = toJson(*one.truth_covariance);
  return json;
}

ordered_json inputSigmasJson(const SessionCase& one) {
  ordered_json json = ordered_json::object();
  if (one.mesh_scale_sigma) json["mesh_scale"] = *one.mesh_scale_sigma;
  if (one.calibration_sigma) json["calibration"] = toJson(*one.calibration_sigma);
  return json;
}

ordered_json marksJson(const Session& session, const std::string& case_id) {
  std::vector<std::string> ids = casesOfRig(session, case_id);
  ids.insert(ids.begin(), case_id);
  ordered_json json = ordered_json::object();
  for (const std::string& id : ids)
    if (const auto found = session.annotations.find(id); found != session.annotations.end())
      json[id] = toJson(*found->second);
  return json;
}

/// The rig's cameras as they lie to each other; its name is only a name.
ordered_json rigJson(const Session& session, const SessionCase& one) {
  ordered_json json = ordered_json::object();
  if (!one.rig) return json;
  json[one.id] = exactPoseJson(one.rig->camera_from_rig);
  for (const std::string& id : casesOfRig(session, one.id))
    json[id] = exactPoseJson(session.findCase(id)->rig->camera_from_rig);
  return json;
}

/// The runs that the check against the rig's other cameras asks.
ordered_json otherRunsJson(const Session& session, const std::string& case_id) {
  ordered_json json = ordered_json::object();
  for (const std::string& id : casesOfRig(session, case_id))
    if (const RunRecord* run = ownRunOf(session, id, case_id)) json[id] = run->digest;
  return json;
}

const char* groundText(const std::string& name) {
  static const std::map<std::string, const char*> kTexts = {
      {"inputs", "the image, camera, mesh, seed or mask"},
      {"run", "the run"},
      {"marks", "the marks"},
      {"truth", "the truth"},
      {"input_sigmas", "the stated sigmas of mesh and camera"},
      {"requirement", "the requirement"},
      {"end_effector", "the end effector"},
      {"rig", "the rig"},
      {"other_runs", "the runs of the rig's other cameras"},
      {"onboard_record", "the onboard record"},
      {"limits", "the limits of the checks"}};
  const auto found = kTexts.find(name);
  return found == kTexts.end() ? name.c_str() : found->second;
}

std::string listText(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace

const char* caseStandingText(CaseStanding state) {
  constexpr const char* kTexts[] = {"new",       "converged", "failed",
                                    "annotated", "validated", "rejected"};
  return kTexts[static_cast<std::size_t>(state)];
}

Standing standingOf(const Session& session, const std::string& case_id) {
  Standing standing;
  standing.state = undecided(session, case_id);
  const Decision* decision = session.decisionOn(case_id);
  if (decision == nullptr || decision->verdict == Verdict::kReopened) return standing;
  standing.decision = decision;
  standing.dropped = droppedText(session, *decision);
  if (!standing.holds()) return standing;
  if (decision->verdict == Verdict::kRejected) {
    standing.state = CaseStanding::kRejected;
  } else if (session.review.second_person && !decision->approval) {
    standing.awaits_approval = true;
  } else {
    standing.state = CaseStanding::kValidated;
  }
  return standing;
}

std::string standingText(const Standing& standing) {
  if (standing.state == CaseStanding::kValidated) return "validated" + byText(*standing.decision);
  if (standing.state == CaseStanding::kRejected)
    return "NOT VALIDATED: rejected" + byText(*standing.decision);
  const std::string text = std::string("NOT VALIDATED: ") + caseStandingText(standing.state);
  if (standing.awaits_approval)
    return text + "; validated" + byText(*standing.decision) + ", a second person has to approve";
  if (standing.decision == nullptr) return text;
  const char* what = standing.decision->verdict == Verdict::kValidated ? "validation" : "rejection";
  return text + "; the " + what + byText(*standing.decision) +
         " no longer holds: " + standing.dropped;
}

std::map<std::string, std::string> judgedGrounds(const Session& session, const std::string& case_id,
                                                 const std::string& run_digest) {
  const SessionCase* one = session.findCase(case_id);
  if (one == nullptr) return {};
  std::map<std::string, std::string> grounds;
  grounds["inputs"] = inputsDigest(*one);
  grounds["marks"] = sha256Of(marksJson(session, case_id));
  grounds["truth"] = sha256Of(truthJson(*one));
  grounds["input_sigmas"] = sha256Of(inputSigmasJson(*one));
  grounds["requirement"] = sha256Of(one->requirement ? toJson(*one->requirement) : ordered_json());
  grounds["end_effector"] = sha256Of(poseJson(one->camera_from_end_effector));
  grounds["rig"] = sha256Of(rigJson(session, *one));
  grounds["onboard_record"] =
      sha256Text(one->onboard_record ? one->onboard_record->sha256 : std::string());
  ReviewSettings limits = session.review;
  limits.second_person = false;  // who has to sign does not change what was measured
  grounds["limits"] = sha256Of(toJson(limits));
  const ordered_json other_runs = otherRunsJson(session, case_id);
  if (!other_runs.empty()) grounds["other_runs"] = sha256Of(other_runs);
  if (!run_digest.empty()) grounds["run"] = sha256Text(run_digest);
  return grounds;
}

std::string changedGroundsText(const std::map<std::string, std::string>& before,
                               const std::map<std::string, std::string>& now) {
  std::vector<std::string> changed;
  for (const auto& [name, sha256] : before) {
    const auto found = now.find(name);
    if (found == now.end() || found->second != sha256) changed.emplace_back(groundText(name));
  }
  for (const auto& [name, sha256] : now)
    if (before.count(name) == 0) changed.emplace_back(groundText(name));
  if (changed.empty()) return "";
  const auto plural = [](const std::string& text) {
    return text.starts_with("the marks") || text.starts_with("the limits") ||
           text.starts_with("the runs") || text.starts_with("the stated sigmas");
  };
  const bool one_thing = changed.size() == 1 && !plural(changed.front());
  return listText(changed) + (one_thing ? " has changed" : " have changed");
}

}  // namespace boresight::sessions
