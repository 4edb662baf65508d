// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_writer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/crc32.h"
#include "tests/core/localizer/heap_count.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// Runs a case and records it into `out`; how often that took memory from the heap.
int recordRun(const Case& scene, std::span<std::uint8_t> out, std::span<const std::uint8_t>& bytes,
              bool& complete) {
  const LocalizerOptions options;
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
  EXPECT_GT(bytes.size(), 3000u);
  RecordProperty("bytes", static_cast<int>(bytes.size()));
}

TEST(RecordWriter, WritesBlocksAsTheFormatSays) {
  const Case scene = stationCase(3);
  std::vector<std::uint8_t> memory(65536);
  std::span<const std::uint8_t> bytes;
  bool complete = false;
  recordRun(scene, memory, bytes, complete);
  ByteReader reader(bytes);
  const auto magic = reader.take(8);
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), kRecordMagic.begin()));
  EXPECT_EQ(reader.u32(), 1u);
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
    for (const auto& [type, content] : {std::pair{RecordBlock::kIteration, std::size_t{220}},
                                        {RecordBlock::kInputs, 264},
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
