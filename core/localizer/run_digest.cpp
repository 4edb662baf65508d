// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/run_digest.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string_view>

#include "core/base/crc32.h"
#include "core/base/nth.h"
#include "core/localizer/value_writers.h"

namespace boresight {
namespace {

/// Most words of edges and masks equal the word before them: writes which words differ, 64 at a
/// time, and those words. The image can be reconstructed from them.
template <class Writer>
void digestBits(const BitImage& image, Writer& writer) {
  writer.i32(image.width);
  writer.i32(image.height);
  std::uint64_t before = 0;
  for (std::size_t first = 0; first < image.words.size(); first += 64) {
    const auto words =
        image.words.subspan(first, std::min<std::size_t>(64, image.words.size() - first));
    std::uint64_t differing = 0;
    std::uint64_t last = before;
    for (std::size_t i = 0; i < words.size(); ++i) {
      differing |= static_cast<std::uint64_t>(words[i] != last) << i;
      last = words[i];
    }
    writer.u64(differing);
    for (; differing != 0; differing &= differing - 1)
      writer.u64(nth(words, std::countr_zero(differing)));
    before = last;
  }
}

void digestMatrix(const Matrix6d& matrix, DigestWriter& writer) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) writer.f64(matrix(row, column));
  }
}

std::uint32_t checksumOfRows(const std::uint8_t* first, std::ptrdiff_t stride, int height,
                             std::size_t bytes) {
  std::uint32_t sum = 0;
  for (int y = 0; y < height; ++y) sum = crc32({first + stride * y, bytes}, sum);
  return sum;
}

std::uint32_t checksumOf(const BitImage& image) {
  ChecksumWriter sum;
  digestBits(image, sum);
  return sum.checksum();
}

std::uint32_t checksumOf(const MeshView& mesh) {
  ChecksumWriter sum;
  writeVertices(mesh, sum);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face].vertex) sum.i32(vertex);
    sum.i32(mesh.part_of_face[face]);
  }
  return sum.checksum();
}

void digestContours(const ContourEvidence& evidence, DigestWriter& writer) {
  writer.tag("contours");
  writeIntegers({evidence.places, evidence.outline_places}, writer);
  writeReals({evidence.place_length_px, evidence.edges_nats, evidence.outline_nats,
              evidence.expected_nats, evidence.outline_expected_nats},
             writer);
  writeReals(evidence.quadrant_nats, writer);
}

}  // namespace

void digestOptions(const LocalizerOptions& options, DigestWriter& writer) {
  writer.tag("options");
  LocalizerOptions::visitFields(options, [&writer](const OptionInfo& info, const auto& field) {
    // The problem's digest shows whether colour is used: a gray image has the same run.
    if (std::string_view(info.name) == "search.color") return;
    writer.tag(info.name);
    writer.f64(static_cast<double>(field));
  });
}

void digestPose(const Pose& pose, DigestWriter& writer) { writePose(pose, writer); }

void digestProblem(const LocalizationProblem& problem, DigestWriter& writer) {
  writer.tag("problem");
  const ImageView& image = problem.image;
  writeIntegers({image.width, image.height}, writer);
  writer.u32(checksumOfRows(image.data, image.stride, image.height,
                            static_cast<std::size_t>(image.width)));
  const ColorView& color = problem.color;
  if (color.data != nullptr) {
    writer.tag("color");
    writer.u32(checksumOfRows(color.data, color.stride, color.height,
                              static_cast<std::size_t>(color.width) * ColorView::kChannels));
  }
  writer.u8(problem.ignore != nullptr ? 1 : 0);
  if (problem.ignore != nullptr) writer.u32(checksumOf(*problem.ignore));
  const Camera& camera = problem.camera;
  writer.i32(static_cast<std::int32_t>(camera.model));
  writeOptics(camera, writer);
  const MeshView& mesh = problem.mesh;
  writer.u32(static_cast<std::uint32_t>(mesh.vertices_in_station_m.size()));
  writer.u32(static_cast<std::uint32_t>(mesh.faces.size()));
  writer.u32(checksumOf(mesh));
  writeParts(mesh, writer);
  digestPose(problem.camera_from_station_seed, writer);
  writeUncertainty(problem.uncertainty, writer);
  if (!problem.end_effector_in_camera_m.isZero(0.0))
    writeReals(problem.end_effector_in_camera_m, writer);
}

std::array<std::uint8_t, 32> inputDigest(const LocalizerOptions& options,
                                         const LocalizationProblem& problem) {
  DigestWriter writer;
  digestOptions(options, writer);
  digestProblem(problem, writer);
  return writer.digest();
}

void digestEdgeMap(const EdgeMap& edges, DigestWriter& writer) {
  writer.tag("edges");
  writeReals({edges.low_threshold, edges.high_threshold}, writer);
  writer.u32(checksumOf(edges.level[0]));  // the other levels follow from this one
}

void digestRender(const EdgeRender& render, DigestWriter& writer) {
  writer.tag("render");
  digestPose(render.camera_from_station, writer);
  writer.u32(checksumOf(render.edges));
  writer.u32(checksumOf(render.mask));
  writer.i32(render.pixel_count);
  ChecksumWriter pixels;
  for (const EdgePixel& pixel : render.eachPixel()) writeEdgePixel(pixel, pixels);
  writer.u32(pixels.checksum());
}

void digestTemplates(const TemplateSet& templates, DigestWriter& writer) {
  writer.tag("templates");
  writeIntegers({templates.side_px, templates.count}, writer);
  for (std::int32_t i = 0; i < templates.count; ++i) {
    const Template& item = nth(templates.templates, i);
    writeIntegers({item.center_x, item.center_y}, writer);
    writer.f32(item.depth_m);
    writer.f32(item.distinctness);
    writeReals(item.point_in_station_m, writer);
  }
}

void digestMatches(const MatchSet& matches, DigestWriter& writer) {
  writer.tag("matches");
  writer.i32(matches.count);
  for (std::int32_t i = 0; i < matches.count; ++i) {
    const Match& match = nth(matches.matches, i);
    writer.u8(match.searched ? 1 : 0);
    if (!match.searched) continue;
    writeIntegers({match.window.x_min, match.window.y_min, match.window.x_max, match.window.y_max,
                   match.norms.edges, match.norms.empties, match.peak.x, match.peak.y,
                   match.peak.counts.edge_hits, match.peak.counts.empty_hits},
                  writer);
    writer.u8(match.peak.has_second ? 1 : 0);
    if (match.peak.has_second)
      writeIntegers({match.peak.second_x, match.peak.second_y, match.peak.second_counts.edge_hits,
                     match.peak.second_counts.empty_hits},
                    writer);
    writeReals({match.x, match.y}, writer);
    writer.u8(match.at_border ? 1 : 0);
  }
}

void digestPnp(const PnpSolution& solution, DigestWriter& writer) {
  writer.tag("pose");
  digestPose(solution.camera_from_station, writer);
  writeIntegers({solution.inlier_count, solution.samples}, writer);
  writer.bytes(solution.inlier);
  writeReals(solution.residual_px, writer);
  writer.f64(solution.rms_px);
  digestMatrix(solution.covariance, writer);
}

void digestRefinement(const RefinementResult& refinement, DigestWriter& writer) {
  writer.tag("refinement");
  digestPose(refinement.camera_from_station, writer);
  writeIntegers({refinement.sample_count, refinement.found_count, refinement.used_count}, writer);
  writer.f64(refinement.rms_px);
  ChecksumWriter samples;
  for (std::int32_t i = 0; i < refinement.sample_count; ++i) {
    const EdgeSample& sample = nth(refinement.samples, i);
    writeReals(sample.point_in_station_m, samples);
    writeReals({sample.residual_px, sample.gradient, sample.weight}, samples);
  }
  writer.u32(samples.checksum());
  digestMatrix(refinement.covariance, writer);
}

void digestCandidates(std::span<const PoseCandidate> candidates, DigestWriter& writer) {
  writer.tag("candidates");
  writer.i32(static_cast<std::int32_t>(candidates.size()));
  for (const PoseCandidate& candidate : candidates) {
    digestPose(candidate.found.camera_from_station, writer);
    writer.f64(candidate.found.distance_px);
    digestPose(candidate.camera_from_station, writer);
    digestContours(candidate.evidence, writer);
  }
}

void digestEvidence(const PoseEvidence& evidence, DigestWriter& writer) {
  writer.tag("evidence");
  for (const ContourEvidence& view : evidence.contours) digestContours(view, writer);
  writer.f64(evidence.region.nats);
  writeIntegers({evidence.region.lines, evidence.region.separated}, writer);
}

void digestHypotheses(std::span<const PoseHypothesis> hypotheses, DigestWriter& writer) {
  writer.tag("hypotheses");
  writer.i32(static_cast<std::int32_t>(hypotheses.size()));
  for (const PoseHypothesis& hypothesis : hypotheses) {
    digestPose(hypothesis.camera_from_station, writer);
    writer.u8(static_cast<std::uint8_t>(hypothesis.origin));
    writer.i32(hypothesis.number);
    digestEvidence(hypothesis.evidence, writer);
    writeReals({hypothesis.score, hypothesis.probability}, writer);
  }
}

void digestEdgeWidth(const EdgeWidth& width, DigestWriter& writer) {
  writer.tag("edge width");
  writeReals(width.width_px, writer);
  for (const std::int32_t places : width.places) writer.i32(places);
}

void digestFocal(const FocalFit& focal, DigestWriter& writer) {
  writer.tag("focal length");
  writeReals({focal.change, focal.sigma}, writer);
  writer.u8(focal.determined ? 1 : 0);
}

void digestCompetingPoses(std::span<const CompetingPose> poses, DigestWriter& writer) {
  writer.tag("competing poses");
  writer.i32(static_cast<std::int32_t>(poses.size()));
  for (const CompetingPose& pose : poses) {
    digestPose(pose.camera_from_station, writer);
    writeReals({pose.similarity, pose.margin_nats}, writer);
    writer.u8(pose.mirrored ? 1 : 0);
  }
}

void digestSupport(const EdgeSupport& support, DigestWriter& writer) {
  writeSupport(support, writer);
}

}  // namespace boresight
