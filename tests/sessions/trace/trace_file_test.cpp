// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/trace_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/digest.h"
#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/runner.h"
#include "sessions/trace/archive.h"
#include "sessions/trace/trace_fields.h"
#include "tests/support/example_run.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::exampleTrace;

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
  trace.competing_poses = {{}, {{Eigen::Quaterniond::Identity(), {0.1, 0.2, 0.3}}, 0.5, 3.5}};
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

TEST(TraceFile, RefusesOtherFilesAndVersions) {
  const test::TemporaryFolder folder;
  saveTrace(folder / "run.trace", {});
  std::string later = folder.read("run.trace"), earlier = later;
  ++later[11];
  --earlier[11];
  folder.write("picture.trace", std::string_view("PNG and so on"));
  folder.write("short.trace", std::string_view("BSTRACE\n"));
  folder.write("later.trace", later);
  folder.write("earlier.trace", earlier);
  for (const auto& [name, refusal] :
       {std::pair<std::string, std::string>("picture", "not a trace"),
        {"short", "truncated"},
        {"missing", "missing.trace"},
        {"later", "later.trace: version: " + std::to_string(later[11])},
        {"earlier", "earlier.trace: version: " + std::to_string(earlier[11])}})
    EXPECT_THAT(folder.message([&] { loadTrace(folder / (name + ".trace")); }), HasSubstr(refusal));
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

TEST(TraceFile, EmptyTrace_IsKeptAndRefusedWithMoreBytes) {
  const test::TemporaryFolder folder;
  saveTrace(folder / "run.trace", {});
  std::string bytes = folder.read("run.trace");
  bytes.resize(bytes.size() - kChecksumBytes);
  EXPECT_EQ(sealed(bytes), folder.read("run.trace"));
  EXPECT_EQ(bytesOf(loadTrace(folder / "run.trace")), bytesOf(LocalizationTrace{}));
  folder.write("long.trace", sealed(bytes + "extra"));
  EXPECT_THAT(folder.message([&] { loadTrace(folder / "long.trace"); }), HasSubstr("more bytes"));
}

template <class T>
void expectKept(T value) {
  ArchiveWriter writer;
  writer.number(value);
  writer.text("");
  ArchiveReader reader("memory", writer.bytes());
  T read = 1;
  std::string text = "x";
  reader.number(read);
  reader.text(text);
  EXPECT_EQ(read, value);
  EXPECT_EQ(std::signbit(static_cast<double>(read)), std::signbit(static_cast<double>(value)));
  EXPECT_EQ(text, "");
  EXPECT_TRUE(reader.atEnd());
  EXPECT_THROW(reader.number(read), InputError);
}

TEST(Archive, RoundTripsExtremes) {
  expectKept(std::int16_t{-32768});
  expectKept(std::int8_t{-1});
  expectKept(std::uint64_t{0xfedcba9876543210u});
  expectKept(-0.0);
  expectKept(1.5F);
  ArchiveWriter writer;
  writer.number(std::int16_t{-32768});
  EXPECT_EQ(writer.bytes()[0], 0x80);
}

}  // namespace
}  // namespace boresight::sessions
