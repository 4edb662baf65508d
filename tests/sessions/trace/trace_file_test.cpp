// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/trace_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/digest.h"
#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/runner.h"
#include "sessions/trace/archive.h"
#include "sessions/trace/trace_fields.h"
#include "tests/support/example_run.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::exampleTrace;
using testing::HasSubstr;

constexpr std::size_t kChecksumBytes = 32;
constexpr std::size_t kHeaderBytes = 20;

/// All fields as bytes: equal bytes, equal traces.
std::vector<std::uint8_t> bytesOf(const LocalizationTrace& trace) {
  ArchiveWriter writer;
  fields(writer, trace);
  return writer.bytes();
}

/// Adds length and checksum, so that what was changed in the payload is seen by the reader itself.
std::string sealed(std::string without_checksum) {
  const std::uint64_t length = without_checksum.size() - kHeaderBytes;
  for (std::size_t i = 0; i < 8; ++i)
    without_checksum[12 + i] = static_cast<char>(length >> (8 * (7 - i)) & 0xff);
  Sha256 sha;
  sha.update(
      {reinterpret_cast<const std::uint8_t*>(without_checksum.data()), without_checksum.size()});
  const auto sum = sha.digest();
  return without_checksum + std::string(sum.begin(), sum.end());
}

TEST(TraceFile, GivesBackEveryFieldExactly) {
  const test::TemporaryFolder folder;
  LocalizationTrace trace = exampleTrace();
  LocalizerOptions other;
  other.pnp.seed = 77;
  trace.changes = {{2, LocalizerOptions()}, {5, other}};
  trace.competing_poses.resize(2);
  trace.competing_poses[1].camera_from_station.translation_m = {0.1, 0.2, 0.3};
  trace.competing_poses[1].similarity = 0.5;
  trace.competing_poses[1].margin_nats = 3.5;
  saveTrace(folder / "run.trace", trace);
  const LocalizationTrace loaded = loadTrace(folder / "run.trace");
  EXPECT_EQ(bytesOf(loaded), bytesOf(trace));
  // Not through the fields that the comparison above rests on:
  ASSERT_EQ(loaded.changes.size(), 2u);
  EXPECT_EQ(loaded.changes[0].iteration, 2);
  EXPECT_TRUE(sameOptions(loaded.lastOptions(), other));
  ASSERT_EQ(loaded.competing_poses.size(), 2u);
  EXPECT_EQ(loaded.competing_poses[1].camera_from_station,
            trace.competing_poses[1].camera_from_station);
  EXPECT_EQ(loaded.competing_poses[1].similarity, 0.5);
  EXPECT_EQ(loaded.competing_poses[1].margin_nats, 3.5);
  ASSERT_EQ(loaded.iterations.size(), trace.iterations.size());
  EXPECT_EQ(loaded.digest, trace.digest);
  EXPECT_EQ(loaded.status, trace.status);
  EXPECT_EQ(loaded.options.edges.gaussian_sigma_px, trace.options.edges.gaussian_sigma_px);
  EXPECT_EQ(loaded.camera_from_station.translation_m, trace.camera_from_station.translation_m);
  EXPECT_EQ(loaded.covariance, trace.covariance);
  EXPECT_EQ(loaded.support.share(), trace.support.share());
  EXPECT_EQ(loaded.edges->level[1].words, trace.edges->level[1].words);
  const IterationTrace& first = *loaded.iterations.front();
  const IterationTrace& expected = *trace.iterations.front();
  EXPECT_EQ(first.render.edges.words, expected.render.edges.words);
  EXPECT_EQ(first.render.pixels.back().depth_m, expected.render.pixels.back().depth_m);
  EXPECT_EQ(first.matches.back().peak.second_counts, expected.matches.back().peak.second_counts);
  EXPECT_EQ(first.pnp.residual_px, expected.pnp.residual_px);
  EXPECT_EQ(loaded.iterations.back()->refinement.samples.back().residual_px,
            trace.iterations.back()->refinement.samples.back().residual_px);
}

TEST(TraceFile, KeepsAnEmptyTrace) {
  const test::TemporaryFolder folder;
  saveTrace(folder / "empty.trace", {});
  EXPECT_EQ(bytesOf(loadTrace(folder / "empty.trace")), bytesOf(LocalizationTrace{}));
}

TEST(TraceFile, RefusesWhatIsNotATrace) {
  const test::TemporaryFolder folder;
  const auto message = [&](const std::string& name, std::string_view text) {
    folder.write(name, text);
    return folder.message([&] { loadTrace(folder / name); });
  };
  EXPECT_THAT(message("picture.trace", "PNG and so on"), HasSubstr("not a trace"));
  EXPECT_THAT(message("short.trace", "BSTRACE\n"), HasSubstr("truncated"));
  EXPECT_THAT(folder.message([&] { loadTrace(folder / "missing.trace"); }),
              HasSubstr("missing.trace"));
}

TEST(TraceFile, RefusesAnotherVersion) {
  const test::TemporaryFolder folder;
  saveTrace(folder / "run.trace", {});
  for (const int later : {-1, 1}) {
    std::string bytes = folder.read("run.trace");
    bytes[11] = static_cast<char>(bytes[11] + later);
    folder.write("other.trace", bytes);
    EXPECT_THAT(folder.message([&] { loadTrace(folder / "other.trace"); }),
                HasSubstr("other.trace: version: " + std::to_string(bytes[11])));
  }
}

TEST(TraceFile, NoticesFlippedBitsAndCuts) {
  const test::TemporaryFolder folder;
  saveTrace(folder / "run.trace", exampleTrace());
  const std::string whole = folder.read("run.trace");
  Random random = test::randomFor("NoticesFlippedBitsAndCuts");
  for (int i = 0; i < 20; ++i) {
    std::string flipped = whole;
    const auto place = random.below(static_cast<std::uint32_t>(whole.size()));
    flipped[place] = static_cast<char>(flipped[place] ^ (1 << random.below(8)));
    folder.write("bad.trace", flipped);
    EXPECT_THROW(loadTrace(folder / "bad.trace"), InputError) << place;
    const auto cut = random.below(static_cast<std::uint32_t>(whole.size()));
    folder.write("bad.trace", std::string_view(whole).substr(0, cut));
    EXPECT_THROW(loadTrace(folder / "bad.trace"), InputError) << cut;
  }
}

TEST(TraceFile, RefusesMoreBytesThanFields) {
  const test::TemporaryFolder folder;
  saveTrace(folder / "run.trace", {});
  std::string bytes = folder.read("run.trace");
  bytes.resize(bytes.size() - kChecksumBytes);
  EXPECT_EQ(sealed(bytes), folder.read("run.trace"));
  folder.write("long.trace", sealed(bytes + "extra"));
  EXPECT_THAT(folder.message([&] { loadTrace(folder / "long.trace"); }), HasSubstr("more bytes"));
}

TEST(Archive, RoundTripsExtremes) {
  ArchiveWriter writer;
  writer.number(std::int16_t{-32768});
  writer.number(std::int8_t{-1});
  writer.number(std::uint64_t{0xfedcba9876543210u});
  writer.number(-0.0);
  writer.number(1.5F);
  writer.text("");
  EXPECT_EQ(writer.bytes()[0], 0x80);
  ArchiveReader reader("memory", writer.bytes());
  std::int16_t small = 0;
  std::int8_t tiny = 0;
  std::uint64_t large = 0;
  double zero = 1.0;
  float real = 0.0F;
  std::string text = "x";
  reader.number(small);
  reader.number(tiny);
  reader.number(large);
  reader.number(zero);
  reader.number(real);
  reader.text(text);
  EXPECT_EQ(small, -32768);
  EXPECT_EQ(tiny, -1);
  EXPECT_EQ(large, 0xfedcba9876543210u);
  EXPECT_TRUE(std::signbit(zero));
  EXPECT_EQ(real, 1.5F);
  EXPECT_EQ(text, "");
  EXPECT_TRUE(reader.atEnd());
  EXPECT_THROW(reader.number(small), InputError);
}

}  // namespace
}  // namespace boresight::sessions
