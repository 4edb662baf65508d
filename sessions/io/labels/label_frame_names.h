// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/camera_file.h"

namespace boresight::sessions {

/// A frame by its name and index in a group of a VICAR or PDS3 label. One whose index is not of
/// whole numbers could be taken for another: it stays without a name, with a sentence in `flag`.
FrameName groupFrame(const nlohmann::json& group, std::string_view name, std::string_view index,
                     std::string& flag);

/// The same of a Coordinate_Space_Indexed of a PDS4 label.
FrameName indexedFrame(const nlohmann::json& space, std::string& flag);

}  // namespace boresight::sessions
