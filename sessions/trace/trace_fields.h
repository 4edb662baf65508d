// SPDX-License-Identifier: Apache-2.0 The fields of every record in the order in which a trace file
// holds them; some blocks of onboard records have the same order. `Self` is a record, or a const
// record when writing; the archive is an ArchiveWriter or an ArchiveReader. Structured bindings
// decompose the core's records: a new member there does not compile until it is added here.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

template <class Self, class Record>
concept Is = std::same_as<std::remove_const_t<Self>, Record>;

template <class Archive, class... Number>
void numbers(Archive& archive, Number&... values) {
  (archive.number(values), ...);
}

template <class Archive, class Vector>
void vectorFields(Archive& archive, Vector& vector) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) archive.number(vector.data()[i]);
}

template <class Archive, Is<Pose> Self>
void fields(Archive& archive, Self& pose) {
  auto& rotation = pose.rotation;
  numbers(archive, rotation.w(), rotation.x(), rotation.y(), rotation.z());
  vectorFields(archive, pose.translation_m);
}

template <class Archive, Is<SeedUncertainty> Self>
void fields(Archive& archive, Self& uncertainty) {
  auto& [translation_m, rotation_rad, pivot_in_camera_m] = uncertainty;
  vectorFields(archive, translation_m);
  vectorFields(archive, rotation_rad);
  vectorFields(archive, pivot_in_camera_m);
}

template <class Archive, Is<CahvLens> Self>
void fields(Archive& archive, Self& lens) {
  auto& [skew_px, optical_axis, radial, entrance_m, linearity, pupil_low_m, pupil_high_m] = lens;
  archive.number(skew_px);
  vectorFields(archive, optical_axis);
  vectorFields(archive, radial);
  vectorFields(archive, entrance_m);
  numbers(archive, linearity, pupil_low_m, pupil_high_m);
}

template <class Archive, Is<Camera> Self>
void fields(Archive& archive, Self& camera) {
  auto& [model, width, height, fx, fy, cx, cy, distortion, cahv, valid_radius] = camera;
  archive.choice(model, kLastCameraModel);
  numbers(archive, width, height, fx, fy, cx, cy);
  for (auto& coefficient : distortion) archive.number(coefficient);
  if (isCahvFamily(model)) fields(archive, cahv);
  archive.number(valid_radius);
}

template <class Archive, Is<BitMap> Self>
void fields(Archive& archive, Self& map) {
  archive.number(map.width);
  archive.number(map.height);
  archive.list(map.words, [&](auto& word) { archive.number(word); });
  archive.require(
      map.width >= 0 && map.height >= 0 && map.width <= 32767 && map.height <= 32767 &&
          map.words.size() == static_cast<std::size_t>(BitImage::wordsPerRow(map.width)) *
                                  static_cast<std::size_t>(map.height),
      "a binary image whose size contradicts its words");
}

template <class Archive, Is<EdgePixel> Self>
void fields(Archive& archive, Self& pixel) {
  auto& [x, y, depth_m, face, normal_x, normal_y, offset, kind] = pixel;
  numbers(archive, x, y, depth_m, face, normal_x, normal_y, offset, kind);
}

template <class Archive, Is<RenderTrace> Self>
void fields(Archive& archive, Self& render) {
  fields(archive, render.edges);
  fields(archive, render.mask);
  archive.list(render.pixels, [&](auto& pixel) {
    fields(archive, pixel);
    archive.require(pixel.x >= 0 && pixel.y >= 0 && pixel.x < render.edges.width &&
                        pixel.y < render.edges.height,
                    "an edge pixel outside its image");
  });
  archive.list(render.row_begin, [&](auto& index) { archive.number(index); });
  archive.require(render.row_begin.empty() ||
                      render.row_begin.size() == static_cast<std::size_t>(render.edges.height) + 1,
                  "rows of edge pixels that do not fit their image");
  for (const auto index : render.row_begin)
    archive.require(index >= 0 && static_cast<std::size_t>(index) <= render.pixels.size(),
                    "a row of edge pixels that does not exist");
  fields(archive, render.camera);
  fields(archive, render.camera_from_station);
}

template <class Archive, Is<EdgeMapTrace> Self>
void fields(Archive& archive, Self& edges) {
  for (auto& level : edges.level) fields(archive, level);
  archive.number(edges.low_threshold);
  archive.number(edges.high_threshold);
  archive.number(edges.edge_count);
}

template <class Archive, Is<Template> Self>
void fields(Archive& archive, Self& item) {
  auto& [center_x, center_y, depth_m, distinctness, point_in_station_m] = item;
  numbers(archive, center_x, center_y, depth_m, distinctness);
  vectorFields(archive, point_in_station_m);
}

template <class Archive, Is<WhsPeak> Self>
void fields(Archive& archive, Self& peak) {
  auto& [x, y, counts, second_x, second_y, second_counts, has_second] = peak;
  numbers(archive, x, y, counts.edge_hits, counts.empty_hits, second_x, second_y,
          second_counts.edge_hits, second_counts.empty_hits, has_second);
}

template <class Archive, Is<Match> Self>
void fields(Archive& archive, Self& match) {
  auto& [window, norms, peak, x, y, searched, at_border] = match;
  numbers(archive, window.x_min, window.y_min, window.x_max, window.y_max, norms.edges,
          norms.empties);
  fields(archive, peak);
  numbers(archive, x, y, searched, at_border);
}

template <class Archive, Is<Correspondence> Self>
void fields(Archive& archive, Self& correspondence) {
  auto& [point_in_station_m, pixel, sigma_px] = correspondence;
  vectorFields(archive, point_in_station_m);
  vectorFields(archive, pixel);
  archive.number(sigma_px);
}

template <class Archive, Is<PnpTrace> Self>
void fields(Archive& archive, Self& pnp) {
  fields(archive, pnp.camera_from_station);
  archive.list(pnp.inlier, [&](auto& flag) { archive.number(flag); });
  archive.list(pnp.residual_px, [&](auto& residual) { archive.number(residual); });
  archive.number(pnp.inlier_count);
  archive.number(pnp.rms_px);
  vectorFields(archive, pnp.covariance);
  archive.number(pnp.samples);
}

template <class Archive, Is<EdgeSample> Self>
void fields(Archive& archive, Self& sample) {
  auto& [point_in_station_m, residual_px, gradient, weight, normal_x, normal_y, kind] = sample;
  vectorFields(archive, point_in_station_m);
  Eigen::Vector2d normal = sample.normal();
  vectorFields(archive, normal);
  archive.require(std::abs(normal.x()) <= 1.0 && std::abs(normal.y()) <= 1.0,
                  "a normal longer than 1");
  if constexpr (!std::is_const_v<Self>) {
    normal_x = static_cast<std::int8_t>(std::lround(127.0 * normal.x()));
    normal_y = static_cast<std::int8_t>(std::lround(127.0 * normal.y()));
  }
  numbers(archive, residual_px, gradient, weight, kind);
}

template <class Archive, Is<RefinementTrace> Self>
void fields(Archive& archive, Self& refinement) {
  fields(archive, refinement.camera_from_station);
  vectorFields(archive, refinement.covariance);
  archive.list(refinement.samples, [&](auto& sample) { fields(archive, sample); });
  archive.number(refinement.sample_count);
  archive.number(refinement.found_count);
  archive.number(refinement.used_count);
  archive.number(refinement.rms_px);
}

template <class Archive, Is<HypothesisSummary> Self>
void fields(Archive& archive, Self& hypothesis) {
  auto& [roll_rad, templates, matches, inliers, cost, camera_from_station, solved] = hypothesis;
  numbers(archive, roll_rad, templates, matches, inliers, cost);
  fields(archive, camera_from_station);
  archive.number(solved);
}

template <class Archive, Is<SearchCandidate> Self>
void fields(Archive& archive, Self& found) {
  auto& [camera_from_station, distance_px, tilt_x_rad, tilt_y_rad, roll_rad, depth_ratio,
         slide_x_px, slide_y_px] = found;
  fields(archive, camera_from_station);
  numbers(archive, distance_px, tilt_x_rad, tilt_y_rad, roll_rad, depth_ratio, slide_x_px,
          slide_y_px);
}

template <class Archive, Is<ContourEvidence> Self>
void fields(Archive& archive, Self& evidence) {
  auto& [place_length_px, places, outline_places, edges_nats, outline_nats, expected_nats,
         outline_expected_nats, quadrant_nats, quadrant_places] = evidence;
  numbers(archive, place_length_px, places, outline_places, edges_nats, outline_nats, expected_nats,
          outline_expected_nats);
  for (auto& nats : quadrant_nats) archive.number(nats);
  for (auto& count : quadrant_places) archive.number(count);
}

template <class Archive, Is<PoseEvidence> Self>
void fields(Archive& archive, Self& evidence) {
  auto& [contours, region, edge_support] = evidence;
  for (auto& view : contours) fields(archive, view);
  auto& [nats, lines, separated] = region;
  numbers(archive, nats, lines, separated, edge_support);
}

template <class Archive, Is<PoseHypothesis> Self>
void fields(Archive& archive, Self& hypothesis) {
  auto& [camera_from_station, origin, number, evidence, score, probability] = hypothesis;
  fields(archive, camera_from_station);
  archive.choice(origin, kLastHypothesisOrigin);
  archive.number(number);
  fields(archive, evidence);
  numbers(archive, score, probability);
}

template <class Archive, Is<EdgeWidth> Self>
void fields(Archive& archive, Self& width) {
  for (auto& width_px : width.width_px) archive.number(width_px);
  for (auto& places : width.places) archive.number(places);
}

template <class Archive, Is<FocalFit> Self>
void fields(Archive& archive, Self& focal) {
  auto& [change, sigma, determined] = focal;
  archive.number(change);
  archive.number(sigma);
  archive.number(determined);
}

template <class Archive, Is<PoseCandidate> Self>
void fields(Archive& archive, Self& candidate) {
  auto& [found, camera_from_station, evidence, error_px] = candidate;
  fields(archive, found);
  fields(archive, camera_from_station);
  fields(archive, evidence);
  archive.number(error_px);
}

template <class Archive, Is<StageSeconds> Self>
void fields(Archive& archive, Self& seconds) {
  auto& [initialization, rendering, matching, pose, refinement] = seconds;
  numbers(archive, initialization, rendering, matching, pose, refinement);
}

template <class Archive, Is<EdgeSupport> Self>
void fields(Archive& archive, Self& support) {
  auto& [rendered, covered, displaced, displaced_covered, seen, explained, displaced_explained] =
      support;
  numbers(archive, rendered, covered, displaced, displaced_covered, seen, explained,
          displaced_explained);
}

template <class Archive, Is<CompetingPose> Self>
void fields(Archive& archive, Self& pose) {
  auto& [camera_from_station, similarity, margin_nats, mirrored] = pose;
  fields(archive, camera_from_station);
  numbers(archive, similarity, margin_nats, mirrored);
}

template <class Archive, Is<IterationTrace> Self>
void matchingFields(Archive& archive, Self& iteration) {
  archive.list(iteration.templates, [&](auto& item) { fields(archive, item); });
  archive.number(iteration.template_count);
  archive.number(iteration.template_side_px);
  archive.list(iteration.matches, [&](auto& match) { fields(archive, match); });
  archive.number(iteration.searched_count);
  archive.number(iteration.best_score);
  archive.number(iteration.mean_score);
  archive.list(iteration.correspondences, [&](auto& item) { fields(archive, item); });
  archive.list(iteration.template_of, [&](auto& index) { archive.number(index); });
  archive.number(iteration.correspondence_count);
  fields(archive, iteration.pnp);
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
  archive.number(iteration.index);
  archive.number(iteration.attempt);
  archive.choice(iteration.kind, IterationKind::kRefine);
  archive.number(iteration.level);
  archive.choice(iteration.reached, Stage::kFinished);
  archive.choice(iteration.status, kLastLocalizationStatus);
  archive.number(iteration.threshold_px);
  fields(archive, iteration.camera_from_station_before);
  fields(archive, iteration.uncertainty);
  fields(archive, iteration.render);
  archive.number(iteration.edge_pixel_count);
  matchingFields(archive, iteration);
  fields(archive, iteration.refinement);
  archive.list(iteration.hypotheses, [&](auto& hypothesis) { fields(archive, hypothesis); });
  archive.number(iteration.chosen_hypothesis);
  fields(archive, iteration.camera_from_station);
  archive.number(iteration.correction_translation_m);
  archive.number(iteration.correction_rotation_rad);
  archive.number(iteration.correction_image_px);
  fields(archive, iteration.seconds);
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
  numbers(archive, kept, construction);
  for (auto& bytes : stage) archive.number(bytes);
  numbers(archive, memory.inputs, memory.limit);
}

/// A shared value, written.
template <class Archive, class T>
void sharedFields(Archive& archive, const std::shared_ptr<const T>& shared) {
  const T none;
  fields(archive, shared ? *shared : none);
}
/// A shared value, read.
template <class Archive, class T>
void sharedFields(Archive& archive, std::shared_ptr<const T>& shared) {
  T value;
  fields(archive, value);
  shared = std::make_shared<const T>(std::move(value));
}

template <class Archive, Is<LocalizationTrace> Self>
void fields(Archive& archive, Self& trace) {
  archive.text(trace.version);
  fields(archive, trace.options);
  fields(archive, trace.camera);
  fields(archive, trace.camera_from_station_seed);
  fields(archive, trace.uncertainty);
  sharedFields(archive, trace.edges);
  archive.list(trace.iterations, [&](auto& iteration) { sharedFields(archive, iteration); });
  archive.number(trace.attempts);
  archive.list(trace.candidates, [&](auto& candidate) { fields(archive, candidate); });
  archive.list(trace.hypotheses, [&](auto& hypothesis) { fields(archive, hypothesis); });
  numbers(archive, trace.best_hypothesis, trace.competitor, trace.gap);
  for (const std::int32_t index : {trace.best_hypothesis, trace.competitor})
    archive.require(index >= -1 && index < static_cast<std::int32_t>(trace.hypotheses.size()),
                    "a hypothesis that does not exist");
  archive.list(trace.competing_poses, [&](auto& pose) { fields(archive, pose); });
  fields(archive, trace.support);
  fields(archive, trace.evidence);
  archive.number(trace.probability);
  fields(archive, trace.edge_width);
  fields(archive, trace.focal);
  archive.choice(trace.status, kLastLocalizationStatus);
  archive.choice(trace.fault, kLastStatus);
  fields(archive, trace.camera_from_station);
  vectorFields(archive, trace.covariance);
  archive.text(trace.digest);
  fields(archive, trace.seconds);
  archive.number(trace.arena_bytes);
  fields(archive, trace.memory);
  archive.list(trace.changes, [&](auto& change) { fields(archive, change); });
}

}  // namespace boresight::sessions
