// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_hashes.h"

#include "core/base/digest.h"

namespace boresight {
namespace {

void writeBits(const BitImage& image, DigestWriter& writer) {
  writer.i32(image.width);
  writer.i32(image.height);
  const int words = BitImage::wordsPerRow(image.width);
  for (int y = 0; y < image.height; ++y)
    for (int word = 0; word < words; ++word) writer.u64(image.row(y)[word]);
}

}  // namespace

RecordHash edgeMapHash(const EdgeMap& edges) {
  DigestWriter writer;
  for (const BitImage& level : edges.level) writeBits(level, writer);
  return writer.digest();
}

RecordHash renderHash(const EdgeRender& render) {
  DigestWriter writer;
  writeBits(render.edges, writer);
  writeBits(render.mask, writer);
  writer.i32(render.pixel_count);
  for (const EdgePixel& pixel : render.eachPixel()) {
    writer.f32(pixel.depth_m);
    writer.i32(pixel.face);
    for (const std::int8_t value : {pixel.normal_x, pixel.normal_y, pixel.offset})
      writer.u8(static_cast<std::uint8_t>(value));
    writer.u8(pixel.kind);
  }
  return writer.digest();
}

}  // namespace boresight
