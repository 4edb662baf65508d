// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_frames.h"

#include <algorithm>
#include <utility>

#include "core/base/math.h"
#include "sessions/io/cameras/frame_tree.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/session/rig_links.h"

namespace boresight::sessions {
namespace {

/// Half-widths of a seed's uncertainty that a covariance is taken as, in sigmas.
constexpr double kSeedSigmas = 3.0;
/// A pose this close to a chain comes from it: a session stores its bits. rad, m
constexpr double kSamePose = 1e-9;

bool isSame(const std::optional<Pose>& a, const std::optional<Pose>& b) {
  return a && b && perturbationBetween(*a, *b).norm() <= kSamePose;
}

/// Empty when the case's frames do not join the frame to the camera.
std::optional<Pose> cameraFromFrame(const SessionCase& session_case, const FrameName& frame) {
  if (const auto& reference = session_case.camera_reference; frame.name.empty())
    return reference ? std::optional(reference->camera_from_reference) : std::nullopt;
  const auto chain = framesOf(session_case).chain(kCameraFrame, frame);
  return chain ? std::optional(chain->a_from_b) : std::nullopt;
}

[[noreturn]] void refuseCut(const SessionCase& session_case, const std::string& pose,
                            const FrameName& frame, const std::string& remedy) {
  throw InputError("case " + session_case.id,
                   "the " + pose + " comes from the frames between CAMERA and " + frameText(frame) +
                       ", which would no longer be joined: " + remedy);
}

[[noreturn]] void refuseCut(const SessionCase& session_case, const std::string& pose,
                            const FrameName& frame) {
  refuseCut(session_case, pose, frame,
            "give the " + pose + " as camera_from_station first, or make a new case");
}

/// The pose of a station that was given in a named frame, by the new frames.
Pose keptInFrame(const SessionCase& former, const SessionCase& changed, const std::string& name,
                 const FrameName& frame, const Pose& camera_from_station) {
  const auto before = cameraFromFrame(former, frame);
  const auto after = cameraFromFrame(changed, frame);
  if (!before || before == after) return camera_from_station;
  if (!after) refuseCut(changed, name, frame);
  return *after * (before->inverse() * camera_from_station);
}

void setLimits(const DeclaredUncertainty& from, DeclaredUncertainty& to) {
  to.translation_m = from.translation_m;
  to.rotation_deg = from.rotation_deg;
}

/// Of a seed that is the chain between CAMERA and STATION, with its uncertainty.
void followChain(const SessionCase& former, SessionCase& changed) {
  const auto before = seedOfFrames(framesOf(former));
  if (!before || !isSame(before->camera_from_station, changed.camera_from_station_seed)) return;
  const auto after = seedOfFrames(framesOf(changed));
  if (!after) refuseCut(changed, "seed", kStationFrame);
  changed.camera_from_station_seed = after->camera_from_station;
  DeclaredUncertainty limits = changed.uncertainty;
  setLimits(before->uncertainty.value_or(DeclaredUncertainty()), limits);
  if (limits == changed.uncertainty)
    setLimits(after->uncertainty.value_or(DeclaredUncertainty()), changed.uncertainty);
}

void followSeed(const SessionCase& former, SessionCase& changed) {
  if (!changed.has_seed) return;
  const Pose seed = changed.camera_from_station_seed;
  if (changed.station_frame)
    changed.camera_from_station_seed =
        keptInFrame(former, changed, "seed", *changed.station_frame, seed);
  else
    followChain(former, changed);
  if (!(changed.camera_from_station_seed == seed)) changed.camera_from_station_working.reset();
}

/// Another camera of the rig of a case whose frames change.
struct RigCamera {
  const SessionCase* other;
  bool by_frames;                 ///< its pose from the case comes from frames
  std::optional<Pose> from_case;  ///< that pose by the changed frames, where it differs
  Pose camera_from_rig;           ///< to be set
};

bool isMoving(const RigCamera& camera) { return camera.from_case.has_value(); }

/// A second image by a camera that did not move; stated apart from frames.
bool isSameCamera(const SessionCase& session_case, const SessionCase& other) {
  return isSame(Pose(), linkOfRig(session_case, other));
}

bool isReference(const SessionCase& session_case) {
  return isSame(Pose(), session_case.rig->camera_from_rig);
}

RigCamera rigCamera(const SessionCase& former, const SessionCase& changed,
                    const SessionCase& other) {
  RigCamera camera{&other, false, {}, other.rig->camera_from_rig};
  const auto before = linkOfFrames(former, other);
  if (!before || isSameCamera(former, other)) return camera;
  camera.by_frames = isSame(before->other_from_case, linkOfRig(former, other));
  if (!camera.by_frames) return camera;
  const auto after = linkOfFrames(changed, other);
  if (!after)
    refuseCut(
        changed, "pose in the rig", before->frame,
        "link the case with " + other.id + " by another pose first, or take it out of the rig");
  if (!(after->other_from_case == before->other_from_case)) {
    camera.from_case = after->other_from_case;
    camera.camera_from_rig = *camera.from_case * former.rig->camera_from_rig;
  }
  return camera;
}

/// The moving camera from which a camera that was linked apart from frames keeps its pose; nullptr:
/// it keeps the pose from the case. A session does not state which one it was linked with: that is
/// the same camera, otherwise the rig's reference, otherwise the case.
const RigCamera* keptWith(const SessionCase& former, const SessionCase& apart,
                          const std::vector<RigCamera>& cameras) {
  const auto moving = [&cameras](const auto& is_wanted) -> const RigCamera* {
    const auto found = std::ranges::find_if(cameras, [&](const RigCamera& camera) {
      return isMoving(camera) && is_wanted(*camera.other);
    });
    return found == cameras.end() ? nullptr : &*found;
  };
  if (isSameCamera(former, apart)) return nullptr;
  if (const auto* same = moving([&](const auto& other) { return isSameCamera(other, apart); }))
    return same;
  return isReference(former) ? nullptr : moving(isReference);
}

/// The cameras of the case's rig by the changed frames, the case being where it was. Empty when
/// none moves.
std::vector<RigCamera> movedCameras(const Session& session, const SessionCase& former,
                                    const SessionCase& changed) {
  std::vector<RigCamera> cameras;
  for (const std::string& id : casesOfRig(session, former.id))
    cameras.push_back(rigCamera(former, changed, *session.findCase(id)));
  if (std::ranges::none_of(cameras, isMoving)) return {};
  for (RigCamera& camera : cameras) {
    if (camera.by_frames) continue;
    if (const RigCamera* kept = keptWith(former, *camera.other, cameras))
      camera.camera_from_rig = *linkOfRig(*kept->other, *camera.other) * kept->camera_from_rig;
  }
  return cameras;
}

/// The motion of the rig frame after which the rig's reference, or else the first camera that
/// frames link with the case, is where it was.
Pose formerFromMoved(const SessionCase& former, const std::vector<RigCamera>& cameras) {
  if (isReference(former)) return Pose();
  auto fixed = std::ranges::find_if(
      cameras, [](const RigCamera& camera) { return isReference(*camera.other); });
  if (fixed == cameras.end()) fixed = std::ranges::find_if(cameras, isMoving);
  return fixed->camera_from_rig.inverse() * fixed->other->rig->camera_from_rig;
}

/// The session with the changed case, and with the cameras of its rig that its frames move.
Session withFollowingRig(const Session& session, const SessionCase& former, SessionCase changed) {
  const std::vector<RigCamera> cameras = movedCameras(session, former, changed);
  if (cameras.empty()) return withCase(session, std::move(changed));
  const Pose motion = formerFromMoved(former, cameras);
  const auto place = [&motion](const Pose& camera_from_rig, SessionCase& session_case) {
    const Pose placed = camera_from_rig * motion;
    if (!isSame(placed, session_case.rig->camera_from_rig))
      session_case.rig->camera_from_rig = placed;
  };
  place(former.rig->camera_from_rig, changed);
  Session next = withCase(session, std::move(changed));
  for (const RigCamera& camera : cameras)
    next = withChanged(next, camera.other->id, [&](SessionCase& session_case) {
      place(camera.camera_from_rig, session_case);
    });
  return next;
}

}  // namespace

std::optional<PoseFile> seedOfFrames(const FrameTree& frames) {
  const auto chain = frames.chain(kCameraFrame, kStationFrame);
  if (!chain) return std::nullopt;
  PoseFile seed;
  seed.camera_from_station = chain->a_from_b;
  if (!chain->covariance_stated) return seed;
  const Vector6d limits = kSeedSigmas * sigmasOf(chain->covariance);
  DeclaredUncertainty& uncertainty = seed.uncertainty.emplace();
  uncertainty.rotation_deg = limits.head<3>() / kDegree_rad;
  uncertainty.translation_m = limits.tail<3>();
  return seed;
}

void addLabelFrames(const std::filesystem::path& image,
                    const std::optional<CameraReference>& reference,
                    std::vector<FrameTransform>& transforms) {
  if (!hasImageLabel(image)) return;
  for (const LabelFrame& stated : readImageLabel(image).frames) {
    if (stated.frame == stated.reference ||
        frameTree(reference, transforms).chain(stated.reference, stated.frame))
      continue;
    FrameTransform transform;
    transform.target = stated.reference;
    transform.source = stated.frame;
    transform.target_from_source = stated.reference_from_frame;
    transform.origin = TransformSource::kLabel;
    transform.comment = "the image's label";
    transform.file = image;
    transform.file_sha256 = inputSha256(image);
    transforms.push_back(std::move(transform));
  }
}

void followFrames(const SessionCase& former, SessionCase& changed) {
  const auto before = cameraFromFrame(former, kEndEffectorFrame);
  const auto after = cameraFromFrame(changed, kEndEffectorFrame);
  if (!(before == after) && isSame(before, changed.camera_from_end_effector))
    changed.camera_from_end_effector = after;
  followSeed(former, changed);
  if (changed.camera_from_station_truth && changed.truth_frame)
    changed.camera_from_station_truth = keptInFrame(former, changed, "truth", *changed.truth_frame,
                                                    *changed.camera_from_station_truth);
}

Session withFrames(const Session& session, const std::string& case_id,
                   std::vector<FrameTransform> frames) {
  const SessionCase& former = knownCase(session, case_id);
  SessionCase changed = former;
  changed.frames = std::move(frames);
  return withChangedFrames(session, std::move(changed));
}

Session withChangedFrames(const Session& session, SessionCase changed) {
  const SessionCase& former = knownCase(session, changed.id);
  followFrames(former, changed);
  return withFollowingRig(session, former, std::move(changed));
}

}  // namespace boresight::sessions
