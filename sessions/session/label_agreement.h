// SPDX-License-Identifier: Apache-2.0
// Whether what people gave for a case agrees with what the label of its image says.
#pragma once

#include <string>
#include <vector>

#include "sessions/io/labels/image_label.h"
#include "sessions/session/input_sheet.h"

namespace boresight::sessions {

/// Adds `camera_label` where the case's camera is another one than the label's or stands elsewhere
/// in the same frame, and `transform_label` where a transform that was given places a frame of the
/// label elsewhere than the label does; takes `camera_off_centre` away where the camera is that of
/// the sub-frame which the label states. Nothing is changed by it: what people gave counts.
void flagLabel(const SessionCase& one, const ImageLabel& label, std::vector<RedFlag>& flags);

/// The same of the label of the case's image, as sentences; none where it has no label. InputError.
std::vector<std::string> labelWarnings(const SessionCase& one);

}  // namespace boresight::sessions
