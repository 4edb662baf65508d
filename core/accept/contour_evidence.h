// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/nth.h"
#include "core/edges/directed_edges.h"

namespace boresight {

/// A sample point on a rendered edge, px of the image, at which the evidence is measured.
struct EvidencePlace {
  std::int16_t x = 0;          ///< px
  std::int16_t y = 0;          ///< px
  std::uint8_t direction = 0;  ///< of the edge's normal, edgeDirectionOf()
  bool outline = false;        ///< the other side is background
};

/// Evidence of an image's directed edges for a pose, relative to the background of edges around
/// each place: the mean over places of
///     log((0.6 p(d) + 0.4 b(d)) / b(d))
/// with d the directed distance (distanceToDirection) to the nearest edge, p(d) the histogram of d
/// at correct poses, and b(d) the histogram of d around the place, for the same direction. Clutter
/// and texture therefore do not support a pose.
///
/// The expectation of the same sum at a correct pose is sum over k of m_k log(m_k / b_k) with m =
/// 0.6 p + 0.4 b. The expectation is small in dense print, where every place has edges around it.
struct ContourEvidence {
  double place_length_px = 1.0;                   ///< rendered edge per place, px of the view
  std::int32_t places = 0;                        ///< rendered edge places measured
  std::int32_t outline_places = 0;                ///< of these, on the outline
  double edges_nats = 0.0;                        ///< mean over all places
  double outline_nats = 0.0;                      ///< mean over the outline
  double expected_nats = 0.0;                     ///< expectation of edges_nats at a correct pose
  double outline_expected_nats = 0.0;             ///< the same of outline_nats
  std::array<double, 4> quadrant_nats{};          ///< mean over the places of a quadrant
  std::array<std::int32_t, 4> quadrant_places{};  ///< about the middle of all places

  /// Minimum of strongest_nats() and of the quadrants that hold at least a tenth of the places.
  double weakest_nats() const;
  /// Evidence of the outline, or of all edges if larger: an outline against a dark background is
  /// invisible, and inner edges often differ from the mesh.
  double strongest_nats() const { return outline_nats > edges_nats ? outline_nats : edges_nats; }
  /// Sum over the length of all rendered edges, in pixels of the view: a pose that explains more
  /// edges has more.
  double total_nats() const { return edges_nats * places * place_length_px; }
  /// Evidence of all edges, or of the outline if larger, as a share of its expectation at a correct
  /// pose; 0 without places. Where all edges together contradict the pose by more than
  /// kContradicting, their share alone: an outline may lie along another object's.
  double shareOfExpected() const;
  static constexpr double kContradicting = 0.3;  ///< share of the expectation, negative
};

/// Length over which edge pixels of a small view share errors: their evidence counts once.
inline constexpr double kAlongEdge_px = 8.0;
/// Side of the window around a place in which b(d) is counted, as a share of the object's size.
inline constexpr double kEvidenceWindow = 0.2;
/// The evidence of one place, nats.
struct PlaceEvidence {
  double nats = 0.0;           ///< measured in the image
  double expected_nats = 0.0;  ///< its expectation at a correct pose
};
/// The evidence of one place, given the distances to edges of its direction.
PlaceEvidence evidenceOfPlace(const EvidencePlace& place, const DirectedEdges& edges,
                              std::span<const std::uint8_t> distance, double window_px);

/// Measures the evidence for a pose in small images.
class ContourEvidenceMeter {
 public:
  static constexpr int kMaxPlaces = 1500;  ///< places per measurement

  /// Takes memory for images of up to `pixels` from `arena`. For images of up to an eighth of that,
  /// the distances are cached for all measurements.
  void create(std::size_t pixels, Arena& arena);
  /// Sets the edges to measure against and clears the cached distances.
  void begin(const DirectedEdges& edges);
  /// Removes all places; each later place represents this length of rendered edge, px of the image.
  void clear(double place_length_px = 1.0) {
    count_ = 0;
    place_length_px_ = place_length_px;
  }
  /// Adds a place; those beyond kMaxPlaces are left out.
  void add(const EvidencePlace& place) {
    if (count_ < kMaxPlaces) nth(places_, count_++) = place;
  }
  /// `size_px`: the object's longer side in the image. Places outside the image and on unknown
  /// pixels do not count.
  ContourEvidence measure(double size_px);

 private:
  std::span<const std::uint8_t> distanceTo(int direction);

  const DirectedEdges* edges_ = nullptr;
  std::span<std::uint8_t> distance_;
  unsigned known_ = 0;  ///< bit i: the distances to edges of direction i are cached
  std::span<EvidencePlace> places_;
  int count_ = 0;
  double place_length_px_ = 1.0;
};

}  // namespace boresight
