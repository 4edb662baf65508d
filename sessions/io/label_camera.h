// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/image_label.h"
#include "sessions/io/label_files.h"

namespace boresight::sessions {

/// The camera model of a label as it stands there, or why there is none.
struct StatedCamera {
  std::optional<CahvModel> cahv;
  FrameName frame;
  std::vector<LabelItem> items;  ///< source, filter, solution
  std::string remark;            ///< one sentence where there is no model
};

/// Of a VICAR or PDS3 label: the group GEOMETRIC_CAMERA_MODEL, GEOMETRIC_CAMERA_MODEL_PARMS or
/// CAMERA_MODEL; components by their names or letters, never by place alone. Of a PDS4 label:
/// Camera_Model_Parameters with its CAHV_Model, CAHVOR_Model or CAHVORE_Model.
StatedCamera statedCamera(LabelFormat format, const nlohmann::json& label);

/// A Coordinate_Space_Indexed of a PDS4 label.
FrameName indexedFrame(const nlohmann::json& space);

/// What is wrong with the model for an image of this size and sub-frame: one sentence, or nothing.
/// `of_subframe` says whether labels of this mission state the model of the sub-frame; where that
/// is not known, a cut image's model must show it by itself.
std::string cameraMisfit(const CahvModel& cahv, int width, int height,
                         const std::optional<LabelSubframe>& subframe, bool of_subframe);

}  // namespace boresight::sessions
