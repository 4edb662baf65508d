// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/run_digest.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string_view>

#include "core/base/crc32.h"

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
      writer.u64(words[static_cast<std::size_t>(std::countr_zero(differing))]);
    before = last;
  }
}

template <class Vector, class Writer>
void digestVector(const Vector& vector, Writer& writer) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) writer.f64(vector[i]);
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
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m)
    for (int i = 0; i < 3; ++i) sum.f32(vertex[i]);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face].vertex) sum.i32(vertex);
    sum.i32(mesh.part_of_face[face]);
  }
  return sum.checksum();
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

void digestPose(const Pose& pose, DigestWriter& writer) {
  writer.f64(pose.rotation.w());
  writer.f64(pose.rotation.x());
  writer.f64(pose.rotation.y());
  writer.f64(pose.rotation.z());
  digestVector(pose.translation_m, writer);
}

void digestProblem(const LocalizationProblem& problem, DigestWriter& writer) {
  writer.tag("problem");
  const ImageView& image = problem.image;
  writer.i32(image.width);
  writer.i32(image.height);
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
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) writer.f64(value);
  for (const double value : camera.distortion) writer.f64(value);
  if (isCahvFamily(camera.model)) {
    writer.f64(camera.cahv.skew_px);
    digestVector(camera.cahv.optical_axis, writer);
    digestVector(camera.cahv.radial, writer);
    digestVector(camera.cahv.entrance_m, writer);
    writer.f64(camera.cahv.linearity);
  }
  const MeshView& mesh = problem.mesh;
  writer.u32(static_cast<std::uint32_t>(mesh.vertices_in_station_m.size()));
  writer.u32(static_cast<std::uint32_t>(mesh.faces.size()));
  writer.u32(checksumOf(mesh));
  for (const ScenePart& part : mesh.parts) {
    writer.f64(part.normal_threshold_rad);
    writer.f64(part.depth_threshold_m);
    writer.u8(roleByte(part));
  }
  digestPose(problem.camera_from_station_seed, writer);
  digestVector(problem.uncertainty.translation_m, writer);
  digestVector(problem.uncertainty.rotation_rad, writer);
  digestVector(problem.uncertainty.pivot_in_camera_m, writer);
  if (!problem.end_effector_in_camera_m.isZero(0.0))
    digestVector(problem.end_effector_in_camera_m, writer);
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
  writer.f64(edges.low_threshold);
  writer.f64(edges.high_threshold);
  writer.u32(checksumOf(edges.level[0]));  // the other levels follow from this one
}

void digestRender(const EdgeRender& render, DigestWriter& writer) {
  writer.tag("render");
  digestPose(render.camera_from_station, writer);
  writer.u32(checksumOf(render.edges));
  writer.u32(checksumOf(render.mask));
  writer.i32(render.pixel_count);
  ChecksumWriter pixels;
  for (const EdgePixel& pixel : render.eachPixel()) {
    pixels.f32(pixel.depth_m);
    pixels.i32(pixel.face);
    pixels.u8(static_cast<std::uint8_t>(pixel.normal_x));
    pixels.u8(static_cast<std::uint8_t>(pixel.normal_y));
    pixels.u8(static_cast<std::uint8_t>(pixel.offset));
    pixels.u8(pixel.kind);
  }
  writer.u32(pixels.checksum());
}

void digestTemplates(const TemplateSet& templates, DigestWriter& writer) {
  writer.tag("templates");
  writer.i32(templates.side_px);
  writer.i32(templates.count);
  for (std::int32_t i = 0; i < templates.count; ++i) {
    const Template& item = templates.templates[static_cast<std::size_t>(i)];
    writer.i32(item.center_x);
    writer.i32(item.center_y);
    writer.f32(item.depth_m);
    writer.f32(item.distinctness);
    digestVector(item.point_in_station_m, writer);
  }
}

void digestMatches(const MatchSet& matches, DigestWriter& writer) {
  writer.tag("matches");
  writer.i32(matches.count);
  for (std::int32_t i = 0; i < matches.count; ++i) {
    const Match& match = matches.matches[static_cast<std::size_t>(i)];
    writer.u8(match.searched ? 1 : 0);
    if (!match.searched) continue;
    for (const int value :
         {match.window.x_min, match.window.y_min, match.window.x_max, match.window.y_max,
          match.norms.edges, match.norms.empties, match.peak.x, match.peak.y,
          match.peak.counts.edge_hits, match.peak.counts.empty_hits}) {
      writer.i32(value);
    }
    writer.u8(match.peak.has_second ? 1 : 0);
    if (match.peak.has_second) {
      for (const int value :
           {match.peak.second_x, match.peak.second_y, match.peak.second_counts.edge_hits,
            match.peak.second_counts.empty_hits}) {
        writer.i32(value);
      }
    }
    writer.f64(match.x);
    writer.f64(match.y);
    writer.u8(match.at_border ? 1 : 0);
  }
}

void digestPnp(const PnpSolution& solution, DigestWriter& writer) {
  writer.tag("pose");
  digestPose(solution.camera_from_station, writer);
  writer.i32(solution.inlier_count);
  writer.i32(solution.samples);
  writer.bytes(solution.inlier);
  for (const double residual_px : solution.residual_px) writer.f64(residual_px);
  writer.f64(solution.rms_px);
  digestMatrix(solution.covariance, writer);
}

void digestRefinement(const RefinementResult& refinement, DigestWriter& writer) {
  writer.tag("refinement");
  digestPose(refinement.camera_from_station, writer);
  writer.i32(refinement.sample_count);
  writer.i32(refinement.found_count);
  writer.i32(refinement.used_count);
  writer.f64(refinement.rms_px);
  ChecksumWriter samples;
  for (std::int32_t i = 0; i < refinement.sample_count; ++i) {
    const EdgeSample& sample = refinement.samples[static_cast<std::size_t>(i)];
    digestVector(sample.point_in_station_m, samples);
    samples.f64(sample.residual_px);
    samples.f64(sample.gradient);
    samples.f64(sample.weight);
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

void digestContours(const ContourEvidence& evidence, DigestWriter& writer) {
  writer.tag("contours");
  writer.i32(evidence.places);
  writer.i32(evidence.outline_places);
  writer.f64(evidence.place_length_px);
  writer.f64(evidence.edges_nats);
  writer.f64(evidence.outline_nats);
  writer.f64(evidence.expected_nats);
  writer.f64(evidence.outline_expected_nats);
  for (const double nats : evidence.quadrant_nats) writer.f64(nats);
}

void digestEvidence(const PoseEvidence& evidence, DigestWriter& writer) {
  writer.tag("evidence");
  for (const ContourEvidence& view : evidence.contours) digestContours(view, writer);
  writer.f64(evidence.region.nats);
  writer.i32(evidence.region.lines);
  writer.i32(evidence.region.separated);
}

void digestHypotheses(std::span<const PoseHypothesis> hypotheses, DigestWriter& writer) {
  writer.tag("hypotheses");
  writer.i32(static_cast<std::int32_t>(hypotheses.size()));
  for (const PoseHypothesis& hypothesis : hypotheses) {
    digestPose(hypothesis.camera_from_station, writer);
    writer.u8(static_cast<std::uint8_t>(hypothesis.origin));
    writer.i32(hypothesis.number);
    digestEvidence(hypothesis.evidence, writer);
    writer.f64(hypothesis.score);
    writer.f64(hypothesis.probability);
  }
}

void digestEdgeWidth(const EdgeWidth& width, DigestWriter& writer) {
  writer.tag("edge width");
  for (const double width_px : width.width_px) writer.f64(width_px);
  for (const std::int32_t places : width.places) writer.i32(places);
}

void digestFocal(const FocalFit& focal, DigestWriter& writer) {
  writer.tag("focal length");
  writer.f64(focal.change);
  writer.f64(focal.sigma);
  writer.u8(focal.determined ? 1 : 0);
}

void digestCompetingPoses(std::span<const CompetingPose> poses, DigestWriter& writer) {
  writer.tag("competing poses");
  writer.i32(static_cast<std::int32_t>(poses.size()));
  for (const CompetingPose& pose : poses) {
    digestPose(pose.camera_from_station, writer);
    writer.f64(pose.similarity);
    writer.f64(pose.margin_nats);
    writer.u8(pose.mirrored ? 1 : 0);
  }
}

void digestSupport(const EdgeSupport& support, DigestWriter& writer) {
  for (const std::int32_t count :
       {support.rendered, support.covered, support.displaced, support.displaced_covered,
        support.seen, support.explained, support.displaced_explained})
    writer.i32(count);
}

}  // namespace boresight
