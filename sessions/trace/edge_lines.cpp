// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/edge_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "sessions/trace/match_details.h"

namespace boresight::sessions {
namespace {

constexpr int kReach = 2;             ///< px, of a pixel's neighbours
constexpr double kSame_px = 0.35;     ///< places nearer than this are one
constexpr double kFarthest_px = 2.3;  ///< between neighbours
constexpr double kLeastAlong_px = 0.15;
constexpr double kCorner_px = 1.8;         ///< between ends that meet
constexpr double kLeastCosine = 0.6;       ///< between the normals of neighbours
constexpr double kStraightCosine = 0.985;  ///< above it there is no corner
/// A line's corners are left out where the line then moves by less than this.
constexpr double kLineTolerance_px = 0.03;
constexpr int kNone = -1;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A place on a line; both neighbours along it.
struct Node {
  Eigen::Vector2d place_px;
  Eigen::Vector2d normal;
  int x = 0, y = 0;                          ///< its pixel
  std::array<int, 2> next = {kNone, kNone};  ///< along the tangent, and against it
  bool visited = false;

  int& ahead(int side) { return next[static_cast<std::size_t>(side)]; }
  Eigen::Vector2d tangent(int side) const {
    return side == 0 ? Eigen::Vector2d(-normal.y(), normal.x())
                     : Eigen::Vector2d(normal.y(), -normal.x());
  }
};

class Joiner {
 public:
  explicit Joiner(const RenderTrace& render)
      : width_(render.edges.width),
        height_(render.edges.height),
        node_at_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNone) {
    nodes_.reserve(render.pixels.size());
    for (const EdgePixel& pixel : render.pixels) addNode(pixel);
    findNeighbours();
    joinEnds();
  }

  std::vector<std::vector<Eigen::Vector2d>> lines() {
    std::vector<std::vector<Eigen::Vector2d>> result;
    for (const bool closed : {false, true})  // those with an end first
      for (int i = 0; i < count(); ++i)
        if (!node(i).visited && (closed || link(i, 0) == kNone || link(i, 1) == kNone))
          result.push_back(trace(i));
    return result;
  }

 private:
  Node& node(int index) { return nodes_[static_cast<std::size_t>(index)]; }
  int count() const { return static_cast<int>(nodes_.size()); }

  std::size_t cellOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  int nodeAt(int x, int y) const {
    return x < 0 || y < 0 || x >= width_ || y >= height_ ? kNone : node_at_[cellOf(x, y)];
  }

  /// Calls with each node around a place but the given one.
  template <class Visit>
  void forNeighbours(int index, Visit&& visit) {
    const int x = node(index).x;
    const int y = node(index).y;
    for (int v = y - kReach; v <= y + kReach; ++v)
      for (int u = x - kReach; u <= x + kReach; ++u)
        if (const int other = nodeAt(u, v); other != kNone && other != index) visit(other);
  }

  void addNode(const EdgePixel& pixel) {
    Eigen::Vector2d normal(pixel.normal_x, pixel.normal_y);
    const double length = normal.norm();
    normal = length > 0.0 ? Eigen::Vector2d(normal / length) : Eigen::Vector2d::UnitX();
    const Eigen::Vector2d place = Eigen::Vector2d(pixel.x, pixel.y) + 0.01 * pixel.offset * normal;
    // Pixels on both sides of a line have the same places.
    for (int v = pixel.y - kReach; v <= pixel.y; ++v)
      for (int u = pixel.x - kReach; u <= pixel.x + kReach; ++u) {
        const int other = nodeAt(u, v);
        if (other != kNone && (node(other).place_px - place).norm() < kSame_px &&
            std::abs(node(other).normal.dot(normal)) > kLeastCosine)
          return;
      }
    node_at_[cellOf(pixel.x, pixel.y)] = count();
    nodes_.push_back({place, normal, pixel.x, pixel.y});
  }

  /// The nearest place ahead that the line's direction leads to.
  int neighbourOf(int index, int side) {
    const Node& from = node(index);
    const Eigen::Vector2d tangent = from.tangent(side);
    int best = kNone;
    double best_cost = 1e9;
    forNeighbours(index, [&](int other) {
      const Node& to = node(other);
      const Eigen::Vector2d way = to.place_px - from.place_px;
      const double along = way.dot(tangent);
      const double across = std::abs(way.dot(from.normal));
      if (along < kLeastAlong_px || along > kFarthest_px || across > 0.15 + 0.35 * along) return;
      if (std::abs(from.normal.dot(to.normal)) < kLeastCosine) return;
      const double cost = along + 2.0 * across;
      if (cost >= best_cost) return;
      best_cost = cost;
      best = other;
    });
    return best;
  }

  void findNeighbours() {
    for (int i = 0; i < count(); ++i)
      for (int side = 0; side < 2; ++side) node(i).ahead(side) = neighbourOf(i, side);
  }

  /// The side of `to` that leads back to `from`, or kNone.
  int sideBack(int from, int to) {
    for (int side = 0; side < 2; ++side)
      if (node(to).ahead(side) == from) return side;
    return kNone;
  }

  /// The neighbour of that side if both are each other's.
  int link(int index, int side) {
    const int other = node(index).ahead(side);
    return other != kNone && sideBack(index, other) != kNone ? other : kNone;
  }

  /// Ends without a neighbour ahead that lie next to each other become neighbours: a corner.
  void joinEnds() {
    for (int i = 0; i < count(); ++i)
      for (int side = 0; side < 2; ++side)
        if (node(i).ahead(side) == kNone) joinEnd(i, side);
  }

  void joinEnd(int index, int side) {
    int best = kNone;
    int best_side = 0;
    double best_distance = kCorner_px;
    forNeighbours(index, [&](int other) {
      const Eigen::Vector2d way = node(other).place_px - node(index).place_px;
      const double distance = way.norm();
      if (distance >= best_distance || way.dot(node(index).tangent(side)) < -0.3) return;
      if (sideBack(index, other) != kNone) return;
      for (int back = 0; back < 2; ++back) {
        if (node(other).ahead(back) != kNone || way.dot(node(other).tangent(back)) > 0.3) continue;
        best = other;
        best_side = back;
        best_distance = distance;
      }
    });
    if (best == kNone) return;
    node(index).ahead(side) = best;
    node(best).ahead(best_side) = index;
  }

  /// Appends the place of `to`. Where the direction changes both lines end at the corner, also
  /// where a place lies beyond it.
  void append(std::vector<Eigen::Vector2d>& line, int from, int to) {
    const Node& a = node(from);
    const Node& b = node(to);
    if (std::abs(a.normal.dot(b.normal)) >= kStraightCosine) {
      line.push_back(b.place_px);
      return;
    }
    const Eigen::Vector2d way = b.place_px - a.place_px;
    const Eigen::Vector2d along_a = way.dot(a.tangent(0)) < 0.0 ? a.tangent(1) : a.tangent(0);
    const Eigen::Vector2d along_b = way.dot(b.tangent(0)) < 0.0 ? b.tangent(1) : b.tangent(0);
    const Eigen::Vector2d corner =
        a.place_px + cross(way, along_b) / cross(along_a, along_b) * along_a;
    const bool near =
        (corner - a.place_px).norm() < kCorner_px && (corner - b.place_px).norm() < kCorner_px;
    if (near && (corner - a.place_px).dot(along_a) < 0.0) line.pop_back();
    if (near) line.push_back(corner);
    if (!near || (b.place_px - corner).dot(along_b) > 0.0) line.push_back(b.place_px);
  }

  /// From a node on along one side until the line ends, or is back.
  void follow(int index, int side, std::vector<Eigen::Vector2d>& line) {
    for (int from = index, way = side;;) {
      const int to = node(from).ahead(way);
      if (to == kNone) return;
      append(line, from, to);
      const int back = sideBack(from, to);
      if (back == kNone || node(to).visited) return;  // it runs into another line, or is closed
      node(to).visited = true;
      way = 1 - back;
      from = to;
    }
  }

  std::vector<Eigen::Vector2d> trace(int index) {
    node(index).visited = true;
    const Eigen::Vector2d start = node(index).place_px;
    std::vector<Eigen::Vector2d> line = {start};
    follow(index, 0, line);
    const bool closed = line.size() > 2 && line.back() == start;
    std::vector<Eigen::Vector2d> backward = {start};
    if (!closed) follow(index, 1, backward);
    std::reverse(backward.begin(), backward.end());
    backward.insert(backward.end(), line.begin() + 1, line.end());
    if (backward.size() > 1) return backward;
    const Eigen::Vector2d half = 0.5 * node(index).tangent(0);  // a pixel on its own
    return {start - half, start + half};
  }

  int width_;
  int height_;
  std::vector<int> node_at_;
  std::vector<Node> nodes_;
};

double distanceToSegment(const Eigen::Vector2d& place, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double squared = way.squaredNorm();
  const double share =
      squared > 0.0 ? std::clamp((place - from).dot(way) / squared, 0.0, 1.0) : 0.0;
  return (place - from - share * way).norm();
}

/// Ramer-Douglas-Peucker, without recursion.
std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& line) {
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans = {{0, line.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    std::size_t farthest = first;
    double distance = kLineTolerance_px;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double away = distanceToSegment(line[i], line[first], line[last]);
      if (away <= distance) continue;
      distance = away;
      farthest = i;
    }
    if (farthest == first) continue;
    kept[farthest] = true;
    spans.emplace_back(first, farthest);
    spans.emplace_back(farthest, last);
  }
  std::vector<Eigen::Vector2d> result;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (kept[i]) result.push_back(line[i]);
  return result;
}

}  // namespace

EdgeLines edgeLines(const RenderTrace& render, int level) {
  if (render.pixels.empty()) return {};
  EdgeLines lines;
  for (const std::vector<Eigen::Vector2d>& places : Joiner(render).lines()) {
    EdgeLine& line = lines.emplace_back();
    for (const Eigen::Vector2d& place : simplified(places)) {
      line.places_px.push_back(atFullResolution({place.x(), place.y()}, level));
      line.box_px.extend(line.places_px.back());
    }
  }
  return lines;
}

double lengthWithin(const EdgeLines& lines, const Eigen::AlignedBox2d& box_px) {
  double length = 0.0;
  for (const EdgeLine& line : lines) {
    if (!box_px.intersects(line.box_px)) continue;
    for (std::size_t i = 1; i < line.places_px.size(); ++i) {
      Eigen::AlignedBox2d segment(line.places_px[i - 1]);
      segment.extend(line.places_px[i]);
      if (box_px.intersects(segment)) length += segment.intersection(box_px).diagonal().norm();
    }
  }
  return length;
}

}  // namespace boresight::sessions
