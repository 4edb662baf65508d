// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>

#include "core/accept/edge_support.h"
#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/render/edge_pixel.h"

namespace boresight {

// The values of a run in the order in which its digest, an encoded problem and the onboard record
// hold them. `writer` is a DigestWriter, a ChecksumWriter or a ByteWriter.

/// Writes an array, span or vector of reals.
template <class Reals, class Writer>
void writeReals(const Reals& values, Writer& writer) {
  for (const double value : values) writer.f64(value);
}
/// Writes a list of reals.
template <class Writer>
void writeReals(std::initializer_list<double> values, Writer& writer) {
  for (const double value : values) writer.f64(value);
}
/// Writes a list of integers.
template <class Writer>
void writeIntegers(std::initializer_list<std::int32_t> values, Writer& writer) {
  for (const std::int32_t value : values) writer.i32(value);
}

/// Writes the quaternion w x y z and the translation.
template <class Writer>
void writePose(const Pose& pose, Writer& writer) {
  const Eigen::Quaterniond& q = pose.rotation;
  writeReals({q.w(), q.x(), q.y(), q.z()}, writer);
  writeReals(pose.translation_m, writer);
}

/// Writes the box and its pivot.
template <class Writer>
void writeUncertainty(const SeedUncertainty& uncertainty, Writer& writer) {
  writeReals(uncertainty.translation_m, writer);
  writeReals(uncertainty.rotation_rad, writer);
  writeReals(uncertainty.pivot_in_camera_m, writer);
}

/// Writes the parameters of a camera without its model and size.
template <class Writer>
void writeOptics(const Camera& camera, Writer& writer) {
  writeReals({camera.fx, camera.fy, camera.cx, camera.cy}, writer);
  writeReals(camera.distortion, writer);
  if (!isCahvFamily(camera.model)) return;
  writer.f64(camera.cahv.skew_px);
  writeReals(camera.cahv.optical_axis, writer);
  writeReals(camera.cahv.radial, writer);
  writeReals(camera.cahv.entrance_m, writer);
  writer.f64(camera.cahv.linearity);
}

/// Writes the thresholds and role of each part.
template <class Writer>
void writeParts(const MeshView& mesh, Writer& writer) {
  for (const ScenePart& part : mesh.parts) {
    writeReals({part.normal_threshold_rad, part.depth_threshold_m}, writer);
    writer.u8(roleByte(part));
  }
}

/// Writes the coordinates of each vertex.
template <class Writer>
void writeVertices(const MeshView& mesh, Writer& writer) {
  for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m)
    for (const float coordinate : vertex) writer.f32(coordinate);
}

/// Writes the words of an image, row by row.
template <class Writer>
void writeWords(const BitImage& image, Writer& writer) {
  for (int y = 0; y < image.height; ++y)
    for (int word = 0; word < BitImage::wordsPerRow(image.width); ++word)
      writer.u64(image.row(y)[word]);
}

/// Writes an edge pixel without its place.
template <class Writer>
void writeEdgePixel(const EdgePixel& pixel, Writer& writer) {
  writer.f32(pixel.depth_m);
  writer.i32(pixel.face);
  for (const std::int8_t value : {pixel.normal_x, pixel.normal_y, pixel.offset})
    writer.u8(static_cast<std::uint8_t>(value));
  writer.u8(pixel.kind);
}

/// Writes all counts.
template <class Writer>
void writeSupport(const EdgeSupport& support, Writer& writer) {
  writeIntegers({support.rendered, support.covered, support.displaced, support.displaced_covered,
                 support.seen, support.explained, support.displaced_explained},
                writer);
}

}  // namespace boresight
