// SPDX-License-Identifier: Apache-2.0
#include "core/search/self_slides.h"

#include <algorithm>
#include <array>

#include "core/search/compass_search.h"

namespace boresight {
namespace {

/// Slides whose mean distance of the outline from the render's edges is larger are left out.
constexpr double kAlike_px = 2.0;

}  // namespace

void SelfSlides::begin(const EdgeRender& render, const DirectedEdges& edges) {
  render_ = &render;
  edges_ = &edges;
  direction_ = 0;
  slides_px_.clear();
  sums_.begin(edges.width, edges.height, kLongest_px, kLongest_px);
}

bool SelfSlides::step() {
  if (direction_ == kEdgeDirections) return true;
  sums_.takeMap(*edges_, direction_);
  if (++direction_ < kEdgeDirections) return false;
  findSlides();
  return true;
}

void SelfSlides::findSlides() {
  std::array<SlideSums::Place, SlideSums::kMaxPlaces> places;
  std::size_t count = 0;
  takeEvenly(*render_, [&](const EdgePixel& pixel) {
    places[count++] = {static_cast<std::int16_t>(pixel.x - edges_->width / 2),
                       static_cast<std::int16_t>(pixel.y - edges_->height / 2),
                       edgeDirectionOf(pixel.normal_x, pixel.normal_y)};
  });
  sums_.add(std::span(places).first(count));
  const double most = kAlike_px / SlideSums::kStep_px * static_cast<double>(count);
  Eigen::Vector2i best_px;
  while (slides_px_.size() < kMost && findBest(most, best_px)) slides_px_.add(best_px);
}

/// Whether the slide is apart from no slide at all and from those found.
bool SelfSlides::isApart(const Eigen::Vector2i& slide_px) const {
  constexpr int kShortest_px2 = kShortest_px * kShortest_px;
  const auto found = slides_px();
  return slide_px.squaredNorm() >= kShortest_px2 &&
         std::all_of(found.begin(), found.end(), [&](const Eigen::Vector2i& other_px) {
           return (slide_px - other_px).squaredNorm() >= kShortest_px2;
         });
}

/// The peak with the least sum that is apart; false where none is within `most`.
bool SelfSlides::findBest(double most, Eigen::Vector2i& best_px) const {
  const Eigen::Vector2i middle(sums_.columns() / 2, sums_.rows() / 2);
  double least = most;
  bool found = false;
  for (int row = 0; row < sums_.rows(); ++row) {
    for (int column = 0; column < sums_.columns(); ++column) {
      const double sum = sums_.sum(column, row);
      if (sum > least || (found && sum == least) || !sums_.isPeak(column, row)) continue;
      const Eigen::Vector2i slide_px = Eigen::Vector2i(column, row) - middle;
      if (!isApart(slide_px)) continue;
      best_px = slide_px;
      least = sum;
      found = true;
    }
  }
  return found;
}

}  // namespace boresight
