// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <utility>

#include "core/base/crc32.h"
#include "core/localizer/schedule.h"
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

/// The blocks of the example's record, to change, leave out and join again.
std::vector<Bytes> exampleBlocks() {
  const Bytes& bytes = exampleRun().run.bytes;
  const std::vector<std::size_t> ends = blockEnds(bytes);
  std::vector<Bytes> blocks;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    blocks.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(ends[i]),
                        bytes.begin() + static_cast<std::ptrdiff_t>(ends[i + 1]));
  return blocks;
}

OnboardRecord parsedBlocks(const std::vector<Bytes>& blocks) {
  const Bytes& bytes = exampleRun().run.bytes;
  Bytes joined(bytes.begin(), bytes.begin() + 12);
  for (const Bytes& block : blocks) joined.insert(joined.end(), block.begin(), block.end());
  return parseRecord("r.whsr", joined);
}

void writeU32(std::uint32_t value, std::size_t at, Bytes& bytes) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

/// With the length and the checksum of its content.
void seal(Bytes& block) {
  writeU32(static_cast<std::uint32_t>(block.size() - 16), 8, block);
  writeU32(crc32(std::span(block).first(block.size() - 4)), block.size() - 4, block);
}

std::string typeOf(const Bytes& block) { return {block.begin(), block.begin() + 4}; }

std::size_t firstOf(const std::string& type, const std::vector<Bytes>& blocks) {
  return static_cast<std::size_t>(std::ranges::find(blocks, type, &typeOf) - blocks.begin());
}

/// Every block is left out in turn: the rest is read, and each iteration keeps its own templates.
TEST(OnboardRecord, BlockThatIsLeftOut_IsNamedAndTheRestIsRead) {
  const std::vector<Bytes> blocks = exampleBlocks();
  const OnboardRecord& whole = exampleRun().run.record;
  std::map<std::string, const char*> sentences = {
      {"INPT", "the hashes of the inputs and the seed"},
      {"OPTS", "the options"},
      {"EDGE", "the hash of the image's edges"},
      {"TMPL", "the templates of iteration "},
      {"END!", "how the run ended, its pose and its digest"}};
  const std::string count = std::to_string(whole.iterations.size());
  const std::string missing_iteration = "1 of " + count + " iterations";
  sentences["ITER"] = missing_iteration.c_str();
  for (std::size_t left_out = 0; left_out < blocks.size(); ++left_out) {
    const std::string type = typeOf(blocks[left_out]);
    SCOPED_TRACE(type);
    std::vector<Bytes> rest = blocks;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    const OnboardRecord read = parsedBlocks(rest);
    EXPECT_FALSE(read.whole());
    const std::string number = std::to_string(left_out);
    if (type == "END!") {
      EXPECT_THAT(read.missing, Contains("every iteration after the first " + count));
    } else {
      EXPECT_THAT(read.missing,
                  Contains("blocks " + number + " to " + number + " did not fit on board"));
    }
    if (sentences.contains(type)) {
      EXPECT_THAT(read.missing, Contains(HasSubstr(sentences[type])));
    }
    EXPECT_EQ(read.inputs.has_value(), type != "INPT");
    EXPECT_EQ(read.options.empty(), type == "OPTS");
    EXPECT_EQ(read.edges.has_value(), type != "EDGE");
    EXPECT_EQ(read.end.has_value(), type != "END!");
    EXPECT_EQ(read.iterations.size() + (type == "ITER" ? 1 : 0), whole.iterations.size());
    for (const RecordedIteration& iteration : read.iterations) {
      const auto& own = whole.iterations[static_cast<std::size_t>(iteration.trace.index)];
      if (iteration.templates) {
        EXPECT_EQ(iteration.templates, own.templates);
      }
      EXPECT_TRUE(iteration.templates || !own.templates || type == "TMPL");
      EXPECT_TRUE(own.support || !iteration.support) << "that of another iteration";
    }
  }
}

TEST(OnboardRecord, InvalidBlockUnderAValidChecksum_EndsTheReading) {
  const std::vector<Bytes> good = exampleBlocks();
  const auto read = [&good](std::size_t index, const std::function<void(Bytes&)>& edit) {
    std::vector<Bytes> blocks = good;
    edit(blocks[index]);
    seal(blocks[index]);
    return parsedBlocks(blocks);
  };
  const std::size_t iteration = firstOf("ITER", good);
  std::size_t before = 12;
  for (std::size_t i = 0; i < iteration; ++i) before += good[i].size();
  EXPECT_TRUE(read(iteration, [](Bytes&) {}).whole()) << "sealed again, it is the same";
  const std::function<void(Bytes&)> edits[] = {
      [](Bytes& block) { block[12 + 8] = 2; },                 // a kind that does not exist
      [](Bytes& block) { block[12 + 9] = 4; },                 // a level that does not exist
      [](Bytes& block) { block[12 + 10] = 9; },                // a stage that does not exist
      [](Bytes& block) { block[12 + 11] = 200; },              // a status that does not exist
      [](Bytes& block) { block.insert(block.end() - 4, 0); },  // longer than its content
      [](Bytes& block) { block.erase(block.end() - 5); },      // shorter than its content
      [](Bytes& block) { block[0] = 'J'; }};                   // a type that does not exist
  for (const auto& edit : edits) {
    const OnboardRecord left = read(iteration, edit);
    EXPECT_THAT(left.iterations, IsEmpty());
    EXPECT_TRUE(left.inputs && left.edges);
    EXPECT_THAT(left.missing, Contains("block " + std::to_string(iteration) + " at byte " +
                                       std::to_string(before) +
                                       " is unknown to this program: nothing after it was read"));
  }
  const OnboardRecord finest = read(iteration, [](Bytes& block) { block[12 + 9] = 3; });
  EXPECT_EQ(finest.iterations.at(0).trace.level, 3);
  // A block with the number of an earlier one.
  const OnboardRecord twice = read(iteration, [&](Bytes& block) {
    writeU32(static_cast<std::uint32_t>(iteration) - 1, 4, block);
  });
  EXPECT_THAT(twice.missing, Contains(HasSubstr("is damaged: nothing after it was read")));
  EXPECT_THAT(twice.iterations, IsEmpty());
}

/// The rolls of the hypotheses follow from their number; of the chosen one the record has more.
TEST(OnboardRecord, RolledHypotheses_AreThoseOfTheirCount) {
  const std::vector<Bytes> good = exampleBlocks();
  const std::size_t at = firstOf("ITER", good);
  const auto read = [&](int count, int chosen) {
    std::vector<Bytes> blocks = good;
    writeU32(static_cast<std::uint32_t>(count), 12 + 180, blocks[at]);
    writeU32(static_cast<std::uint32_t>(chosen), 12 + 184, blocks[at]);
    writeU32(0x3FC00000, 12 + 188, blocks[at]);  // a roll of 0.125 rad
    writeU32(0, 12 + 192, blocks[at]);
    seal(blocks[at]);
    return parsedBlocks(blocks).iterations.at(0).trace;
  };
  for (const auto& [count, chosen] : {std::pair(1, 0), std::pair(3, 2), std::pair(9, 8)}) {
    const IterationTrace trace = read(count, chosen);
    EXPECT_EQ(trace.chosen_hypothesis, chosen);
    ASSERT_EQ(trace.hypotheses.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const HypothesisSummary& hypothesis = trace.hypotheses[static_cast<std::size_t>(i)];
      EXPECT_EQ(hypothesis.roll_rad, i == chosen ? 0.125 : rollOf(i));
      EXPECT_EQ(hypothesis.solved, i == chosen);
      EXPECT_EQ(hypothesis.templates, i == chosen ? trace.template_count : 0);
      EXPECT_EQ(hypothesis.matches, i == chosen ? trace.correspondence_count : 0);
      EXPECT_EQ(hypothesis.inliers, i == chosen ? trace.pnp.inlier_count : 0);
      if (i == chosen) {
        EXPECT_EQ(hypothesis.camera_from_station, trace.camera_from_station);
      }
    }
  }
  for (const auto& [count, chosen] :
       {std::pair(0, 0), std::pair(10, 2), std::pair(3, 3), std::pair(3, -1), std::pair(-1, -2)}) {
    const IterationTrace trace = read(count, chosen);
    EXPECT_EQ(trace.chosen_hypothesis, 0) << count << " " << chosen;
    EXPECT_THAT(trace.hypotheses, IsEmpty());
  }
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
  for (std::size_t size = 0; size < 12; ++size)
    EXPECT_NE(message(Bytes(run.bytes.begin(), run.bytes.begin() + static_cast<long>(size))),
              "(nothing)")
        << size;
  EXPECT_THAT(message(Bytes(run.bytes.begin(), run.bytes.begin() + 11)),
              HasSubstr("ends before its version"));
  Bytes newer = run.bytes;
  newer[11] = 3;
  EXPECT_THAT(message(newer), HasSubstr("is a record of version 3"));
  Bytes longer = run.bytes;
  longer.push_back(0);
  EXPECT_THAT(parseRecord("r", longer).missing, ElementsAre(HasSubstr("1 bytes follow")));
}

}  // namespace
}  // namespace boresight::test
