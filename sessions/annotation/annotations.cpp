// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

template <class Annotations>
auto findIn(Annotations& annotations, const std::string& id) {
  return std::ranges::find(annotations, id, &Annotations::value_type::id);
}

template <class Annotation>
const Annotation* find(const std::vector<Annotation>& annotations, const std::string& id) {
  const auto found = findIn(annotations, id);
  return found == annotations.end() ? nullptr : &*found;
}

template <class Annotation>
void put(std::vector<Annotation>& annotations, const std::string& replaced,
         const Annotation& annotation) {
  const auto found = findIn(annotations, replaced);
  if (found == annotations.end())
    annotations.push_back(annotation);
  else
    *found = annotation;
}

}  // namespace

bool hasAnnotation(const Annotations& annotations, const std::string& id) {
  return findPoint(annotations, id) != nullptr || findLine(annotations, id) != nullptr;
}

std::string unusedId(const Annotations& annotations, char letter) {
  for (int number = 1;; ++number) {
    const std::string id = letter + std::to_string(number);
    if (!hasAnnotation(annotations, id)) return id;
  }
}

const PointPair* findPoint(const Annotations& annotations, const std::string& id) {
  return find(annotations.points, id);
}

const LinePair* findLine(const Annotations& annotations, const std::string& id) {
  return find(annotations.lines, id);
}

Annotations withPair(Annotations annotations, const std::string& replaced, const PointPair& point) {
  put(annotations.points, replaced, point);
  return annotations;
}

Annotations withPair(Annotations annotations, const std::string& replaced, const LinePair& line) {
  put(annotations.lines, replaced, line);
  return annotations;
}

Annotations withoutAnnotation(Annotations annotations, const std::string& id) {
  std::erase_if(annotations.points, [&](const PointPair& point) { return point.id == id; });
  std::erase_if(annotations.lines, [&](const LinePair& line) { return line.id == id; });
  return annotations;
}

Annotations withMoved(Annotations annotations, const std::string& id, int end,
                      const Eigen::Vector2d& to_px) {
  const auto point = findIn(annotations.points, id);
  if (point != annotations.points.end() && point->pixel) point->pixel = to_px;
  const auto line = findIn(annotations.lines, id);
  if (line != annotations.lines.end() && line->line)
    (end == 0 ? line->line->start : line->line->end) = to_px;
  return annotations;
}

std::vector<AnnotationAddress> usedAnnotations(std::span<const AnnotatedView> views) {
  std::vector<AnnotationAddress> used;
  for (std::size_t view = 0; view < views.size(); ++view) {
    const Annotations& annotations = views[view].annotations;
    for (std::size_t i = 0; i < annotations.points.size(); ++i)
      if (annotations.points[i].used()) used.push_back({view, AnnotationKind::kPoint, i});
    for (std::size_t i = 0; i < annotations.lines.size(); ++i)
      if (annotations.lines[i].used()) used.push_back({view, AnnotationKind::kLine, i});
  }
  return used;
}

const std::string& annotationId(std::span<const AnnotatedView> views, const AnnotationAddress& at) {
  const Annotations& annotations = views[at.view].annotations;
  return at.kind == AnnotationKind::kPoint ? annotations.points[at.index].id
                                           : annotations.lines[at.index].id;
}

double annotationSigma_px(std::span<const AnnotatedView> views, const AnnotationAddress& at) {
  const Annotations& annotations = views[at.view].annotations;
  return at.kind == AnnotationKind::kPoint ? annotations.points[at.index].sigma_px
                                           : annotations.lines[at.index].sigma_px;
}

}  // namespace boresight::sessions
