// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_writer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/crc32.h"
#include "core/base/sha256.h"
#include "core/record/record_hashes.h"
#include "tests/core/localizer/heap_count.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// Runs a case and records it into `out`; how often that took memory from the heap.
int recordRun(const Case& scene, std::span<std::uint8_t> out, std::span<const std::uint8_t>& bytes,
              bool& complete, const LocalizerOptions& options = {}) {
  OwnedRun run(scene.problem(), options);
  const int before = heapAllocations();
  RecordWriter record(out);
  record.begin({}, scene.problem(), options);
  StepReport report;
  while (!report.finished) {
    report = run.localizer.step();
    record.note(run.localizer, report);
  }
  record.end(run.localizer);
  bytes = record.bytes();
  complete = record.complete();
  return heapAllocations() - before;
}

TEST(RecordWriter, TakesNoMemoryAndFitsTheDownlink) {
  const Case scene = stationCase(3);
  std::vector<std::uint8_t> memory(65536);
  std::span<const std::uint8_t> bytes;
  bool complete = false;
  EXPECT_EQ(recordRun(scene, memory, bytes, complete), 0);
  EXPECT_TRUE(complete);
  EXPECT_GT(bytes.size(), 2000u);
  RecordProperty("bytes", static_cast<int>(bytes.size()));
}

TEST(RecordWriter, Blocks_FollowTheFormat) {
  const Case scene = stationCase(3);
  std::vector<std::uint8_t> memory(65536);
  std::span<const std::uint8_t> bytes;
  bool complete = false;
  recordRun(scene, memory, bytes, complete);
  ByteReader reader(bytes);
  const auto magic = reader.take(8);
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), kRecordMagic.begin()));
  EXPECT_EQ(reader.u32(), kRecordVersion);
  std::uint32_t number = 0;
  std::vector<std::uint32_t> types;
  while (reader.left() > 0) {
    const auto whole = bytes.subspan(bytes.size() - reader.left());
    types.push_back(reader.u32());
    EXPECT_EQ(reader.u32(), number++);
    const std::uint32_t length = reader.u32();
    (void)reader.take(length);
    EXPECT_EQ(reader.u32(), crc32(whole.first(12 + length)));
    ASSERT_FALSE(reader.failed());
    for (const auto& [type, content] : {std::pair{RecordBlock::kIteration, std::size_t{252}},
                                        {RecordBlock::kInputs, 288},
                                        {RecordBlock::kEdges, 52},
                                        {RecordBlock::kSupport, 33},
                                        {RecordBlock::kEnd, kEndBytes}}) {
      if (types.back() == static_cast<std::uint32_t>(type)) {
        EXPECT_EQ(length, content);
      }
    }
  }
  EXPECT_EQ(types.front(), static_cast<std::uint32_t>(RecordBlock::kInputs));
  EXPECT_EQ(types.back(), static_cast<std::uint32_t>(RecordBlock::kEnd));
}

/// The bytes of a level of the edge map as FORMAT.md defines them.
void appendBits(const BitImage& image, std::vector<std::uint8_t>& bytes) {
  const auto append = [&bytes](std::uint64_t value, int count) {
    for (int i = count - 1; i >= 0; --i)
      bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  append(static_cast<std::uint64_t>(image.width), 4);
  append(static_cast<std::uint64_t>(image.height), 4);
  for (int y = 0; y < image.height; ++y) {
    for (int first = 0; first < image.width; first += 64) {
      std::uint64_t word = 0;
      for (int x = first; x < std::min(first + 64, image.width); ++x)
        word |= std::uint64_t{image.get(x, y)} << (x - first);
      append(word, 8);
    }
  }
}

RecordHash hashOf(std::span<const std::uint8_t> bytes) {
  Sha256 sha(sha256Plain);
  sha.update(bytes);
  return sha.digest();
}

TEST(RecordWriter, HashesEdgesAndRendersPixelByPixel) {
  const Case scene = stationCase(3);
  OwnedRun run(scene.problem(), LocalizerOptions());
  std::vector<std::uint8_t> memory(65536);
  RecordWriter record(memory);
  record.begin({}, scene.problem(), LocalizerOptions());
  const std::size_t begun = record.bytes().size();
  StepReport report;
  while (!(report.stage == Stage::kEdges && report.stage_complete)) {
    report = run.localizer.step();
    record.note(run.localizer, report);
  }
  const EdgeMap& edges = run.localizer.workspace().edges;
  std::vector<std::uint8_t> bytes;
  for (const BitImage& level : edges.level) appendBits(level, bytes);
  const RecordHash expected = hashOf(bytes);
  ByteReader block(record.bytes().subspan(begun));
  EXPECT_EQ(block.u32(), static_cast<std::uint32_t>(RecordBlock::kEdges));
  EXPECT_EQ(block.u32(), 2u);
  EXPECT_EQ(block.u32(), 52u);
  const auto written = block.take(32);
  EXPECT_TRUE(std::equal(written.begin(), written.end(), expected.begin()));
  EXPECT_EQ(block.f64(), edges.low_threshold);
  EXPECT_EQ(block.f64(), edges.high_threshold);
  EXPECT_EQ(block.i32(), edges.edge_count);

  while (!report.iteration_complete) report = run.localizer.step();
  EdgeRender render = run.localizer.workspace().iteration->render;
  const RecordHash whole = renderHash(render);
  const auto differs = [&](auto& value) {
    const auto before = value;
    ++value;
    const bool other = renderHash(render) != whole;
    value = before;
    return other;
  };
  const std::int32_t middle = render.pixel_count / 2;
  const EdgePixel before = render.pixel(middle);
  const auto differsBy = [&](const auto& change) {
    EdgePixel pixel = before;
    change(pixel);
    PackedEdgePixel& packed = render.pixels[static_cast<std::size_t>(middle)];
    packed = PackedEdgePixel(pixel);
    const bool other = renderHash(render) != whole;
    packed = PackedEdgePixel(before);
    return other;
  };
  EXPECT_TRUE(differsBy([](EdgePixel& pixel) { ++pixel.face; }));
  EXPECT_TRUE(differsBy([](EdgePixel& pixel) { pixel.depth_m += 1.0F; }));
  EXPECT_TRUE(differsBy([](EdgePixel& pixel) { ++pixel.offset; }));
  EXPECT_TRUE(differsBy([](EdgePixel& pixel) { pixel.kind ^= kEdgeCrease; }));
  EXPECT_TRUE(differs(render.mask.row(render.mask.height / 2)[1]));
  EXPECT_EQ(renderHash(render), whole);
}

/// A record with other bytes for the same run cannot be compared with those received before.
TEST(SameBits, OfRecords) {
  const auto sumOf = [](const Case& scene, const LocalizerOptions& options) {
    std::vector<std::uint8_t> memory(1 << 18);
    std::span<const std::uint8_t> bytes;
    bool complete = false;
    recordRun(scene, memory, bytes, complete, options);
    EXPECT_TRUE(complete);
    return crc32(bytes);
  };
  Case rolled = occludedCase(4);
  rolled.uncertainty.rotation_rad.z() = 0.6;
  Case failed = stationCase(3);
  const Picture noise = noisePicture(512, 512, 2);
  failed.picture = &noise;
  EXPECT_EQ(sumOf(stationCase(3), {}), 1201373144u);
  EXPECT_EQ(sumOf(rolled, paperProfile()), 179653557u);
  EXPECT_EQ(sumOf(failed, withoutSearch()), 5415202u);
}

TEST(RecordWriter, NeverWritesBeyondItsMemory) {
  const Case scene = stationCase(3);
  for (std::size_t size : {0u, 1u, 100u, 297u, 298u, 1000u, 4000u, 9000u}) {
    std::vector<std::uint8_t> memory(size + 64, 0xC7);
    std::span<const std::uint8_t> bytes;
    bool complete = true;
    recordRun(scene, std::span(memory).first(size), bytes, complete);
    EXPECT_LE(bytes.size(), size);
    EXPECT_EQ(bytes.empty(), size < RecordWriter::kMinimumBytes);
    EXPECT_FALSE(complete && size < 4000u);
    for (std::size_t i = size; i < memory.size(); ++i) ASSERT_EQ(memory[i], 0xC7);
    if (bytes.empty()) continue;
    // The end is always there.
    const std::size_t end = bytes.size() - kBlockBytes - kEndBytes;
    EXPECT_EQ(ByteReader(bytes.subspan(end)).u32(), static_cast<std::uint32_t>(RecordBlock::kEnd));
  }
}

}  // namespace
}  // namespace boresight::test
