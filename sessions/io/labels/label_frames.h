// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/labels/image_label.h"
#include "sessions/io/labels/label_files.h"

namespace boresight::sessions {

/// The frames whose place the label tells: groups NAME_COORDINATE_SYSTEM of VICAR and PDS3,
/// Coordinate_Space_Definition of PDS4. Quaternions are scalar first and, with the offset, map a
/// frame's vectors into its reference. What cannot be read is left out with a sentence in `flags`.
std::vector<LabelFrame> labelFrames(LabelFormat format, const nlohmann::json& label,
                                    std::vector<std::string>& flags);

}  // namespace boresight::sessions
