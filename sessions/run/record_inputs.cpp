// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/record_inputs.h"

#include "core/base/digest.h"

namespace boresight::sessions {
namespace {

RecordInputs::Hash pixelsHash(const ImageView& image, const ColorView& color) {
  DigestWriter writer;
  for (int y = 0; y < image.height; ++y)
    writer.bytes({image.row(y), static_cast<std::size_t>(image.width)});
  for (int y = 0; y < color.height; ++y)
    writer.bytes({color.row(y), static_cast<std::size_t>(color.width) * ColorView::kChannels});
  return writer.digest();
}

RecordInputs::Hash ignoreHash(const BitImage& ignore) {
  DigestWriter writer;
  for (int y = 0; y < ignore.height; ++y)
    for (int word = 0; word < BitImage::wordsPerRow(ignore.width); ++word)
      writer.u64(ignore.row(y)[word]);
  return writer.digest();
}

RecordInputs::Hash sceneHash(const MeshView& mesh) {
  DigestWriter writer;
  writer.u32(static_cast<std::uint32_t>(mesh.parts.size()));
  for (const ScenePart& part : mesh.parts) {
    writer.f64(part.normal_threshold_rad);
    writer.f64(part.depth_threshold_m);
    writer.u8(part.match ? 1 : 0);
  }
  writer.u32(static_cast<std::uint32_t>(mesh.vertices_in_station_m.size()));
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m)
    for (int i = 0; i < 3; ++i) writer.f32(vertex[i]);
  writer.u32(static_cast<std::uint32_t>(mesh.faces.size()));
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face].vertex) writer.i32(vertex);
    writer.i32(mesh.part_of_face[face]);
  }
  return writer.digest();
}

RecordInputs::Hash cameraHash(const Camera& camera) {
  DigestWriter writer;
  for (const std::int32_t value :
       {static_cast<std::int32_t>(camera.model), camera.width, camera.height})
    writer.i32(value);
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) writer.f64(value);
  for (const double value : camera.distortion) writer.f64(value);
  if (isCahvFamily(camera.model)) {
    const CahvLens& lens = camera.cahv;
    writer.f64(lens.skew_px);
    for (const Eigen::Vector3d& vector : {lens.optical_axis, lens.radial, lens.entrance_m})
      for (int i = 0; i < 3; ++i) writer.f64(vector[i]);
    writer.f64(lens.linearity);
  }
  return writer.digest();
}

}  // namespace

RecordInputs recordInputs(const LocalizationProblem& problem) {
  RecordInputs made;
  made.pixels = pixelsHash(problem.image, problem.color);
  if (problem.ignore != nullptr) made.ignore = ignoreHash(*problem.ignore);
  made.scene = sceneHash(problem.mesh);
  made.camera = cameraHash(problem.camera);
  return made;
}

}  // namespace boresight::sessions
