// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marked_view.h"

namespace boresight::sessions {

std::vector<MarkAddress> usedMarks(std::span<const MarkedView> views) {
  std::vector<MarkAddress> used;
  for (std::size_t view = 0; view < views.size(); ++view) {
    const Marks& marks = views[view].marks;
    for (std::size_t i = 0; i < marks.points.size(); ++i)
      if (marks.points[i].used()) used.push_back({view, MarkKind::kPoint, i});
    for (std::size_t i = 0; i < marks.lines.size(); ++i)
      if (marks.lines[i].used()) used.push_back({view, MarkKind::kLine, i});
  }
  return used;
}

const std::string& markId(std::span<const MarkedView> views, const MarkAddress& at) {
  const Marks& marks = views[at.view].marks;
  return at.kind == MarkKind::kPoint ? marks.points[at.index].id : marks.lines[at.index].id;
}

double markSigma_px(std::span<const MarkedView> views, const MarkAddress& at) {
  const Marks& marks = views[at.view].marks;
  return at.kind == MarkKind::kPoint ? marks.points[at.index].sigma_px
                                     : marks.lines[at.index].sigma_px;
}

}  // namespace boresight::sessions
