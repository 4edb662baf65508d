// SPDX-License-Identifier: Apache-2.0
// The fields of every record in the order in which a trace file holds them; some blocks of onboard
// records have the same order. `Self` is a record, or a const record when writing; the archive is
// an ArchiveWriter or an ArchiveReader. Structured bindings decompose the core's records: a new
// member there does not compile until it is added here.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

template <class Self, class Record>
concept Is = std::same_as<std::remove_const_t<Self>, Record>;

/// A number, a std::vector with its size, the elements of an Eigen matrix or std::array, or a
/// record that has `fields`.
template <class Archive, class Value>
void item(Archive& archive, Value& value) {
  if constexpr (std::is_arithmetic_v<Value>) {
    archive.number(value);
  } else if constexpr (requires { value.capacity(); }) {
    archive.list(value, [&archive](auto& element) { item(archive, element); });
  } else if constexpr (requires { value.data(); }) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(value.size()); ++i)
      item(archive, value.data()[i]);
  } else {
    fields(archive, value);
  }
}

/// Several values, one after the other.
template <class Archive, class... Value>
void items(Archive& archive, Value&... values) {
  (item(archive, values), ...);
}

template <class Archive, Is<Pose> Self>
void fields(Archive& archive, Self& pose) {
  auto& q = pose.rotation;
  items(archive, q.w(), q.x(), q.y(), q.z(), pose.translation_m);
}

template <class Archive, Is<SeedUncertainty> Self>
void fields(Archive& archive, Self& uncertainty) {
  auto& [translation_m, rotation_rad, pivot_in_camera_m] = uncertainty;
  items(archive, translation_m, rotation_rad, pivot_in_camera_m);
}

template <class Archive, Is<CahvLens> Self>
void fields(Archive& archive, Self& lens) {
  auto& [skew_px, optical_axis, radial, entrance_m, linearity, pupil_low_m, pupil_high_m] = lens;
  items(archive, skew_px, optical_axis, radial, entrance_m, linearity, pupil_low_m, pupil_high_m);
}

template <class Archive, Is<Camera> Self>
void fields(Archive& archive, Self& camera) {
  auto& [model, width, height, fx, fy, cx, cy, distortion, cahv, valid_radius] = camera;
  archive.choice(model, kLastCameraModel);
  items(archive, width, height, fx, fy, cx, cy, distortion);
  if (isCahvFamily(model)) fields(archive, cahv);
  archive.number(valid_radius);
}

template <class Archive, Is<BitMap> Self>
void fields(Archive& archive, Self& map) {
  items(archive, map.width, map.height, map.words);
  archive.require(
      map.width >= 0 && map.height >= 0 && map.width <= 32767 && map.height <= 32767 &&
          map.words.size() == static_cast<std::size_t>(BitImage::wordsPerRow(map.width)) *
                                  static_cast<std::size_t>(map.height),
      "a binary image whose size contradicts its words");
}

template <class Archive, Is<EdgePixel> Self>
void fields(Archive& archive, Self& pixel) {
  auto& [x, y, depth_m, face, normal_x, normal_y, offset, kind] = pixel;
  items(archive, x, y, depth_m, face, normal_x, normal_y, offset, kind);
}

template <class Archive, Is<RenderTrace> Self>
void fields(Archive& archive, Self& render) {
  items(archive, render.edges, render.mask);
  archive.list(render.pixels, [&](auto& pixel) {
    fields(archive, pixel);
    archive.require(pixel.x >= 0 && pixel.y >= 0 && pixel.x < render.edges.width &&
                        pixel.y < render.edges.height,
                    "an edge pixel outside its image");
  });
  item(archive, render.row_begin);
  archive.require(render.row_begin.empty() ||
                      render.row_begin.size() == static_cast<std::size_t>(render.edges.height) + 1,
                  "rows of edge pixels that do not fit their image");
  for (const auto index : render.row_begin)
    archive.require(index >= 0 && static_cast<std::size_t>(index) <= render.pixels.size(),
                    "a row of edge pixels that does not exist");
  items(archive, render.camera, render.camera_from_station);
}

template <class Archive, Is<EdgeMapTrace> Self>
void fields(Archive& archive, Self& edges) {
  items(archive, edges.level, edges.low_threshold, edges.high_threshold, edges.edge_count);
}

template <class Archive, Is<Template> Self>
void fields(Archive& archive, Self& self) {
  auto& [center_x, center_y, depth_m, distinctness, point_in_station_m] = self;
  items(archive, center_x, center_y, depth_m, distinctness, point_in_station_m);
}

template <class Archive, Is<WhsPeak> Self>
void fields(Archive& archive, Self& peak) {
  auto& [x, y, counts, second_x, second_y, second_counts, has_second] = peak;
  items(archive, x, y, counts.edge_hits, counts.empty_hits, second_x, second_y,
        second_counts.edge_hits, second_counts.empty_hits, has_second);
}

template <class Archive, Is<Match> Self>
void fields(Archive& archive, Self& match) {
  auto& [window, norms, peak, x, y, searched, at_border] = match;
  items(archive, window.x_min, window.y_min, window.x_max, window.y_max, norms.edges, norms.empties,
        peak, x, y, searched, at_border);
}

template <class Archive, Is<Correspondence> Self>
void fields(Archive& archive, Self& correspondence) {
  auto& [point_in_station_m, pixel, sigma_px] = correspondence;
  items(archive, point_in_station_m, pixel, sigma_px);
}

template <class Archive, Is<PnpTrace> Self>
void fields(Archive& archive, Self& pnp) {
  items(archive, pnp.camera_from_station, pnp.inlier, pnp.residual_px, pnp.inlier_count, pnp.rms_px,
        pnp.covariance, pnp.samples);
}

template <class Archive, Is<EdgeSample> Self>
void fields(Archive& archive, Self& sample) {
  auto& [point_in_station_m, residual_px, gradient, weight, normal_x, normal_y, kind] = sample;
  Eigen::Vector2d normal = sample.normal();
  items(archive, point_in_station_m, normal);
  archive.require(std::abs(normal.x()) <= 1.0 && std::abs(normal.y()) <= 1.0,
                  "a normal longer than 1");
  if constexpr (!std::is_const_v<Self>) {
    normal_x = static_cast<std::int8_t>(std::lround(127.0 * normal.x()));
    normal_y = static_cast<std::int8_t>(std::lround(127.0 * normal.y()));
  }
  items(archive, residual_px, gradient, weight, kind);
}

template <class Archive, Is<RefinementTrace> Self>
void fields(Archive& archive, Self& refinement) {
  items(archive, refinement.camera_from_station, refinement.covariance, refinement.samples,
        refinement.sample_count, refinement.found_count, refinement.used_count, refinement.rms_px);
}

template <class Archive, Is<HypothesisSummary> Self>
void fields(Archive& archive, Self& hypothesis) {
  auto& [roll_rad, templates, matches, inliers, cost, camera_from_station, solved] = hypothesis;
  items(archive, roll_rad, templates, matches, inliers, cost, camera_from_station, solved);
}

template <class Archive, Is<SearchCandidate> Self>
void fields(Archive& archive, Self& found) {
  auto& [camera_from_station, distance_px, tilt_x_rad, tilt_y_rad, roll_rad, depth_ratio,
         slide_x_px, slide_y_px] = found;
  items(archive, camera_from_station, distance_px, tilt_x_rad, tilt_y_rad, roll_rad, depth_ratio,
        slide_x_px, slide_y_px);
}

template <class Archive, Is<ContourEvidence> Self>
void fields(Archive& archive, Self& evidence) {
  auto& [place_length_px, places, outline_places, edges_nats, outline_nats, expected_nats,
         outline_expected_nats, quadrant_nats, quadrant_places] = evidence;
  items(archive, place_length_px, places, outline_places, edges_nats, outline_nats, expected_nats,
        outline_expected_nats, quadrant_nats, quadrant_places);
}

template <class Archive, Is<PoseEvidence> Self>
void fields(Archive& archive, Self& evidence) {
  auto& [contours, region, edge_support] = evidence;
  auto& [nats, lines, separated] = region;
  items(archive, contours, nats, lines, separated, edge_support);
}

template <class Archive, Is<PoseHypothesis> Self>
void fields(Archive& archive, Self& hypothesis) {
  auto& [camera_from_station, origin, number, evidence, score, probability] = hypothesis;
  item(archive, camera_from_station);
  archive.choice(origin, kLastHypothesisOrigin);
  items(archive, number, evidence, score, probability);
}

template <class Archive, Is<EdgeWidth> Self>
void fields(Archive& archive, Self& width) {
  items(archive, width.width_px, width.places);
}

template <class Archive, Is<FocalFit> Self>
void fields(Archive& archive, Self& focal) {
  auto& [change, sigma, determined] = focal;
  items(archive, change, sigma, determined);
}

template <class Archive, Is<PoseCandidate> Self>
void fields(Archive& archive, Self& candidate) {
  auto& [found, camera_from_station, evidence, error_px] = candidate;
  items(archive, found, camera_from_station, evidence, error_px);
}

template <class Archive, Is<StageSeconds> Self>
void fields(Archive& archive, Self& seconds) {
  auto& [initialization, rendering, matching, pose, refinement] = seconds;
  items(archive, initialization, rendering, matching, pose, refinement);
}

template <class Archive, Is<EdgeSupport> Self>
void fields(Archive& archive, Self& support) {
  auto& [rendered, covered, displaced, displaced_covered, seen, explained, displaced_explained] =
      support;
  items(archive, rendered, covered, displaced, displaced_covered, seen, explained,
        displaced_explained);
}

template <class Archive, Is<CompetingPose> Self>
void fields(Archive& archive, Self& pose) {
  auto& [camera_from_station, similarity, margin_nats, mirrored] = pose;
  items(archive, camera_from_station, similarity, margin_nats, mirrored);
}

template <class Archive, Is<IterationTrace> Self>
void matchingFields(Archive& archive, Self& iteration) {
  items(archive, iteration.templates, iteration.template_count, iteration.template_side_px,
        iteration.matches, iteration.searched_count, iteration.best_score, iteration.mean_score,
        iteration.correspondences, iteration.template_of, iteration.correspondence_count,
        iteration.pnp);
  const std::size_t points = iteration.correspondences.size();
  archive.require(iteration.matches.size() <= iteration.templates.size() &&
                      iteration.template_of.size() == points &&
                      (iteration.pnp.inlier.empty() || iteration.pnp.inlier.size() == points) &&
                      iteration.pnp.residual_px.size() == iteration.pnp.inlier.size(),
                  "lists of templates, matches and inliers that do not fit together");
  for (const auto index : iteration.template_of)
    archive.require(index >= 0 && static_cast<std::size_t>(index) < iteration.templates.size(),
                    "a match of a template that does not exist");
}

template <class Archive, Is<IterationTrace> Self>
void fields(Archive& archive, Self& iteration) {
  items(archive, iteration.index, iteration.attempt);
  archive.choice(iteration.kind, IterationKind::kRefine);
  archive.number(iteration.level);
  archive.choice(iteration.reached, Stage::kFinished);
  archive.choice(iteration.status, kLastLocalizationStatus);
  items(archive, iteration.threshold_px, iteration.camera_from_station_before,
        iteration.uncertainty, iteration.render, iteration.edge_pixel_count);
  matchingFields(archive, iteration);
  items(archive, iteration.refinement, iteration.hypotheses, iteration.chosen_hypothesis,
        iteration.camera_from_station, iteration.correction_translation_m,
        iteration.correction_rotation_rad, iteration.correction_image_px, iteration.seconds);
}

template <class Archive, Is<LocalizerOptions> Self>
void fields(Archive& archive, Self& options) {
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    std::string name = info.name;
    archive.text(name);
    archive.require(name == info.name, "an option that this version does not know");
    double value = static_cast<double>(field);
    archive.number(value);
    archive.require(value >= info.minimum && value <= info.maximum, "an option outside its range");
    using Field = std::remove_reference_t<decltype(field)>;
    if constexpr (!std::is_const_v<Field>) field = static_cast<Field>(value);
  });
}

template <class Archive, Is<OptionChange> Self>
void fields(Archive& archive, Self& change) {
  archive.number(change.iteration);
  archive.require(change.iteration > 0, "option changes before the run");
  fields(archive, change.options);
}

template <class Archive, Is<MemoryTrace> Self>
void fields(Archive& archive, Self& memory) {
  auto& [kept, construction, stage] = memory.use;
  items(archive, kept, construction, stage, memory.inputs, memory.limit);
}

/// A shared value, written.
template <class Archive, class T>
void fields(Archive& archive, const std::shared_ptr<const T>& shared) {
  const T none;
  fields(archive, shared ? *shared : none);
}
/// A shared value, read.
template <class Archive, class T>
void fields(Archive& archive, std::shared_ptr<const T>& shared) {
  T value;
  fields(archive, value);
  shared = std::make_shared<const T>(std::move(value));
}

template <class Archive, Is<LocalizationTrace> Self>
void fields(Archive& archive, Self& trace) {
  archive.text(trace.version);
  items(archive, trace.options, trace.camera, trace.camera_from_station_seed, trace.uncertainty,
        trace.edges, trace.iterations, trace.attempts, trace.candidates, trace.hypotheses,
        trace.best_hypothesis, trace.competitor, trace.gap);
  for (const std::int32_t index : {trace.best_hypothesis, trace.competitor})
    archive.require(index >= -1 && index < static_cast<std::int32_t>(trace.hypotheses.size()),
                    "a hypothesis that does not exist");
  items(archive, trace.competing_poses, trace.support, trace.evidence, trace.probability,
        trace.edge_width, trace.focal);
  archive.choice(trace.status, kLastLocalizationStatus);
  archive.choice(trace.fault, kLastStatus);
  items(archive, trace.camera_from_station, trace.covariance);
  archive.text(trace.digest);
  items(archive, trace.seconds, trace.arena_bytes, trace.memory, trace.changes);
}

}  // namespace boresight::sessions
