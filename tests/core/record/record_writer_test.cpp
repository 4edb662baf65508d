// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_writer.h"

#include <algorithm>
#include <functional>
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

/// A run recorded into memory of this size.
struct RecordedRun {
  std::vector<std::uint8_t> memory;
  std::span<const std::uint8_t> bytes;
  bool complete = false;
  int heap_allocations = 0;

  explicit RecordedRun(const Case& scene, const LocalizerOptions& options = {},
                       std::size_t size = 1 << 18)
      : memory(size + 64, 0xC7) {
    OwnedRun run(scene.problem(), options);
    const int before = heapAllocations();
    RecordWriter record{std::span(memory).first(size)};
    record.begin({}, scene.problem(), options);
    run.finish([&](const StepReport& report) { record.note(run.localizer, report); });
    record.end(run.localizer);
    bytes = record.bytes();
    complete = record.complete();
    heap_allocations = heapAllocations() - before;
    EXPECT_EQ(std::count(memory.end() - 64, memory.end(), 0xC7), 64) << "beyond its memory";
  }
};

TEST(RecordWriter, Blocks_FollowTheFormatAndTakeNoMemory) {
  const RecordedRun run(stationCase(3), {}, 65536);  // fits the downlink
  EXPECT_EQ(run.heap_allocations, 0);
  EXPECT_TRUE(run.complete);
  EXPECT_GT(run.bytes.size(), 2000u);
  ByteReader reader(run.bytes);
  EXPECT_TRUE(std::ranges::equal(reader.take(8), kRecordMagic));
  EXPECT_EQ(reader.u32(), kRecordVersion);
  std::uint32_t number = 0;
  std::vector<std::uint32_t> types;
  while (reader.left() > 0) {
    const auto whole = run.bytes.subspan(run.bytes.size() - reader.left());
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
      EXPECT_TRUE(types.back() != static_cast<std::uint32_t>(type) || length == content)
          << types.back() << ": " << length;
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
  const EdgeMap& edges = run.workspace.edges;
  std::vector<std::uint8_t> bytes;
  for (const BitImage& level : edges.level) appendBits(level, bytes);
  ByteReader block(record.bytes().subspan(begun));
  EXPECT_EQ(block.u32(), static_cast<std::uint32_t>(RecordBlock::kEdges));
  EXPECT_EQ(block.u32(), 2u);
  EXPECT_EQ(block.u32(), 52u);
  EXPECT_TRUE(std::ranges::equal(block.take(32), hashOf(bytes)));
  EXPECT_EQ(block.f64(), edges.low_threshold);
  EXPECT_EQ(block.f64(), edges.high_threshold);
  EXPECT_EQ(block.i32(), edges.edge_count);

  while (!report.iteration_complete) report = run.localizer.step();
  EdgeRender render = run.workspace.iteration->render;
  const RecordHash whole = renderHash(render);
  const std::int32_t middle = render.pixel_count / 2;
  PackedEdgePixel& packed = render.pixels[static_cast<std::size_t>(middle)];
  const EdgePixel before = render.pixel(middle);
  const std::function<void(EdgePixel&)> changes[] = {
      [](EdgePixel& pixel) { ++pixel.face; }, [](EdgePixel& pixel) { pixel.depth_m += 1.0F; },
      [](EdgePixel& pixel) { ++pixel.offset; },
      [](EdgePixel& pixel) { pixel.kind ^= kEdgeCrease; }};
  for (const auto& change : changes) {
    EdgePixel pixel = before;
    change(pixel);
    packed = PackedEdgePixel(pixel);
    EXPECT_NE(renderHash(render), whole) << &change - changes;
  }
  packed = PackedEdgePixel(before);
  EXPECT_EQ(renderHash(render), whole);
  ++render.mask.row(render.mask.height / 2)[1];
  EXPECT_NE(renderHash(render), whole);
}

/// A record with other bytes for the same run cannot be compared with those received before.
TEST(SameBits, OfRecords) {
  const auto sumOf = [](const Case& scene, const LocalizerOptions& options) {
    const RecordedRun run(scene, options);
    EXPECT_TRUE(run.complete);
    return crc32(run.bytes);
  };
  Case rolled = occludedCase(4);
  rolled.uncertainty.rotation_rad.z() = 0.6;
  Case failed = stationCase(3);
  const Picture noise = noisePicture(512, 512, 2);
  failed.picture = &noise;
  EXPECT_EQ(sumOf(stationCase(3), {}), 3249702589u);
  EXPECT_EQ(sumOf(rolled, paperProfile()), 3345082694u);
  EXPECT_EQ(sumOf(failed, withoutSearch()), 3715142729u);
}

TEST(RecordWriter, NeverWritesBeyondItsMemory) {
  const Case scene = stationCase(3);
  for (const std::size_t size : {0u, 1u, 100u, 297u, 298u, 1000u, 4000u, 9000u}) {
    const RecordedRun run(scene, {}, size);
    EXPECT_LE(run.bytes.size(), size);
    EXPECT_EQ(run.bytes.empty(), size < RecordWriter::kMinimumBytes);
    EXPECT_FALSE(run.complete && size < 4000u);
    if (run.bytes.empty()) continue;
    // The end is always there.
    const std::size_t end = run.bytes.size() - kBlockBytes - kEndBytes;
    EXPECT_EQ(ByteReader(run.bytes.subspan(end)).u32(),
              static_cast<std::uint32_t>(RecordBlock::kEnd));
  }
}

}  // namespace
}  // namespace boresight::test
