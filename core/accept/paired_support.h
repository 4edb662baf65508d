// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/accept/edge_support.h"
#include "core/base/image.h"
#include "core/geometry/pose.h"
#include "core/render/edge_render.h"

namespace boresight {

/// Where one of two poses predicts edges and the other none, and which of these the image shows.
/// What both predict says nothing of which is right, but how well the image shows what is there.
struct PairedSupport {
  std::int32_t own = 0;                ///< edge pixels that one pose alone predicts, not ignored
  std::int32_t own_covered = 0;        ///< of those, seen in the image
  std::int32_t other = 0;              ///< that the other alone predicts
  std::int32_t other_covered = 0;      ///< of those, seen in the image
  std::int32_t common = 0;             ///< edge pixels that both predict
  std::int32_t common_covered = 0;     ///< of those, seen in the image
  std::int32_t displaced = 0;          ///< of the one pose, displaced: what comes about by chance
  std::int32_t displaced_covered = 0;  ///< of those, seen in the image

  /// Log ratio of the probabilities of what was seen under the one pose and under the other, in
  /// nats: an edge that is there is seen as often as those that both predict, one that is not as
  /// often as a displaced one. Neighbouring pixels go together: their number is divided
  /// accordingly. 0 where edges that are there are seen no more often than by chance.
  double nats() const;
};

/// Both renders are of one level and one camera; `image` is raw, at full resolution.
PairedSupport comparePredictions(const EdgeRender& own, const EdgeRender& other, int level,
                                 const ImageView& image, const BitImage* ignore);

/// Copies a render into the memory of another, which must be as large.
void copyRender(const EdgeRender& from, EdgeRender& to);

}  // namespace boresight
