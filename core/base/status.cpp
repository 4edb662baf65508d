// SPDX-License-Identifier: Apache-2.0
#include "core/base/status.h"

#include "core/base/enum_name.h"

namespace boresight {

const char* statusText(Status status) {
  return enumName<kLastStatus>(
      status,
      {"ok", "invalid_option", "invalid_image", "invalid_camera", "invalid_mesh", "invalid_pose",
       "arena_too_small", "capacity_exceeded", "too_few_edges", "too_few_templates",
       "too_few_points", "degenerate", "no_consensus", "too_many_layers", "memory_changed"});
}

}  // namespace boresight
