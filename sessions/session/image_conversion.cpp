// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/image_conversion.h"

#include <utility>

#include "sessions/session/known_image.h"

namespace boresight::sessions {

ImageInput converted(const ImageInput& image, const ImageReadOptions& eight_bit) {
  const GrayImage read = readKnownImage(image, eight_bit);
  ImageInput made = image;
  made.eight_bit = eight_bit;
  made.pixels_sha256 = read.pixels_sha256;
  return made;
}

Session withConversions(const Session& session, const std::vector<Conversion>& conversions) {
  Session next = session;
  for (const Conversion& conversion : conversions) {
    const SessionCase* one = next.findCase(conversion.case_id);
    if (one == nullptr || !(one->image.source == conversion.image.source)) continue;
    SessionCase changed = *one;
    changed.image = conversion.image;
    next = withCase(next, std::move(changed));
  }
  return next;
}

}  // namespace boresight::sessions
