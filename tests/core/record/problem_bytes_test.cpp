// SPDX-License-Identifier: Apache-2.0
// decodeProblem restores the output of encodeProblem; other bytes are refused or give a problem
// that runs.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"
#include "core/record/problem_bytes.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const LocalizationProblem& problem, const LocalizerOptions& options) {
  Bytes bytes(encodeProblem(problem, options, {}));
  EXPECT_EQ(encodeProblem(problem, options, bytes), bytes.size());
  return bytes;
}

/// The checksum computed again, so that a change passes it.
Bytes resealed(Bytes bytes) {
  Sha256 sha;
  sha.update(std::span<const std::uint8_t>(bytes).first(bytes.size() - 32));
  const auto digest = sha.digest();
  std::copy(digest.begin(), digest.end(), bytes.end() - 32);
  return bytes;
}

/// Decoded into memory of its own; the bytes are copied to a block of just their size, so that a
/// sanitizer sees every read beyond it.
struct Decoded {
  std::vector<std::byte> memory;
  Arena arena;
  LocalizationProblem problem;
  LocalizerOptions options;
  ProblemCheck check;

  explicit Decoded(const Bytes& bytes, std::size_t memory_bytes = 1 << 20)
      : memory(memory_bytes), arena(memory) {
    const Bytes copy(bytes.begin(), bytes.end());
    check = decodeProblem(copy, arena, problem, options);
  }
  ProblemFault fault() const { return check.fault; }
};

std::string inputDigest(const LocalizationProblem& problem, const LocalizerOptions& options) {
  DigestWriter writer;
  digestOptions(options, writer);
  digestProblem(problem, writer);
  return hexText(writer.digest()).data();
}

/// Every option another than its default, within its range.
LocalizerOptions unusualOptions() {
  LocalizerOptions options;
  LocalizerOptions::visitFields(options, [](const OptionInfo& info, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    const double value = static_cast<double>(field);
    field = static_cast<Field>(value < info.maximum ? std::min(value + 1.0, info.maximum)
                                                    : info.minimum);
  });
  return options;
}

struct Problem {
  Case scene = occludedCase(4);
  Mask mask{512, 512};
  LocalizationProblem problem = scene.problem();
  LocalizerOptions options = unusualOptions();

  Problem() {
    mask.fill(3, 5, 200, 100);
    mask.fill(500, 7, 512, 8);
    problem.ignore = &mask.bits;
  }
  Bytes bytes() const { return encoded(problem, options); }
};

TEST(ProblemBytes, Problem_RoundTrips) {
  for (const bool distorted : {false, true}) {
    const Case scene = stationCase(4, distorted);
    const LocalizationProblem problem = scene.problem();
    Decoded decoded(encoded(problem, defaultProfile()));
    ASSERT_EQ(decoded.fault(), ProblemFault::kNone);
    EXPECT_EQ(decoded.problem.image.data, nullptr);
    EXPECT_EQ(decoded.problem.camera.valid_radius, problem.camera.valid_radius);
    decoded.problem.image = problem.image;
    EXPECT_EQ(inputDigest(decoded.problem, decoded.options),
              inputDigest(problem, defaultProfile()));
  }
}

TEST(ProblemBytes, MaskPartsAndEveryOption_RoundTrip) {
  Problem unusual;
  ScenePart& part = unusual.scene.solid.parts[1];
  EXPECT_FALSE(part.match);
  for (const bool fixed : {false, true}) {
    part.fixed_to_camera = fixed;
    Decoded decoded(unusual.bytes());
    ASSERT_EQ(decoded.fault(), ProblemFault::kNone);
    EXPECT_TRUE(std::ranges::equal(decoded.problem.mesh.parts, unusual.problem.mesh.parts));
    ASSERT_NE(decoded.problem.ignore, nullptr);
    decoded.problem.image = unusual.problem.image;
    EXPECT_EQ(inputDigest(decoded.problem, decoded.options),
              inputDigest(unusual.problem, unusual.options));
    EXPECT_EQ(encoded(decoded.problem, decoded.options), unusual.bytes());
  }
  part.match = true;  // which a part that is fixed to the camera cannot be
  const Decoded decoded(unusual.bytes());
  EXPECT_TRUE(decoded.problem.mesh.parts[1].fixed_to_camera);
  EXPECT_FALSE(decoded.problem.mesh.parts[1].match);
}

TEST(ProblemBytes, Header_FollowsTheFormat) {
  const Case scene = stationCase(4);
  const Bytes bytes = encoded(scene.problem(), defaultProfile());
  const auto size = static_cast<std::uint32_t>(bytes.size());
  Bytes head = {'B', 'O', 'R', 'S', 'I', 'G', 'H', 'T', 0, 0, 0, kProblemVersion};
  for (int shift = 24; shift >= 0; shift -= 8)
    head.push_back(static_cast<std::uint8_t>(size >> shift));
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  EXPECT_EQ(resealed(bytes), bytes);
}

TEST(ProblemBytes, NothingIsWrittenBeyondASmallerBlock) {
  const Problem unusual;
  const Bytes whole = unusual.bytes();
  for (const std::size_t room : {std::size_t{0}, std::size_t{1}, whole.size() - 1}) {
    Bytes out(room + 64, 0xA5);
    EXPECT_EQ(encodeProblem(unusual.problem, unusual.options, std::span(out).first(room)),
              whole.size());
    EXPECT_EQ(std::count(out.begin() + static_cast<std::ptrdiff_t>(room), out.end(), 0xA5), 64);
  }
}

TEST(ProblemBytes, EveryTruncationIsRefused) {
  const Bytes bytes = Problem().bytes();
  for (std::size_t size = 0; size < bytes.size(); size += size < 600 ? 1 : 331) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(Decoded(cut).fault(), size < 16 ? ProblemFault::kNotAProblem : ProblemFault::kSize)
        << size;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(Decoded(longer).fault(), ProblemFault::kSize);
}

TEST(ProblemBytes, EveryFlippedBitIsRefused) {
  const Bytes bytes = Problem().bytes();
  Random random(5);
  for (std::size_t at = 0; at < bytes.size(); at += at < 400 ? 1 : 1 + random.below(500)) {
    Bytes damaged = bytes;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ (1u << random.below(8)));
    const ProblemFault expected = at < 8    ? ProblemFault::kNotAProblem
                                  : at < 12 ? ProblemFault::kVersion
                                  : at < 16 ? ProblemFault::kSize
                                            : ProblemFault::kChecksum;
    EXPECT_EQ(Decoded(damaged).fault(), expected) << at;
  }
}

/// Begin of the first option's name, and its end.
constexpr std::size_t kFirstOption = 16 + 4;

TEST(ProblemBytes, UnknownOrMissingOptions_AreRefused) {
  const Bytes bytes = Problem().bytes();
  const auto faultWith = [&bytes](std::size_t at, std::uint8_t value) {
    Bytes changed = bytes;
    changed[at] = value;
    return Decoded(resealed(changed)).check;
  };
  const ProblemCheck renamed = faultWith(kFirstOption + 1, 'X');
  EXPECT_EQ(renamed.fault, ProblemFault::kOption);
  const std::size_t length = bytes[kFirstOption];
  const std::string name(bytes.begin() + kFirstOption + 1,
                         bytes.begin() + static_cast<std::ptrdiff_t>(kFirstOption + 1 + length));
  ASSERT_NE(renamed.option, nullptr);
  EXPECT_EQ(renamed.option, name);
  EXPECT_EQ(faultWith(kFirstOption + 1 + length, 9).fault, ProblemFault::kOption);  // its kind
  EXPECT_EQ(faultWith(kFirstOption + 2 + length, 0x7f).fault, ProblemFault::kOption);
  EXPECT_EQ(faultWith(19, static_cast<std::uint8_t>(bytes[19] + 1)).fault,
            ProblemFault::kOption);  // one more
  EXPECT_EQ(faultWith(19, static_cast<std::uint8_t>(bytes[19] - 1)).fault, ProblemFault::kOption);
}

TEST(ProblemBytes, InvalidValues_AreRefused) {
  const auto faultOf = [](auto&& change) {
    Problem unusual;
    change(unusual);
    return Decoded(unusual.bytes()).fault();
  };
  EXPECT_EQ(faultOf([](Problem& p) { p.options.loop.max_iterations = 1000; }),
            ProblemFault::kOption);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.camera.fx = -1.0; }), ProblemFault::kCamera);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.camera.width = 1 << 30; }), ProblemFault::kCamera);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.camera_from_station_seed.rotation.w() = 3.0; }),
            ProblemFault::kPose);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.uncertainty.rotation_rad.x() = -1.0; }),
            ProblemFault::kPose);
  EXPECT_EQ(faultOf([](Problem& p) { p.scene.solid.faces[2].vertex[1] = 1 << 20; }),
            ProblemFault::kMesh);
  EXPECT_EQ(faultOf([](Problem& p) { p.scene.solid.part_of_face[0] = 2; }), ProblemFault::kMesh);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.mesh.faces = {}; }), ProblemFault::kMesh);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.camera.height = 600; }), ProblemFault::kContent);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.camera.height = 500; }), ProblemFault::kContent);
  EXPECT_EQ(faultOf([](Problem& p) { p.problem.camera.width = 500; }), ProblemFault::kIgnore);
}

TEST(ProblemBytes, SmallArena_IsReported) {
  const Bytes bytes = Problem().bytes();
  const std::size_t enough = Decoded(bytes).arena.used();
  for (std::size_t size = 16; size < enough; size += 976) {
    EXPECT_EQ(Decoded(bytes, size).fault(), ProblemFault::kArenaTooSmall) << size;
  }
  EXPECT_EQ(Decoded(bytes, enough).fault(), ProblemFault::kNone);
}

TEST(ProblemBytes, DamageWithAValidChecksum_IsRefusedOrRuns) {
  const Problem unusual;
  const Bytes bytes = unusual.bytes();
  Random random(11);
  int accepted = 0;
  for (int round = 0; round < 1500; ++round) {
    Bytes damaged = bytes;
    // Where counts and options are, rather than in the long lists behind them.
    const std::uint32_t reach =
        random.below(4) != 0 ? 3200 : static_cast<std::uint32_t>(bytes.size() - 32);
    for (std::uint32_t k = 0; k <= random.below(3); ++k)
      damaged[16 + random.below(reach - 16)] = static_cast<std::uint8_t>(random.next() >> 24);
    Decoded decoded(resealed(damaged));
    if (decoded.fault() != ProblemFault::kNone) continue;
    ++accepted;
    EXPECT_EQ(validateMesh(decoded.problem.mesh), Status::kOk);
    EXPECT_EQ(firstInvalidOption(decoded.options), nullptr);
    EXPECT_GT(decoded.problem.camera.valid_radius, 0.0);
    EXPECT_EQ(encoded(decoded.problem, decoded.options), resealed(damaged));
  }
  EXPECT_GT(accepted, 50);
  EXPECT_LT(accepted, 1500 - 200);
}

TEST(ProblemBytes, EveryFaultHasAText) {
  for (int fault = 0; fault <= static_cast<int>(ProblemFault::kArenaTooSmall); ++fault)
    EXPECT_STRNE(problemFaultText(static_cast<ProblemFault>(fault)), "unknown");
}

}  // namespace
}  // namespace boresight::test
