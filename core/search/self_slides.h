// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/fixed_list.h"
#include "core/edges/directed_edges.h"
#include "core/render/edge_render.h"
#include "core/search/slide_sums.h"

namespace boresight {

/// Finds slides of an outline at which it lies near the edges of its own render again: repeated
/// features, long handles.
class SelfSlides {
 public:
  static constexpr int kMost = 4;         ///< slides that are kept
  static constexpr int kLongest_px = 36;  ///< to either side
  /// Shorter slides are left out: a refinement undoes them.
  static constexpr int kShortest_px = 4;

  /// Takes the memory from `arena`.
  void create(Arena& arena) { sums_.create(arena); }
  /// `edges` are those of the render, by direction; both must outlive the steps. Sides of at most
  /// SlideSums::kMaxView_px.
  void begin(const EdgeRender& render, const DirectedEdges& edges);
  /// One bounded slice; true when slides_px() is complete.
  [[nodiscard]] bool step();
  /// The most similar first; px of the render.
  std::span<const Eigen::Vector2i> slides_px() const { return slides_px_.items(); }

 private:
  void findSlides();
  bool isApart(const Eigen::Vector2i& slide_px) const;
  bool findBest(double most, Eigen::Vector2i& best_px) const;

  const EdgeRender* render_ = nullptr;
  const DirectedEdges* edges_ = nullptr;
  SlideSums sums_;
  int direction_ = 0;  ///< whose map is next
  FixedList<Eigen::Vector2i, kMost> slides_px_;
};

}  // namespace boresight
