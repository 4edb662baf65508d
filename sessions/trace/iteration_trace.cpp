// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/iteration_trace.h"

#include <algorithm>
#include <memory>

namespace boresight::sessions {
namespace {

/// The rows in use: the core's images may own room for a larger level.
BitMap recordBits(const BitImage& image) {
  BitMap map;
  map.width = image.width;
  map.height = image.height;
  const int used = BitImage::wordsPerRow(image.width);
  map.words.reserve(static_cast<std::size_t>(used) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y)
    map.words.insert(map.words.end(), image.row(y), image.row(y) + used);
  return map;
}

/// The first `count` elements, or as many as there are.
template <class T>
std::vector<T> firstOf(std::span<T> elements, std::int32_t count) {
  const auto wanted = static_cast<std::size_t>(std::max(0, count));
  const auto kept = elements.first(std::min(wanted, elements.size()));
  return {kept.begin(), kept.end()};
}

void recordScores(const MatchSet& matches, IterationTrace& trace) {
  double sum = 0.0;
  for (std::int32_t i = 0; i < matches.count; ++i) {
    const Match& match = matches.matches[static_cast<std::size_t>(i)];
    if (!match.searched) continue;
    const double score = whsScore(match.peak.counts, match.norms);
    trace.best_score = std::max(trace.best_score, score);
    sum += score;
  }
  trace.mean_score = matches.searched > 0 ? sum / matches.searched : 0.0;
}

/// The lists stay empty unless `full`.
void recordMatching(const Iteration& iteration, Stage reached, bool full, IterationTrace& trace) {
  if (reached < Stage::kTemplates) return;
  trace.template_count = iteration.templates.count;
  trace.template_side_px = iteration.templates.side_px;
  trace.templates = firstOf(iteration.templates.templates, full ? iteration.templates.count : 0);
  if (reached < Stage::kMatch) return;
  const std::int32_t kept = full ? iteration.correspondence_count : 0;
  trace.searched_count = iteration.matches.searched;
  trace.correspondence_count = iteration.correspondence_count;
  recordScores(iteration.matches, trace);
  trace.matches = firstOf(iteration.matches.matches, full ? iteration.matches.count : 0);
  trace.correspondences = firstOf(iteration.correspondences, kept);
  trace.template_of = firstOf(iteration.template_of, kept);
  if (reached < Stage::kPose) return;
  const PnpSolution& pnp = iteration.pnp;
  trace.pnp = {.camera_from_station = pnp.camera_from_station,
               .inlier = firstOf(pnp.inlier, kept),
               .residual_px = firstOf(pnp.residual_px, kept),
               .inlier_count = pnp.inlier_count,
               .rms_px = pnp.rms_px,
               .covariance = pnp.covariance,
               .samples = pnp.samples};
}

RefinementTrace recordRefinement(const RefinementResult& refinement, bool full) {
  return {.camera_from_station = refinement.camera_from_station,
          .covariance = refinement.covariance,
          .samples = firstOf(refinement.samples, full ? refinement.sample_count : 0),
          .sample_count = refinement.sample_count,
          .found_count = refinement.found_count,
          .used_count = refinement.used_count,
          .rms_px = refinement.rms_px};
}

}  // namespace

RenderTrace recordRender(const EdgeRender& render) {
  RenderTrace trace;
  trace.edges = recordBits(render.edges);
  trace.mask = recordBits(render.mask);
  trace.pixels.reserve(static_cast<std::size_t>(render.pixel_count));
  for (const EdgePixel& pixel : render.eachPixel()) trace.pixels.push_back(pixel);
  trace.row_begin = firstOf(render.row_begin, render.edges.height + 1);
  trace.camera = render.camera;
  trace.camera_from_station = render.camera_from_station;
  return trace;
}

EdgeMapTrace recordEdgeMap(const EdgeMap& edges, RecordLevel level) {
  EdgeMapTrace trace{.level = {},
                     .low_threshold = edges.low_threshold,
                     .high_threshold = edges.high_threshold,
                     .edge_count = edges.edge_count};
  if (level != RecordLevel::kSummary)
    std::ranges::transform(edges.level, trace.level.begin(), &recordBits);
  return trace;
}

Status detectEdges(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                   EdgeMapTrace& output) {
  EdgeMap edges;
  EdgeDetector detector;
  Arena counter;
  Status status = detector.begin(image, ignore, options, counter, edges);
  if (status != Status::kOk) return status;
  const std::size_t bytes = counter.highWater();
  const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
  Arena arena({memory.get(), bytes});
  status = detector.begin(image, ignore, options, arena, edges);
  if (status != Status::kOk) return status;
  while (!detector.step()) {
  }
  output = recordEdgeMap(edges);
  return Status::kOk;
}

bool hasPose(const Iteration& iteration, Stage reached) {
  return (reached == Stage::kPose || reached == Stage::kRefine) &&
         iteration.status != LocalizationStatus::kPnpFailed &&
         iteration.status != LocalizationStatus::kFault;
}

IterationTrace recordIteration(const Iteration& iteration, Stage reached, RecordLevel level) {
  IterationTrace trace;
  trace.index = iteration.index;
  trace.attempt = iteration.attempt;
  trace.kind = iteration.kind;
  trace.level = iteration.level;
  trace.reached = reached;
  trace.status = iteration.status;
  trace.threshold_px = iteration.threshold_px;
  trace.camera_from_station_before = iteration.camera_from_station_before;
  trace.uncertainty = iteration.uncertainty;
  trace.edge_pixel_count = iteration.render.pixel_count;
  const bool full = level != RecordLevel::kSummary;
  if (full) trace.render = recordRender(iteration.render);
  if (iteration.kind == IterationKind::kMatch) {
    recordMatching(iteration, reached, full, trace);
    trace.hypotheses.assign(iteration.hypotheses.begin(),
                            iteration.hypotheses.begin() + iteration.hypothesis_count);
    trace.chosen_hypothesis = iteration.chosen_hypothesis;
  } else if (reached >= Stage::kRefine) {
    trace.refinement = recordRefinement(iteration.refinement, full);
  }
  const bool solved = hasPose(iteration, reached);
  trace.camera_from_station =
      solved ? iteration.camera_from_station : iteration.camera_from_station_before;
  if (solved) {
    trace.correction_translation_m = iteration.correction_translation_m;
    trace.correction_rotation_rad = iteration.correction_rotation_rad;
    trace.correction_image_px = iteration.correction_image_px;
  }
  return trace;
}

void recordHypotheses(const Workspace& workspace, LocalizationTrace& trace) {
  trace.hypotheses.assign(workspace.hypotheses.begin(), workspace.hypotheses.end());
  trace.best_hypothesis = workspace.best_hypothesis;
  trace.competitor = workspace.competitor;
  trace.gap = workspace.gap;
}

}  // namespace boresight::sessions
