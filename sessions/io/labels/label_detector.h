// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/io/labels/image_label.h"

namespace boresight::sessions {

/// What is known of a mission's labels and of the instrument that took an image.
struct LabelDetector {
  /// Labels state the model of the image as it was cut and averaged: the mission's own programs
  /// read it without an offset (planetary.md names the evidence).
  bool model_of_subframe = false;
  int width = 0;  ///< at most so many samples has the detector; 0: not known
  int height = 0;
};

LabelDetector detectorOf(const std::vector<LabelItem>& identifiers);

}  // namespace boresight::sessions
