// SPDX-License-Identifier: Apache-2.0
// Edits of marks as values: what an annotator's gestures do to them.
#pragma once

#include <string>

#include "sessions/annotation/marks.h"

namespace boresight::sessions {

/// nullptr when there is none of this id.
const PointPair* findPoint(const Marks& marks, const std::string& id);
const LinePair* findLine(const Marks& marks, const std::string& id);

/// The same marks with this one in place of that of id `replaced`, or at the end.
Marks withPoint(Marks marks, const std::string& replaced, const PointPair& point);
Marks withLine(Marks marks, const std::string& replaced, const LinePair& line);
/// The same marks without one.
Marks withoutMark(Marks marks, const std::string& id);

/// A mark moved in the image as a whole, or by one end of its line (0 or 1). What has no place in
/// the image stays as it is.
Marks withMoved(Marks marks, const std::string& id, int end, const Eigen::Vector2d& to_px);

}  // namespace boresight::sessions
