// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/mask_edits.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace boresight::sessions {
namespace {

bool contains(const MaskStrokes& strokes, const MaskStroke& stroke) {
  return std::find(strokes.begin(), strokes.end(), stroke) != strokes.end();
}

bool sameCamera(const SessionCase& a, const SessionCase& b) {
  return a.camera == b.camera && a.image.width == b.image.width && a.image.height == b.image.height;
}

}  // namespace

Session withStrokes(const Session& session, const std::string& case_id, MaskStrokes strokes) {
  return withChanged(session, case_id,
                     [&](SessionCase& one) { one.ignore_strokes = std::move(strokes); });
}

Session withStroke(const Session& session, const std::string& case_id, MaskStroke stroke) {
  return withChanged(session, case_id,
                     [&](SessionCase& one) { one.ignore_strokes.push_back(std::move(stroke)); });
}

MaskStrokes clearedStrokes(const SessionCase& one) {
  if (!one.ignore) return {};
  MaskStroke all;
  all.kind = StrokeKind::kSaturation;
  all.erase = true;
  all.level = 0;
  return {all};
}

std::vector<std::string> casesOfSameCamera(const Session& session, const std::string& case_id) {
  std::vector<std::string> ids;
  const SessionCase* one = session.findCase(case_id);
  if (one == nullptr) return ids;
  for (const auto& other : session.cases)
    if (other->id != case_id && sameCamera(*other, *one)) ids.push_back(other->id);
  return ids;
}

Session copyingStroke(const Session& session, const std::string& case_id, std::size_t stroke) {
  const SessionCase* one = session.findCase(case_id);
  if (one == nullptr || stroke >= one->ignore_strokes.size()) return session;
  const MaskStroke& copied = one->ignore_strokes[stroke];
  Session next = session;
  for (const std::string& id : casesOfSameCamera(session, case_id))
    if (!contains(session.findCase(id)->ignore_strokes, copied))
      next = withStroke(next, id, copied);
  return next;
}

MaskStrokes namedStrokesOfCamera(const Session& session, const std::string& case_id) {
  MaskStrokes named;
  const SessionCase* one = session.findCase(case_id);
  if (one == nullptr) return named;
  for (const std::string& id : casesOfSameCamera(session, case_id))
    for (const MaskStroke& stroke : session.findCase(id)->ignore_strokes)
      if (!stroke.name.empty() && !contains(one->ignore_strokes, stroke) &&
          !contains(named, stroke))
        named.push_back(stroke);
  return named;
}

std::string strokeText(const MaskStroke& stroke) {
  std::string text = stroke.erase ? "erase: " : "";
  char width_px[32];
  switch (stroke.kind) {
    case StrokeKind::kBrush:
      std::snprintf(width_px, sizeof width_px, "%.3g", 2.0 * stroke.radius_px);
      text += "brush, " + std::string(width_px) + " px wide";
      break;
    case StrokeKind::kPolygon:
      text += "polygon of " + std::to_string(stroke.points.size()) + " corners";
      break;
    case StrokeKind::kSaturation:
      text +=
          stroke.level == 0 ? "all pixels" : "pixels of at least " + std::to_string(stroke.level);
      break;
  }
  return stroke.name.empty() ? text : stroke.name + " (" + text + ")";
}

}  // namespace boresight::sessions
