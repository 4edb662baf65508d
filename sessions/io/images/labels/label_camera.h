// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_files.h"

namespace boresight::sessions {

/// Known facts on a mission's labels and on the instrument of an image.
struct LabelDetector {
  /// Labels state the model of the cut and averaged image: the mission's programs read it without
  /// an offset (planetary.md names the evidence).
  bool model_of_subframe = false;
  int width = 0;  ///< upper bound of the detector's samples; 0: not known
  int height = 0;
};

LabelDetector detectorOf(const std::vector<LabelItem>& identifiers);

/// The camera model as stated in a label, or why there is none.
struct StatedCamera {
  std::optional<CahvModel> cahv;
  FrameName frame;
  std::vector<LabelItem> items;    ///< source, filter, solution
  std::string remark;              ///< one sentence where there is no model
  std::vector<std::string> flags;  ///< a sentence where the frame's name is not usable
};

/// Of a VICAR or PDS3 label: the group GEOMETRIC_CAMERA_MODEL, GEOMETRIC_CAMERA_MODEL_PARMS or
/// CAMERA_MODEL; components by their names or letters, never by order alone; contradictory models
/// count as none. Of a PDS4 label: Camera_Model_Parameters with its CAHV_Model, CAHVOR_Model or
/// CAHVORE_Model.
StatedCamera statedCamera(LabelFormat format, const nlohmann::json& label);

/// The groups of VICAR and PDS3 labels with a camera model.
bool isCameraGroup(std::string_view name);

/// Whether two labels state one model in one frame, within their stated digits.
bool sameModel(const StatedCamera& a, const StatedCamera& b);

/// A frame by its name and index in a group of a VICAR or PDS3 label. A frame whose index is not
/// integral could be confused with another: it gets no name, and a sentence in `flags`.
FrameName groupFrame(const nlohmann::json& group, std::string_view name, std::string_view index,
                     std::vector<std::string>& flags);

/// The same of a Coordinate_Space_Indexed of a PDS4 label.
FrameName indexedFrame(const nlohmann::json& space, std::vector<std::string>& flags);

/// The frames whose pose the label states: groups NAME_COORDINATE_SYSTEM of VICAR and PDS3,
/// Coordinate_Space_Definition of PDS4. Quaternions are scalar first and, with the offset, map a
/// frame's vectors into its reference. Unreadable frames are left out with a sentence in `flags`.
std::vector<LabelFrame> labelFrames(LabelFormat format, const nlohmann::json& label,
                                    std::vector<std::string>& flags);

/// Why the model does not fit an image of this size and sub-frame: one sentence, or "". Unless
/// labels of this mission are known to state the model of the sub-frame, a cut image's model must
/// itself prove it.
std::string cameraMisfit(const CahvModel& cahv, int width, int height,
                         const std::optional<LabelSubframe>& subframe,
                         const LabelDetector& detector);

}  // namespace boresight::sessions
