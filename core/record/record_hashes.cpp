// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_hashes.h"

#include "core/base/digest.h"
#include "core/localizer/value_writers.h"

namespace boresight {
namespace {

void writeBits(const BitImage& image, DigestWriter& writer) {
  writeIntegers({image.width, image.height}, writer);
  writeWords(image, writer);
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
  for (const EdgePixel& pixel : render.eachPixel()) writeEdgePixel(pixel, writer);
  return writer.digest();
}

}  // namespace boresight
