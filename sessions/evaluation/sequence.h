// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/io/images/frame_source.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/run/pose_follower.h"
#include "sessions/run/runner.h"

namespace boresight::sessions {

/// Default of the largest motion between two frames: 5 mm and 1 deg about the station.
DeclaredUncertainty assumedMotion();

/// Inputs that the frames of a sequence share.
struct SequenceInputs {
  std::string station;  ///< its name in the results
  Camera camera;
  SceneMesh scene;
  std::optional<IgnoreMask> ignore;
  Pose camera_from_station_seed;  ///< of the first frame
  DeclaredUncertainty uncertainty;
  DeclaredUncertainty motion = assumedMotion();  ///< between two frames, at most
  std::optional<Pose> camera_from_end_effector;
  LocalizerOptions options;
  RunSettings settings;
};

/// Localizes the frames of a sequence one after the other, each from the last accepted pose
/// (PoseFollower), in the memory of the first. A frame is lost when its run does not converge, its
/// image is missing or of another size ("input_error"), or the station is not visible from its seed
/// ("bad_seed").
class Sequence {
 public:
  explicit Sequence(SequenceInputs inputs);
  Sequence(const Sequence&) = delete;
  Sequence& operator=(const Sequence&) = delete;

  /// The next frame. After a stop its status is "running", and it can be run again.
  RunResult run(const Frame& frame, const std::stop_token& stop = {});
  /// Takes the result of the next frame from an earlier process.
  void take(const RunResult& result);

  /// Number of frames so far.
  std::int64_t frames() const { return frames_; }
  /// Frames that were lost, counted from 1.
  const std::vector<std::int64_t>& lost() const { return lost_; }

 private:
  void localize(const GrayImage& image, const std::stop_token& stop, RunResult& result);

  SequenceInputs inputs_;
  BitImage ignore_;
  PoseFollower follower_;
  std::unique_ptr<Runner> runner_;
  std::int64_t frames_ = 0;
  std::vector<std::int64_t> lost_;
};

/// "238 of 240 frames accepted, 2 lost: 17, 18"; ranges of three and more as "20-31".
std::string sequenceText(const Sequence& sequence);

}  // namespace boresight::sessions
