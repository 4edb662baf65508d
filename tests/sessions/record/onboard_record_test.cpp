// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sessions/io/files/errors.h"
#include "tests/sessions/record/recorded_run.h"
#include "tests/support/all_cases.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using namespace sessions;

using Bytes = std::vector<std::uint8_t>;

/// Its figures are compared in record_of_run_test.cpp, against the record of the trace.
TEST(OnboardRecord, IsWholeAndHasEveryOption) {
  const OnboardRecord& read = exampleRun().run.record;
  EXPECT_TRUE(read.whole()) << read.missing.front();
  EXPECT_LT(exampleRun().run.bytes.size(), 65536u);
  ASSERT_EQ(read.options.size(), 1u);
  std::size_t i = 0;
  const LocalizerOptions given = recordedOptions();
  LocalizerOptions::visitFields(given, [&](const OptionInfo& info, const auto& field) {
    ASSERT_LT(i, read.options[0].options.size());
    const RecordedOption& option = read.options[0].options[i++];
    EXPECT_EQ(option.name, info.name);
    EXPECT_EQ(option.value(), static_cast<double>(field));
  });
  EXPECT_EQ(i, read.options[0].options.size());
}

/// What there is of `part` is as it is in `whole`.
void expectBeginningOf(const OnboardRecord& part, const OnboardRecord& whole) {
  ASSERT_LE(part.iterations.size(), whole.iterations.size());
  for (std::size_t i = 0; i < part.iterations.size(); ++i) {
    ASSERT_EQ(part.iterations[i].trace.index, whole.iterations[i].trace.index);
    ASSERT_EQ(part.iterations[i].trace.camera_from_station,
              whole.iterations[i].trace.camera_from_station);
    if (part.iterations[i].templates) {
      ASSERT_EQ(part.iterations[i].templates->size(), whole.iterations[i].templates->size());
    }
  }
  ASSERT_LE(part.options.size(), whole.options.size());
  if (!part.options.empty()) {
    ASSERT_EQ(part.options[0], whole.options[0]);
  }
  if (part.end) {
    ASSERT_EQ(part.end->digest, whole.end->digest);
  }
}

/// Where blocks end, by the format alone.
std::vector<std::size_t> blockEnds(const Bytes& bytes) {
  std::vector<std::size_t> ends = {12};
  while (ends.back() < bytes.size()) {
    const std::size_t at = ends.back() + 8;
    const std::size_t length = (std::size_t{bytes[at]} << 24) | (std::size_t{bytes[at + 1]} << 16) |
                               (std::size_t{bytes[at + 2]} << 8) | bytes[at + 3];
    ends.push_back(ends.back() + 16 + length);
  }
  return ends;
}

TEST(OnboardRecord, CutOffAnywhereYieldsAllBefore) {
  const auto& [bytes, whole, trace] = exampleRun().run;
  const std::vector<std::size_t> ends = blockEnds(bytes);
  ASSERT_EQ(ends.back(), bytes.size());
  std::size_t blocks = 0;  // that are whole
  std::size_t iterations = 0;
  std::size_t next_end = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // Every size around the end of a block, some within.
    while (next_end < ends.size() && ends[next_end] + 16 < size) ++next_end;
    const bool near_end = next_end < ends.size() && size + 16 > ends[next_end];
    if (!near_end && size % 16 != 0 && !allCases()) continue;
    // A block of its own size, so that a sanitizer sees every read beyond it.
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < 12) {
      EXPECT_THROW((void)parseRecord("r.whsr", cut), InputError);
      continue;
    }
    if (blocks + 1 < ends.size() && size == ends[blocks + 1]) {
      const std::size_t begin = ends[blocks++];
      iterations += bytes[begin] == 'I' && bytes[begin + 1] == 'T';
    }
    const OnboardRecord read = parseRecord("r.whsr", cut);
    ASSERT_EQ(read.iterations.size(), iterations) << size;
    ASSERT_EQ(read.inputs.has_value(), blocks >= 1);
    ASSERT_EQ(read.options.size(), blocks >= 2 ? 1u : 0u);
    ASSERT_FALSE(read.whole());
    ASSERT_FALSE(read.end);
    expectBeginningOf(read, whole);
  }
}

TEST(OnboardRecord, FlippedBitsAreNeverTaken) {
  const RecordedRun& run = exampleRun().run;
  const OnboardRecord& whole = run.record;
  const std::vector<std::size_t> ends = blockEnds(run.bytes);
  Random random = randomFor("OnboardRecord.Flips");
  for (int trial = 0; trial < (allCases() ? 3000 : 500); ++trial) {
    Bytes bad = run.bytes;
    const std::size_t at = random.below(static_cast<std::uint32_t>(bad.size()));
    bad[at] = static_cast<std::uint8_t>(bad[at] ^ (1u << random.below(8)));
    if (at < 12) {
      EXPECT_THROW((void)parseRecord("r.whsr", bad), InputError);
      continue;
    }
    const OnboardRecord read = parseRecord("r.whsr", bad);
    ASSERT_FALSE(read.whole()) << at;
    expectBeginningOf(read, whole);
    // Everything up to the damaged block, and nothing of it or after it.
    std::size_t before = 0;
    for (std::size_t i = 0; ends[i + 1] <= at; ++i)
      before += run.bytes[ends[i]] == 'I' && run.bytes[ends[i] + 1] == 'T';
    ASSERT_EQ(read.iterations.size(), before) << at;
  }
  // Many bits at once: no crash, and nothing that was not written.
  for (int trial = 0; trial < (allCases() ? 1000 : 200); ++trial) {
    Bytes bad = run.bytes;
    for (std::uint32_t i = 1 + random.below(40); i > 0; --i) {
      const std::size_t at = 12 + random.below(static_cast<std::uint32_t>(bad.size() - 12));
      bad[at] = static_cast<std::uint8_t>(random.below(256));
    }
    expectBeginningOf(parseRecord("r.whsr", bad), whole);
  }
}

TEST(OnboardRecord, MissingBlocks_AreListed) {
  const RecordedRun& whole = exampleRun().run;
  const OnboardRecord read =
      recordRun(exampleRun().problem, recordedOptions(), whole.bytes.size() / 2).record;
  EXPECT_FALSE(read.whole());
  ASSERT_TRUE(read.end);
  EXPECT_EQ(read.end->digest, whole.trace.digest);
  EXPECT_THAT(read.missing, Contains(HasSubstr("did not fit on board")));
}

TEST(OnboardRecord, RefusesOtherFiles) {
  const TemporaryFolder folder;
  const RecordedRun& run = exampleRun().run;
  const auto message = [&](const Bytes& bytes) {
    const auto file = folder.write("r.whsr", bytes);
    return folder.message([&] { (void)readRecord(file); });
  };
  EXPECT_EQ(message(run.bytes), "(nothing)");
  EXPECT_THAT(message({}), HasSubstr("r.whsr"));
  EXPECT_THAT(message({'P', 'K'}), HasSubstr("is not an onboard record"));
  Bytes newer = run.bytes;
  newer[11] = 3;
  EXPECT_THAT(message(newer), HasSubstr("is a record of version 3"));
  Bytes longer = run.bytes;
  longer.push_back(0);
  EXPECT_THAT(parseRecord("r", longer).missing, ElementsAre(HasSubstr("1 bytes follow")));
}

}  // namespace
}  // namespace boresight::test
