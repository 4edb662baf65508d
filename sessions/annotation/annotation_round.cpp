// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotation_round.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace boresight::sessions {
namespace {

/// Pairs of both lists that have the same id and both sides.
template <class Pair, class Compare>
void compareAll(const std::vector<Pair>& first, const std::vector<Pair>& second, Compare&& compare,
                std::vector<AnnotationDifference>& differences) {
  for (const Pair& item : first) {
    const auto other = std::ranges::find(second, item.id, &Pair::id);
    if (other == second.end() || !item.complete() || !other->complete()) continue;
    differences.push_back({item.id, compare(item, *other)});
  }
}

/// How far the ends of the second line lie across the first one, to the side where y points when
/// the first one's direction is x. The end near the first one's start comes first.
Eigen::Vector2d acrossLine(const ImageLine& first, const ImageLine& second) {
  const Eigen::Vector2d direction = (first.end - first.start).normalized();
  const Eigen::Vector2d across(-direction.y(), direction.x());
  const auto distance = [&](const Eigen::Vector2d& end) { return across.dot(end - first.start); };
  const bool same_way = direction.dot(second.end - second.start) >= 0.0;
  return same_way ? Eigen::Vector2d(distance(second.start), distance(second.end))
                  : Eigen::Vector2d(distance(second.end), distance(second.start));
}

/// What the next person begins with, of a pair.
template <class Pair>
Pair blindPair(const Pair& pair) {
  Pair blind;
  blind.id = pair.id;
  blind.sigma_px = pair.sigma_px;
  blind.enabled = pair.enabled;
  blind.comment = pair.comment;
  return blind;
}

}  // namespace

Annotations blindAnnotations(const Annotations& annotations) {
  Annotations blind;
  for (const PointPair& point : annotations.points) {
    if (!point.point_in_station_m) continue;
    blind.points.push_back(blindPair(point));
    blind.points.back().point_in_station_m = point.point_in_station_m;
  }
  for (const LinePair& line : annotations.lines) {
    if (!line.edge) continue;
    blind.lines.push_back(blindPair(line));
    blind.lines.back().edge = line.edge;
  }
  return blind;
}

bool isBlind(const AnnotationRounds& rounds, const Annotations& annotations) {
  const auto lacks = [&rounds](const auto& at_work, auto of_round, auto side) {
    return std::ranges::any_of(at_work, [&](const auto& pair) {
      return !(pair.*side) && std::ranges::any_of(rounds, [&](const AnnotationRound& round) {
        return std::ranges::any_of(round.annotations.*of_round, [&](const auto& placed) {
          return placed.id == pair.id && placed.*side;
        });
      });
    });
  };
  return lacks(annotations.points, &Annotations::points, &PointPair::pixel) ||
         lacks(annotations.lines, &Annotations::lines, &LinePair::line);
}

AnnotationRounds keepingAnnotations(AnnotationRounds rounds, const Annotations& annotations,
                                    const std::string& time) {
  const auto placed = [](const auto& side) { return side.has_value(); };
  const bool on_image = std::ranges::any_of(annotations.points, placed, &PointPair::pixel) ||
                        std::ranges::any_of(annotations.lines, placed, &LinePair::line);
  const auto kept = std::ranges::find(rounds, annotations, &AnnotationRound::annotations);
  if (on_image && kept == rounds.end())
    rounds.push_back({"current annotations", time, annotations});
  return rounds;
}

Repeatability repeatability(const Annotations& first, const Annotations& second) {
  Repeatability result;
  compareAll(
      first.points, second.points,
      [](const PointPair& a, const PointPair& b) { return (*b.pixel - *a.pixel).eval(); },
      result.annotations);
  compareAll(
      first.lines, second.lines,
      [](const LinePair& a, const LinePair& b) { return acrossLine(*a.line, *b.line); },
      result.annotations);
  std::ranges::sort(result.annotations, {}, &AnnotationDifference::id);
  double squares = 0.0;
  for (const AnnotationDifference& annotation : result.annotations)
    squares += annotation.difference_px.squaredNorm();
  // Two values an annotation; a difference has twice the variance of either person's annotation.
  if (!result.annotations.empty())
    result.sigma_px =
        std::sqrt(squares / (2.0 * static_cast<double>(result.annotations.size())) / 2.0);
  return result;
}

}  // namespace boresight::sessions
