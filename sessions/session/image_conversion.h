// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// The same image, become 8 bit by another rule. Reads the file; InputError when it is no longer
/// the one that the session knows, or the rule does not fit it.
ImageInput converted(const ImageInput& image, const ImageReadOptions& eight_bit);

/// Images of cases after a conversion.
struct Conversion {
  std::string case_id;
  ImageInput image;
};
/// The session with those of the images in place that are still of the same file.
Session withConversions(const Session& session, const std::vector<Conversion>& conversions);

}  // namespace boresight::sessions
