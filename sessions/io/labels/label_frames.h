// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/camera_file.h"
#include "sessions/io/labels/image_label.h"
#include "sessions/io/labels/label_files.h"

namespace boresight::sessions {

/// A frame by its name and index in a group of a VICAR or PDS3 label. One whose index is not of
/// whole numbers could be taken for another: it stays without a name, with a sentence in `flag`.
FrameName groupFrame(const nlohmann::json& group, std::string_view name, std::string_view index,
                     std::string& flag);

/// The same of a Coordinate_Space_Indexed of a PDS4 label.
FrameName indexedFrame(const nlohmann::json& space, std::string& flag);

/// The frames whose place the label tells: groups NAME_COORDINATE_SYSTEM of VICAR and PDS3,
/// Coordinate_Space_Definition of PDS4. Quaternions are scalar first and, with the offset, map a
/// frame's vectors into its reference. What cannot be read is left out with a sentence in `flags`.
std::vector<LabelFrame> labelFrames(LabelFormat format, const nlohmann::json& label,
                                    std::vector<std::string>& flags);

}  // namespace boresight::sessions
