// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/stated_inputs.h"

#include <algorithm>
#include <utility>

#include "sessions/io/cameras/frame_tree.h"
#include "sessions/session/case_frames.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

bool joinsTheSame(const FrameTransform& a, const FrameTransform& b) {
  return (a.target == b.target && a.source == b.source) ||
         (a.target == b.source && a.source == b.target);
}

void addTransform(std::vector<FrameTransform>& frames, FrameTransform transform) {
  transform.file = std::filesystem::absolute(transform.file).lexically_normal();
  std::erase_if(frames, [&transform](const FrameTransform& former) {
    return joinsTheSame(former, transform);
  });
  frames.push_back(std::move(transform));
}

/// Where none is stated: the principal point to half a pixel of 2048, or as much of other images.
CalibrationSigma assumedCalibration(const Camera& camera) {
  CalibrationSigma sigma;
  sigma.principal_point_px *= std::max(camera.width, camera.height) / 2048.0;
  return sigma;
}

const char* sourceText(bool stated) { return stated ? "" : ", assumed"; }

StatedCalibration statedOf(const SessionCase& session_case) {
  return statedCalibration(CameraFile{session_case.camera, std::nullopt,
                                      session_case.calibration_sigma,
                                      session_case.camera_covariance})
      .value_or(StatedCalibration());
}

CalibrationSigma usedCalibration(const SessionCase& session_case) {
  const StatedCalibration stated = statedOf(session_case);
  const CalibrationSigma assumed = assumedCalibration(session_case.camera);
  return {stated.focal_relative.value_or(assumed.focal_relative),
          stated.principal_point_px.value_or(assumed.principal_point_px)};
}

bool isPartlyStated(const StatedCalibration& stated) {
  return stated.focal_relative.has_value() != stated.principal_point_px.has_value();
}

/// Writes a member only where it changes: other cases keep what the operator did not edit.
void writeChange(const std::optional<double>& former, const std::optional<double>& value,
                 std::optional<double>& written) {
  if (value != former) written = value;
}

void writeChange(const std::optional<StatedCalibration>& former,
                 const std::optional<StatedCalibration>& value,
                 std::optional<StatedCalibration>& written) {
  const StatedCalibration none;
  const StatedCalibration& from = former ? *former : none;
  const StatedCalibration& to = value ? *value : none;
  StatedCalibration result = written.value_or(none);
  writeChange(from.focal_relative, to.focal_relative, result.focal_relative);
  writeChange(from.principal_point_px, to.principal_point_px, result.principal_point_px);
  written = result == none ? std::nullopt : std::optional(result);
}

}  // namespace

Session withStated(const Session& session, const std::string& case_id, const StatedInputs& stated) {
  const SessionCase& former = knownCase(session, case_id);
  std::vector<FrameTransform> frames = former.frames;
  for (const FrameTransform& transform : stated.frames) addTransform(frames, transform);
  const Session next =
      stated.frames.empty() ? session : withFrames(session, case_id, std::move(frames));
  SessionCase changed = *next.findCase(case_id);
  const auto chain = framesOf(changed).chain(kCameraFrame, kEndEffectorFrame);
  const auto former_chain = framesOf(former).chain(kCameraFrame, kEndEffectorFrame);
  if (chain && (!former_chain || !(chain->a_from_b == former_chain->a_from_b)))
    changed.camera_from_end_effector = chain->a_from_b;
  if (stated.camera_from_end_effector)
    changed.camera_from_end_effector = stated.camera_from_end_effector;
  if (stated.requirement) changed.requirement = stated.requirement;
  if (stated.symmetries) changed.symmetries = *stated.symmetries;
  return withCase(next, std::move(changed));
}

InputSigmas::InputSigmas(const SessionCase& session_case)
    : mesh_scale(session_case.mesh_scale_sigma.value_or(kAssumedMeshScaleSigma)),
      calibration(usedCalibration(session_case)),
      mesh_scale_stated(session_case.mesh_scale_sigma.has_value()),
      stated(statedOf(session_case)),
      calibration_derived(session_case.camera_covariance.has_value()) {}

std::string meshScaleText(const InputSigmas& sigmas) {
  return threeDigits(100.0 * sigmas.mesh_scale) + " %" + sourceText(sigmas.mesh_scale_stated);
}

std::string calibrationText(const InputSigmas& sigmas) {
  const std::string focal = threeDigits(100.0 * sigmas.calibration.focal_relative) + " %";
  const std::string centre = threeDigits(sigmas.calibration.principal_point_px) + " px";
  if (isPartlyStated(sigmas.stated))
    return focal + (sigmas.stated.focal_relative ? " and " : " (assumed) and ") + centre +
           (sigmas.stated.principal_point_px ? "" : " (assumed)");
  return focal + " and " + centre +
         (sigmas.calibration_derived ? ", by the camera's covariance"
                                     : sourceText(sigmas.stated.focal_relative.has_value()));
}

std::string calibrationOrigin(const InputSigmas& sigmas) {
  const auto origin = [](const std::optional<double>& stated) {
    return std::string(stated ? "stated" : "assumed");
  };
  if (sigmas.calibration_derived) return "of the camera's covariance";
  const StatedCalibration& stated = sigmas.stated;
  if (!isPartlyStated(stated)) return origin(stated.focal_relative);
  return "focal_relative " + origin(stated.focal_relative) + ", principal_point_px " +
         origin(stated.principal_point_px);
}

Session withInputSigmas(const Session& session, const std::string& case_id,
                        const std::optional<double>& mesh_scale_sigma,
                        const std::optional<StatedCalibration>& calibration_sigma) {
  const SessionCase* chosen = session.findCase(case_id);
  if (chosen == nullptr) return session;
  Session next = session;
  for (const auto& session_case : session.cases) {
    SessionCase changed = *session_case;
    if (sameMeshes(*session_case, *chosen))
      writeChange(chosen->mesh_scale_sigma, mesh_scale_sigma, changed.mesh_scale_sigma);
    if (session_case->camera == chosen->camera)
      writeChange(chosen->calibration_sigma, calibration_sigma, changed.calibration_sigma);
    if (!(changed == *session_case)) next = withCase(next, std::move(changed));
  }
  return next;
}

Session withSymmetries(const Session& session, const std::string& case_id,
                       const Symmetries& symmetries) {
  const SessionCase* chosen = session.findCase(case_id);
  if (chosen == nullptr || chosen->symmetries == symmetries) return session;
  Session next = session;
  for (const auto& session_case : session.cases) {
    if (!sameMeshes(*session_case, *chosen)) continue;
    SessionCase changed = *session_case;
    changed.symmetries = symmetries;
    next = withCase(next, std::move(changed));
  }
  return next;
}

}  // namespace boresight::sessions
