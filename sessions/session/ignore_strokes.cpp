// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/ignore_strokes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "sessions/session/session.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

/// Pixels of one row or column from `first` to `last`, both inside the image.
struct PixelRange {
  int first = 0;
  int last = -1;
};

/// The pixels with low <= centre <= high.
PixelRange pixelsBetween(double low, double high, int size) {
  const double first = std::clamp(std::ceil(low), 0.0, static_cast<double>(size));
  const double last = std::clamp(std::floor(high), -1.0, static_cast<double>(size - 1));
  return {static_cast<int>(first), static_cast<int>(last)};
}

void setPixel(BitImage& mask, int x, int y, bool erase) {
  if (erase)
    mask.reset(x, y);
  else
    mask.set(x, y);
}

double squaredDistance(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared_length = along.squaredNorm();
  if (squared_length == 0.0) return (point - a).squaredNorm();
  const double t = std::clamp((point - a).dot(along) / squared_length, 0.0, 1.0);
  return (a + t * along - point).squaredNorm();
}

void brushSegment(const MaskStroke& stroke, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                  BitImage& mask) {
  const double radius_px = stroke.radius_px;
  const Eigen::Vector2d low = a.cwiseMin(b).array() - radius_px;
  const Eigen::Vector2d high = a.cwiseMax(b).array() + radius_px;
  const PixelRange rows = pixelsBetween(low.y(), high.y(), mask.height);
  const PixelRange columns = pixelsBetween(low.x(), high.x(), mask.width);
  for (int y = rows.first; y <= rows.last; ++y)
    for (int x = columns.first; x <= columns.last; ++x)
      if (squaredDistance({x, y}, a, b) <= radius_px * radius_px)
        setPixel(mask, x, y, stroke.erase);
}

void fillPolygon(const MaskStroke& stroke, BitImage& mask) {
  const std::vector<Eigen::Vector2d>& points = stroke.points;
  std::vector<double> crossings;
  for (int y = 0; y < mask.height; ++y) {
    crossings.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d& a = points[i];
      const Eigen::Vector2d& b = points[(i + 1) % points.size()];
      if ((a.y() <= y) == (b.y() <= y)) continue;
      crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const PixelRange columns = pixelsBetween(crossings[i], crossings[i + 1], mask.width);
      for (int x = columns.first; x <= columns.last; ++x) setPixel(mask, x, y, stroke.erase);
    }
  }
}

void markSaturated(const MaskStroke& stroke, const ImageView& image, BitImage& mask) {
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (image.at(x, y) >= stroke.level) setPixel(mask, x, y, stroke.erase);
}

void applyStroke(const MaskStroke& stroke, const ImageView& image, BitImage& mask) {
  switch (stroke.kind) {
    case StrokeKind::kBrush:
      for (std::size_t i = 0; i < stroke.points.size(); ++i)
        brushSegment(stroke, stroke.points[i > 0 ? i - 1 : 0], stroke.points[i], mask);
      return;
    case StrokeKind::kPolygon:
      return fillPolygon(stroke, mask);
    case StrokeKind::kSaturation:
      return markSaturated(stroke, image, mask);
  }
}

bool contains(const MaskStrokes& strokes, const MaskStroke& stroke) {
  return std::ranges::find(strokes, stroke) != strokes.end();
}

bool sameCamera(const SessionCase& a, const SessionCase& b) {
  return a.camera == b.camera && a.image.width == b.image.width && a.image.height == b.image.height;
}

}  // namespace

void applyStrokes(const MaskStrokes& strokes, const ImageView& image, IgnoreMask& mask) {
  BitImage bits = mask.view();
  for (const MaskStroke& stroke : strokes) applyStroke(stroke, image, bits);
  mask.ignored_count = 0;
  for (const std::uint64_t word : mask.words) mask.ignored_count += std::popcount(word);
}

Session withStrokes(const Session& session, const std::string& case_id, MaskStrokes strokes) {
  return withChanged(session, case_id, [&](SessionCase& session_case) {
    session_case.ignore_strokes = std::move(strokes);
  });
}

Session withStroke(const Session& session, const std::string& case_id, MaskStroke stroke) {
  return withChanged(session, case_id, [&](SessionCase& session_case) {
    session_case.ignore_strokes.push_back(std::move(stroke));
  });
}

MaskStrokes clearedStrokes(const SessionCase& session_case) {
  if (!session_case.ignore) return {};
  MaskStroke all;
  all.kind = StrokeKind::kSaturation;
  all.erase = true;
  all.level = 0;
  return {all};
}

std::vector<std::string> casesOfSameCamera(const Session& session, const std::string& case_id) {
  std::vector<std::string> ids;
  const SessionCase* session_case = session.findCase(case_id);
  if (session_case == nullptr) return ids;
  for (const auto& other : session.cases)
    if (other->id != case_id && sameCamera(*other, *session_case)) ids.push_back(other->id);
  return ids;
}

Session copyingStroke(const Session& session, const std::string& case_id, std::size_t stroke) {
  const SessionCase* session_case = session.findCase(case_id);
  if (session_case == nullptr || stroke >= session_case->ignore_strokes.size()) return session;
  const MaskStroke& copied = session_case->ignore_strokes[stroke];
  Session next = session;
  for (const std::string& id : casesOfSameCamera(session, case_id))
    if (!contains(session.findCase(id)->ignore_strokes, copied))
      next = withStroke(next, id, copied);
  return next;
}

MaskStrokes namedStrokesOfCamera(const Session& session, const std::string& case_id) {
  MaskStrokes named;
  const SessionCase* session_case = session.findCase(case_id);
  if (session_case == nullptr) return named;
  for (const std::string& id : casesOfSameCamera(session, case_id))
    for (const MaskStroke& stroke : session.findCase(id)->ignore_strokes)
      if (!stroke.name.empty() && !contains(session_case->ignore_strokes, stroke) &&
          !contains(named, stroke))
        named.push_back(stroke);
  return named;
}

std::string strokeText(const MaskStroke& stroke) {
  std::string text = stroke.erase ? "erase: " : "";
  switch (stroke.kind) {
    case StrokeKind::kBrush:
      text += "brush, " + threeDigits(2.0 * stroke.radius_px) + " px wide";
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
