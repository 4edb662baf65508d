// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

template <class Marks>
auto findIn(Marks& marks, const std::string& id) {
  return std::find_if(marks.begin(), marks.end(), [&](const auto& mark) { return mark.id == id; });
}

template <class Mark>
const Mark* find(const std::vector<Mark>& marks, const std::string& id) {
  const auto found = findIn(marks, id);
  return found == marks.end() ? nullptr : &*found;
}

template <class Mark>
void put(std::vector<Mark>& marks, const std::string& replaced, const Mark& mark) {
  const auto found = findIn(marks, replaced);
  if (found == marks.end())
    marks.push_back(mark);
  else
    *found = mark;
}

}  // namespace

bool hasMark(const Marks& marks, const std::string& id) {
  return findPoint(marks, id) != nullptr || findLine(marks, id) != nullptr;
}

std::string unusedId(const Marks& marks, char letter) {
  for (int number = 1;; ++number) {
    const std::string id = letter + std::to_string(number);
    if (!hasMark(marks, id)) return id;
  }
}

const PointPair* findPoint(const Marks& marks, const std::string& id) {
  return find(marks.points, id);
}

const LinePair* findLine(const Marks& marks, const std::string& id) {
  return find(marks.lines, id);
}

Marks withPoint(Marks marks, const std::string& replaced, const PointPair& point) {
  put(marks.points, replaced, point);
  return marks;
}

Marks withLine(Marks marks, const std::string& replaced, const LinePair& line) {
  put(marks.lines, replaced, line);
  return marks;
}

Marks withoutMark(Marks marks, const std::string& id) {
  std::erase_if(marks.points, [&](const PointPair& point) { return point.id == id; });
  std::erase_if(marks.lines, [&](const LinePair& line) { return line.id == id; });
  return marks;
}

Marks withMoved(Marks marks, const std::string& id, int end, const Eigen::Vector2d& to_px) {
  const auto point = findIn(marks.points, id);
  if (point != marks.points.end() && point->pixel) point->pixel = to_px;
  const auto line = findIn(marks.lines, id);
  if (line != marks.lines.end() && line->line)
    (end == 0 ? line->line->start : line->line->end) = to_px;
  return marks;
}

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
