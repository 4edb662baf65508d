// SPDX-License-Identifier: Apache-2.0
// Named frames joined by transforms: telemetry, calibrations, labels.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sessions/io/cameras/frame_transform.h"

namespace boresight::sessions {

/// Frames with a fixed meaning: the camera frame (x right, y down, z forward), the station frame,
/// and the end effector's.
inline const FrameName kCameraFrame{"CAMERA", {}};
inline const FrameName kStationFrame{"STATION", {}};
inline const FrameName kEndEffectorFrame{"END_EFFECTOR", {}};

/// A transform of a chain, in the direction in which the chain passes it.
struct FrameLink {
  const FrameTransform* transform = nullptr;
  bool inverted = false;
  Pose to_from_from;
  Matrix6d covariance = Matrix6d::Zero();  ///< left perturbation, frame `to`
  /// Share of the chain's covariance: left perturbation, first frame of the chain.
  Matrix6d contribution = Matrix6d::Zero();

  const FrameName& to() const { return inverted ? transform->source : transform->target; }
  const FrameName& from() const { return inverted ? transform->target : transform->source; }
};

/// The transform between two frames with the transforms that it is composed of.
struct FrameChain {
  Pose a_from_b;
  /// Left perturbation, frame a: the links' contributions, as if their errors were independent.
  Matrix6d covariance = Matrix6d::Zero();
  bool covariance_stated = false;  ///< whether a link states one; the others count as exact
  std::vector<FrameLink> links;    ///< from a to b

  /// "CAMERA, END_EFFECTOR, ARM_BASE".
  std::string path() const;
};

/// Transforms without loops. A transform that is given twice with the same numbers counts once.
class FrameTree {
 public:
  FrameTree() = default;
  /// InputError about the file of the transform that closes a loop, with both paths and their
  /// difference.
  explicit FrameTree(std::vector<FrameTransform> transforms);

  /// Empty when the frames are not joined.
  std::optional<FrameChain> chain(const FrameName& a, const FrameName& b) const;
  /// All frames, in the order in which the transforms name them.
  std::vector<FrameName> frames() const;
  const std::vector<FrameTransform>& transforms() const { return transforms_; }

 private:
  std::vector<FrameTransform> transforms_;
};

/// A frame of a tree and its parent.
struct FrameRow {
  FrameName frame;
  int parent = -1;  ///< index of the parent's row, before this one; -1: CAMERA, or a frame not
                    ///< joined with it
  /// The transform between frame and parent, in either direction; empty without a parent.
  std::optional<FrameTransform> transform;
  Pose parent_from_frame;
  std::optional<Vector6d> sigma;  ///< (rad, m) per axis of the parent; empty: exact
};

/// All frames of a tree: CAMERA and the frames joined with it, then the others. Parents come first.
std::vector<FrameRow> frameRows(const FrameTree& tree);

/// The tree of the transforms and of the frame in which a camera model is given.
FrameTree frameTree(const std::optional<CameraReference>& reference,
                    std::span<const FrameTransform> transforms);

/// One sigma of rotation (rad) and translation (m) per axis: the square roots of a covariance's
/// diagonal.
Vector6d sigmasOf(const Matrix6d& covariance);

}  // namespace boresight::sessions
