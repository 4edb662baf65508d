// SPDX-License-Identifier: Apache-2.0
#include "core/base/status.h"

namespace boresight {

const char* statusText(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kInvalidOption:
      return "invalid_option";
    case Status::kInvalidImage:
      return "invalid_image";
    case Status::kInvalidCamera:
      return "invalid_camera";
    case Status::kInvalidMesh:
      return "invalid_mesh";
    case Status::kInvalidPose:
      return "invalid_pose";
    case Status::kArenaTooSmall:
      return "arena_too_small";
    case Status::kCapacityExceeded:
      return "capacity_exceeded";
    case Status::kTooFewEdges:
      return "too_few_edges";
    case Status::kTooFewTemplates:
      return "too_few_templates";
    case Status::kTooFewPoints:
      return "too_few_points";
    case Status::kDegenerate:
      return "degenerate";
    case Status::kNoConsensus:
      return "no_consensus";
    case Status::kTooManyLayers:
      return "too_many_layers";
    case Status::kMemoryChanged:
      return "memory_changed";
  }
  return "unknown";
}

}  // namespace boresight
