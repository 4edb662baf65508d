// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// A named fact, for people.
struct FrameLine {
  std::string label;
  std::string value;
};

/// In which frames the camera model and the seed were given, and what joined the two; nothing for a
/// camera without a reference frame.
std::vector<FrameLine> frameLines(const SessionCase& one);

}  // namespace boresight::sessions
