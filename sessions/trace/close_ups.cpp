// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/close_ups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace boresight::sessions {
namespace {

struct FoundPlace {
  Eigen::Vector2d pixel;
  Eigen::Vector2d normal;
  double distance_px = 0.0;
};

std::vector<FoundPlace> foundPlaces(const Camera& camera, const RefinementTrace& refinement) {
  std::vector<FoundPlace> places;
  for (const EdgeSample& sample : refinement.samples) {
    if (sample.gradient == 0.0) continue;
    Eigen::Vector2d pixel;
    if (project(camera, refinement.camera_from_station * sample.point_in_station_m, pixel))
      places.push_back({pixel, sample.normal(), std::abs(sample.residual_px)});
  }
  return places;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The smaller eigenvalue of the normals' scatter.
double cornerness(const std::vector<const FoundPlace*>& places) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const FoundPlace* place : places) scatter += place->normal * place->normal.transpose();
  const double half_difference = std::hypot(0.5 * (scatter(0, 0) - scatter(1, 1)), scatter(0, 1));
  return 0.5 * scatter.trace() - half_difference;
}

/// Places in the square cells of a grid, by column and row.
using Cells = std::map<std::pair<int, int>, std::vector<const FoundPlace*>>;

Cells cellsOf(const std::vector<const FoundPlace*>& places, double side_px) {
  Cells cells;
  for (const FoundPlace* place : places)
    cells[{static_cast<int>(std::floor(place->pixel.x() / side_px)),
           static_cast<int>(std::floor(place->pixel.y() / side_px))}]
        .push_back(place);
  return cells;
}

CloseUp bestOf(const std::vector<const FoundPlace*>& places, double side_px) {
  const Cells cells = cellsOf(places, side_px);
  const auto best = std::max_element(cells.begin(), cells.end(), [](const auto& a, const auto& b) {
    return cornerness(a.second) < cornerness(b.second);
  });
  CloseUp close_up;
  std::vector<double> distances_px;
  for (const FoundPlace* place : best->second) {
    close_up.center_px += place->pixel / static_cast<double>(best->second.size());
    distances_px.push_back(place->distance_px);
  }
  close_up.distance_px = medianOf(std::move(distances_px));
  return close_up;
}

}  // namespace

std::vector<CloseUp> closeUps(const Camera& camera, const RefinementTrace& refinement,
                              double side_px) {
  const std::vector<FoundPlace> places = foundPlaces(camera, refinement);
  if (places.empty()) return {};
  std::vector<double> x;
  std::vector<double> y;
  for (const FoundPlace& place : places) {
    x.push_back(place.pixel.x());
    y.push_back(place.pixel.y());
  }
  const Eigen::Vector2d middle(medianOf(std::move(x)), medianOf(std::move(y)));
  std::array<std::vector<const FoundPlace*>, 4> quarters;
  for (const FoundPlace& place : places)
    quarters[(place.pixel.y() < middle.y() ? 0U : 2U) + (place.pixel.x() < middle.x() ? 0U : 1U)]
        .push_back(&place);
  constexpr std::array kNames = {"upper left", "upper right", "lower left", "lower right"};
  std::vector<CloseUp> close_ups;
  for (std::size_t i = 0; i < quarters.size(); ++i) {
    if (quarters[i].empty()) continue;
    close_ups.push_back(bestOf(quarters[i], side_px));
    close_ups.back().name = kNames[i];
  }
  return close_ups;
}

}  // namespace boresight::sessions
