// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/close_ups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace boresight::sessions {
namespace {

struct Place {
  Eigen::Vector2d pixel;
  Eigen::Vector2d normal;
  double distance_px = 0.0;
  bool found = false;  ///< the image has an edge there
};

std::vector<Place> placesOf(const Camera& camera, const RefinementTrace& refinement) {
  std::vector<Place> places;
  for (const EdgeSample& sample : refinement.samples) {
    Eigen::Vector2d pixel;
    if (project(camera, refinement.camera_from_station * sample.point_in_station_m, pixel))
      places.push_back(
          {pixel, sample.normal(), std::abs(sample.residual_px), sample.gradient != 0.0});
  }
  return places;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The smaller eigenvalue of the scatter of the found normals; negative where none was found.
double cornerness(const std::vector<const Place*>& places) {
  if (std::ranges::none_of(places, &Place::found)) return -1.0;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Place* place : places)
    if (place->found) scatter += place->normal * place->normal.transpose();
  const double half_difference = std::hypot(0.5 * (scatter(0, 0) - scatter(1, 1)), scatter(0, 1));
  return 0.5 * scatter.trace() - half_difference;
}

/// Places in the square cells of a grid, by column and row.
using Cells = std::map<std::pair<int, int>, std::vector<const Place*>>;

Cells cellsOf(const std::vector<const Place*>& places, double side_px) {
  Cells cells;
  for (const Place* place : places)
    cells[{static_cast<int>(std::floor(place->pixel.x() / side_px)),
           static_cast<int>(std::floor(place->pixel.y() / side_px))}]
        .push_back(place);
  return cells;
}

/// At least one place was found.
CloseUp bestOf(const std::vector<const Place*>& places, double side_px) {
  const Cells cells = cellsOf(places, side_px);
  const auto best =
      std::ranges::max_element(cells, {}, [](const auto& cell) { return cornerness(cell.second); });
  CloseUp close_up;
  std::vector<double> distances_px;
  for (const Place* place : best->second) {
    if (!place->found) continue;
    close_up.center_px += place->pixel;
    distances_px.push_back(place->distance_px);
  }
  const auto found = static_cast<double>(distances_px.size());
  close_up.center_px /= found;
  close_up.found_share = found / static_cast<double>(best->second.size());
  close_up.distance_px = medianOf(std::move(distances_px));
  return close_up;
}

}  // namespace

std::vector<CloseUp> closeUps(const Camera& camera, const RefinementTrace& refinement,
                              double side_px) {
  const std::vector<Place> places = placesOf(camera, refinement);
  std::vector<double> x;
  std::vector<double> y;
  for (const Place& place : places) {
    if (!place.found) continue;
    x.push_back(place.pixel.x());
    y.push_back(place.pixel.y());
  }
  if (x.empty()) return {};
  const Eigen::Vector2d middle(medianOf(std::move(x)), medianOf(std::move(y)));
  std::array<std::vector<const Place*>, 4> quarters;
  for (const Place& place : places)
    quarters[(place.pixel.y() < middle.y() ? 0U : 2U) + (place.pixel.x() < middle.x() ? 0U : 1U)]
        .push_back(&place);
  constexpr std::array kNames = {"upper left", "upper right", "lower left", "lower right"};
  std::vector<CloseUp> close_ups;
  for (std::size_t i = 0; i < quarters.size(); ++i) {
    if (std::ranges::none_of(quarters[i], &Place::found)) continue;
    close_ups.push_back(bestOf(quarters[i], side_px));
    close_ups.back().name = kNames[i];
  }
  return close_ups;
}

}  // namespace boresight::sessions
