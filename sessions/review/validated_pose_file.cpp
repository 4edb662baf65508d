// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/validated_pose_file.h"

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/annotation/annotations_file.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/decision.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_run.h"
#include "sessions/session/named_poses.h"
#include "sessions/session/session_file.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/version.h"

#include "sessions/text/utc_time.h"
#include "sessions/trace/decisive_iterations.h"
#include "sessions/trace/run_text.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

/// What every number in the file means.
ordered_json conventionsJson() {
  return {{"a_from_b", "maps points of b into a: p_a = a_from_b * p_b; 4x4, row by row"},
          {"length", "metre"},
          {"angle", "radian, unless a name says deg or mrad"},
          {"station", "the frame in which the station's parts are placed"},
          {"camera", "x right, y down, z forward, origin at the projection centre"},
          {"pixel_origin", "the centre of the top-left pixel is (0, 0); x right, y down"},
          {"quaternion", "w x y z, unit length, w >= 0"},
          {"covariance",
           "6x6 over (rotation rad, translation m); of camera_from_station: left "
           "perturbation in the camera frame, Exp(xi) * camera_from_station; the sum of its terms: "
           "picture (or annotations), the mesh's scale, the camera's calibration"}};
}

ordered_json quaternionJson(const Pose& pose) {
  Eigen::Quaterniond q = pose.rotation;
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return ordered_json::array({q.w(), q.x(), q.y(), q.z()});
}

ordered_json sigmaJson(const Matrix6d& covariance, const std::optional<Pose>& end_effector) {
  const auto sigma = poseSigma(covariance, end_effector);
  if (!sigma) return nullptr;
  return {{"normal_mm", sigma->normal_mm},
          {"lateral_mm", sigma->lateral_mm},
          {"out_of_plane_mrad", sigma->out_of_plane_mrad},
          {"translation_mm", toJson(sigma->translation_mm)},
          {"rotation_mrad", toJson(sigma->rotation_mrad)},
          {"of", end_effector ? "end effector" : "camera centre"}};
}

/// By what the terms of the covariance were made that the picture does not tell.
ordered_json inputSigmasJson(const InputSigmas& sigmas) {
  return {{"mesh_scale_sigma", sigmas.mesh_scale},
          {"mesh_scale_is", sigmas.mesh_scale_stated ? "stated" : "assumed"},
          {"calibration_sigma", toJson(StatedCalibration{sigmas.calibration.focal_relative,
                                                         sigmas.calibration.principal_point_px})},
          {"calibration_is", calibrationOrigin(sigmas)}};
}

ordered_json poseJson(const HandedPose& pose, const SessionCase& session_case) {
  ordered_json json;
  json["source"] = pose.source == PoseSource::kRun ? "run" : "annotation";
  json["camera_from_station"] = toJson(pose.camera_from_station);
  json["station_from_camera"] = toJson(pose.camera_from_station.inverse());
  json["camera_from_station_quaternion_wxyz"] = quaternionJson(pose.camera_from_station);
  if (pose.covariance.known()) {
    json["covariance"] = toJson(pose.covariance.total());
    json["covariance_terms"] = toJson(pose.covariance);
    json["one_sigma"] = sigmaJson(pose.covariance.total(), session_case.camera_from_end_effector);
    json["input_sigmas"] = inputSigmasJson(InputSigmas(session_case));
  }
  return json;
}

ordered_json endEffectorJson(const HandedPose& pose, const SessionCase& session_case) {
  const EndEffectorPose effector =
      endEffectorPose(session_case, pose.camera_from_station, pose.covariance.total());
  const Pose& correction = effector.end_effector_seed_from_end_effector_estimated;
  ordered_json json;
  json["station_from_end_effector"] = toJson(effector.station_from_end_effector);
  json["end_effector_seed_from_end_effector_estimated"] = toJson(correction);
  json["correction_translation_m"] = toJson(correction.translation_m);
  json["correction_rotation_deg"] =
      toJson(Eigen::Vector3d(rotationLog(correction.rotation) / kDegree_rad));
  if (pose.covariance.known()) {
    json["correction_to_command"] =
        toJson(correctionsOf(session_case, pose.camera_from_station, pose.covariance.total()));
    json["covariance"] = toJson(effector.covariance);
    json["covariance_is_of"] =
        "(rotation rad, translation m), right perturbation in the end effector's frame";
  }
  return json;
}

ordered_json linkJson(const std::string& name, const Pose& pose, const std::string& from) {
  return {{"name", name}, {"matrix", toJson(pose)}, {"from", from}};
}

/// Which run it was, and which other views had a say in it.
std::string runText(const HandedPose& pose, const Session& session) {
  std::string text = "run " + pose.run_digest;
  const RunRecord* run = findRun(session, pose.case_id, pose.run_digest);
  if (run != nullptr && run->together)
    text += ", " + togetherText(run->together->views, run->case_id);
  return text;
}

/// The camera model's frame, and the transforms between frames.
void addFrames(const SessionCase& session_case, ordered_json& chain) {
  if (session_case.camera_reference)
    chain.push_back(
        linkJson("camera_from_reference", session_case.camera_reference->camera_from_reference,
                 "the camera model, in " + frameText(session_case.camera_reference->frame)));
  for (const FrameTransform& join : session_case.frames)
    chain.push_back(linkJson("target_from_source", join.target_from_source,
                             join.file.filename().string() + ", sha256 " + join.file_sha256 +
                                 ", from " + frameText(join.source) + " to " +
                                 frameText(join.target) + ": " + join.comment));
}

/// Every transform that was used, and where it came from.
ordered_json chainJson(const HandedPose& pose, const SessionCase& session_case,
                       const Session& session) {
  ordered_json chain = ordered_json::array();
  chain.push_back(linkJson("camera_from_station_seed", session_case.camera_from_station_seed,
                           "the case's seed, as given"));
  for (const MeshInput& part : session_case.parts)
    if (part.source.state.used())
      chain.push_back(
          linkJson(part.source.frame == kStationFrame ? "station_from_mesh" : "frame_from_mesh",
                   part.source.frame_from_mesh,
                   part.source.mesh.filename().string() + ", sha256 " + part.sha256 +
                       (part.source.mesh_unit.empty() ? ", in its own unit"
                                                      : ", in " + part.source.mesh_unit) +
                       (part.source.frame == kStationFrame
                            ? ""
                            : ", in " + frameText(part.source.frame) + ", occludes only")));
  if (session_case.rig)
    chain.push_back(linkJson("camera_from_rig", session_case.rig->camera_from_rig,
                             "rig '" + session_case.rig->id + "'"));
  addFrames(session_case, chain);
  if (session_case.camera_from_end_effector)
    chain.push_back(linkJson("camera_from_end_effector", *session_case.camera_from_end_effector,
                             "that of the case, as given"));
  chain.push_back(linkJson(
      "camera_from_station", pose.camera_from_station,
      pose.source == PoseSource::kRun ? runText(pose, session) : "the annotations of the case"));
  return chain;
}

ordered_json pixelJson(const Eigen::Vector2d& pixel) {
  return ordered_json::array({pixel.x(), pixel.y()});
}

ordered_json matchesJson(const LocalizationTrace& run) {
  ordered_json list = ordered_json::array();
  const std::shared_ptr<const IterationTrace> last = lastMatching(run);
  if (last == nullptr) return list;
  const IterationTrace& iteration = *last;
  for (std::size_t i = 0; i < iteration.correspondences.size(); ++i) {
    const Correspondence& correspondence = iteration.correspondences[i];
    ordered_json json;
    json["point_in_station_m"] = toJson(correspondence.point_in_station_m);
    json["pixel"] = pixelJson(correspondence.pixel);
    if (i < iteration.pnp.inlier.size()) {
      json["inlier"] = iteration.pnp.inlier[i] != 0;
      json["residual_px"] = iteration.pnp.residual_px[i];
    }
    list.push_back(std::move(json));
  }
  return list;
}

ordered_json runJson(const LocalizationTrace& run) {
  ordered_json json;
  json["digest"] = run.digest;
  json["status"] = localizationStatusText(run.status);
  json["version"] = run.version;
  json["iterations"] = run.iterations.size();
  json["edge_support"] = run.support.share();
  json["edge_coverage"] = run.support.coverage();
  ordered_json options;
  for (const OptionDescription& option : listOptions(run.lastOptions()))
    std::visit([&](const auto& value) { options[option.name] = value; }, option.value);
  json["options"] = options;
  json["matches"] = matchesJson(run);
  return json;
}

ordered_json decisionJson(const HandedPose& pose, const ReviewStatus& status) {
  ordered_json json;
  json["verdict"] = pose.validated ? "validated" : "not validated";
  if (!status.holds()) return json;
  const Decision& decision = *status.decision;
  json["by"] = decision.by;
  json["comment"] = decision.comment;
  json["time"] = decision.time;
  if (const auto& approval = decision.approval)
    json["approval"] = {
        {"by", approval->by}, {"comment", approval->comment}, {"time", approval->time}};
  return json;
}

ordered_json hashesJson(const SessionCase& session_case) {
  ordered_json json;
  json["image_file"] = session_case.image.source.sha256;
  json["image_pixels"] = session_case.image.pixels_sha256;
  for (const MeshInput& part : session_case.parts) json["meshes"].push_back(part.sha256);
  if (session_case.ignore) json["ignore"] = session_case.ignore->sha256;
  if (session_case.onboard_record) json["onboard_record"] = session_case.onboard_record->sha256;
  json["inputs"] = inputsDigest(session_case);
  return json;
}

}  // namespace

ordered_json checksumOf(const ordered_json& json, const std::string& member) {
  ordered_json rest = json;
  rest.erase(member);
  const bool of_1_0 = member != kChecksumMember;
  return {{"algorithm", "SHA-256"},
          {"over", of_1_0 ? "this document without its member signature, as compact JSON"
                          : "this document without its member checksum and without white space "
                            "between its tokens, numbers as written here"},
          {"digest", sha256Text(rest.dump())}};
}

ordered_json validatedPoseJson(const Session& session, const HandedPose& pose,
                               const std::optional<LocalizationTrace>& run,
                               const std::filesystem::path& file) {
  const SessionCase& session_case = *session.findCase(pose.case_id);
  const Session alone = sessionOfCase(session, pose.case_id, pose.run_digest);
  ordered_json json;
  json["format"] = kValidatedPoseFormat;
  json["version"] = kValidatedPoseVersion;
  json["state"] = pose.validated ? "validated" : "NOT VALIDATED";
  json["review_status"] = pose.review_status;
  json["case"] = session_case.id;
  json["station"] = session_case.station;
  json["conventions"] = conventionsJson();
  json["pose"] = poseJson(pose, session_case);
  // Frames are never converted silently: the named frames of the case are written with their names.
  std::optional<Matrix6d> covariance;
  if (pose.covariance.known()) covariance = pose.covariance.total();
  const auto named = namedPoses(session_case, pose.camera_from_station, covariance);
  if (!named.empty()) json["frames"] = toJson(named);
  if (session_case.camera_from_end_effector && session_case.has_seed)
    json["end_effector"] = endEffectorJson(pose, session_case);
  json["chain"] = chainJson(pose, session_case, alone);
  json["decision"] = decisionJson(pose, reviewStatusOf(alone, session_case.id));
  json["checks"] = ordered_json::array();
  for (const JudgedCheck& judged : pose.checks) json["checks"].push_back(toJson(judged));
  if (session_case.requirement) json["requirement"] = toJson(*session_case.requirement);
  if (!session_case.image.label.empty()) json["image_label"] = toJson(session_case.image.label);
  json["sha256"] = hashesJson(session_case);
  if (run) json["run"] = runJson(*run);
  if (const auto annotations = session.annotations.find(session_case.id);
      pose.source == PoseSource::kAnnotation && annotations != session.annotations.end())
    json["annotations"] = toJson(*annotations->second);
  json["session"] = toJson(alone, file);
  json["written"] = {{"by", std::string("Boresight ") + kVersion}, {"time", utcNowText()}};
  json[kChecksumMember] = checksumOf(ordered_json::parse(prettyJson(json)));
  return json;
}

HandedPose writeValidatedPose(const std::filesystem::path& file, const Session& session,
                              const std::string& case_id) {
  CheckedPose checked = checkedPose(session, case_id);
  writeJsonFile(file, validatedPoseJson(checked.session, checked.pose, checked.subject.run, file));
  return std::move(checked.pose);
}

}  // namespace boresight::sessions
