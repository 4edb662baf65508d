// SPDX-License-Identifier: Apache-2.0
// A run uses one block of exactly the required bytes and no other memory.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/heap_count.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// A block between two fields of known bytes.
class Fenced {
 public:
  explicit Fenced(std::size_t bytes, std::size_t shift = 0)
      : memory_(kFence + shift + bytes + kFence, kCanary), first_(kFence + shift), bytes_(bytes) {}
  std::span<std::byte> block() { return std::span(memory_).subspan(first_, bytes_); }
  bool intact() const {
    const auto changed = [](std::byte value) { return value != kCanary; };
    const std::span<const std::byte> all(memory_);
    return std::ranges::none_of(all.first(first_), changed) &&
           std::ranges::none_of(all.subspan(first_ + bytes_), changed);
  }

 private:
  static constexpr std::size_t kFence = 65536;
  static constexpr std::byte kCanary{0xC7};
  std::vector<std::byte> memory_;
  std::size_t first_;
  std::size_t bytes_;
};

std::map<std::string, LocalizerOptions> variants() {
  std::map<std::string, LocalizerOptions> all = {
      {"default", {}}, {"paper", paperProfile()}, {"without search", withoutSearch()}};
  all["pyramid"].loop.coarse_size_px = 128;
  all["unrolled"].loop.max_rolled_hypotheses = 1;
  all["unrefined"].refinement.enabled = false;
  all["fixed"].edges.thresholds = CannyThresholds::kAbsolute;
  all["fixed"].edges.gaussian_sigma_px = 0.0;
  all["equalized locally"].edges.equalization = Equalization::kClahe;
  all["equalized locally"].edges.gaussian_sigma_px = 8.0;
  return all;
}

/// Reported and not overrun; the fault in the workspace.
Status expectTooSmall(const LocalizationProblem& problem, const LocalizerOptions& options,
                      std::size_t bytes) {
  Fenced little(bytes);
  Localizer starved(problem, options, little.block());
  EXPECT_EQ(starved.status(), Status::kArenaTooSmall) << bytes;
  EXPECT_TRUE(starved.step().finished);
  EXPECT_TRUE(little.intact()) << bytes;
  return starved.workspace().fault;
}

TEST(LocalizerMemory, UsedBytes_EqualTheRequiredBytes) {
  Mask mask(512, 512);
  mask.fill(0, 0, 40, 40);
  for (const bool distorted : {false, true}) {
    for (const bool masked : {false, true}) {
      Case scene = stationCase(1, distorted);
      if (masked) scene.ignore = &mask.bits;
      for (const auto& [name, options] : variants()) {
        SCOPED_TRACE(name);
        const std::size_t bytes = blockFor(scene.problem(), options).size();
        Fenced enough(bytes);
        Localizer localizer(scene.problem(), options, enough.block());
        EXPECT_EQ(localizer.status(), Status::kOk);
        EXPECT_EQ(localizer.highWaterBytes(), bytes);
        if (distorted && masked) {
          while (!localizer.step().finished) {
          }
          EXPECT_EQ(localizer.highWaterBytes(), bytes);
        }
        EXPECT_TRUE(enough.intact());
        EXPECT_EQ(expectTooSmall(scene.problem(), options, bytes - Arena::kAlignment),
                  Status::kArenaTooSmall);
      }
    }
  }
}

TEST(LocalizerMemory, BlockTooSmall_IsReportedAndNotOverrun) {
  const Case scene = stationCase(1, true);
  const auto bytes = static_cast<std::uint32_t>(blockFor(scene.problem(), {}).size());
  Random random(11);
  for (std::uint32_t i = 0; i < 60; ++i)
    (void)expectTooSmall(scene.problem(), {}, i < 20 ? i : random.below(bytes));
}

/// The block holds the fence's bytes before the run.
TEST(LocalizerMemory, DigestDoesNotDependOnPlaceOrContentOfTheBlock) {
  const Case scene = stationCase(1);
  const std::size_t bytes = blockFor(scene.problem(), {}).size();
  const Digest expected = digestOf(scene.problem(), {});
  for (const std::size_t shift : {1u, 4u, 8u, 15u, 16u, 4096u + 48u}) {
    Fenced odd(bytes + Arena::kAlignment, shift);
    Localizer localizer(scene.problem(), {}, odd.block());
    ASSERT_EQ(localizer.status(), Status::kOk);
    while (!localizer.step().finished) {
    }
    EXPECT_TRUE(odd.intact());
    const auto place =
        reinterpret_cast<std::uintptr_t>(localizer.workspace().iteration->matches.matches.data());
    EXPECT_NE(place, 0u);
    EXPECT_EQ(place % Arena::kAlignment, 0u);
    EXPECT_EQ(localizer.digest(), expected);
  }
}

std::size_t required(const ProblemSize& size, const LocalizerOptions& options = {}) {
  std::size_t bytes = 0;
  EXPECT_EQ(requiredBytes(size, options, bytes), Status::kOk);
  return bytes;
}

TEST(LocalizerMemory, RequiredBytes_GrowWithTheProblem) {
  Random random(5);
  for (int i = 0; i < 12; ++i) {
    ProblemSize size;
    size.width = 1 + static_cast<int>(random.below(1500));
    size.height = 1 + static_cast<int>(random.below(1500));
    size.vertices = 1 + static_cast<int>(random.below(20000));
    size.faces = 1 + static_cast<int>(random.below(40000));
    const std::size_t bytes = required(size);
    EXPECT_EQ(bytes % Arena::kAlignment, 0u);
    EXPECT_GT(bytes, static_cast<std::size_t>(size.faces) * 12);
    size.width += 200;
    size.faces += 1000;
    EXPECT_GE(required(size), bytes);
  }
}

/// Bytes of the caller's inputs.
std::size_t inputBytes(const ProblemSize& size) {
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  return pixels + static_cast<std::size_t>(size.vertices) * sizeof(Eigen::Vector3f) +
         static_cast<std::size_t>(size.faces) *
             (bytesPerFace(static_cast<std::size_t>(size.vertices)) + sizeof(std::uint16_t)) +
         static_cast<std::size_t>(size.parts) * sizeof(ScenePart);
}

TEST(LocalizerMemory, FitsTheFlightBudget) {
  ProblemSize size;
  size.width = size.height = 2048;
  size.faces = 60000;
  size.vertices = size.faces / 2 + 2;  // a closed surface's, or a sphere's in the end
  for (const CameraModel model :
       {CameraModel::kPinhole, CameraModel::kBrownConrady, CameraModel::kKannalaBrandt}) {
    size.model = model;
    for (const LocalizerOptions& options : {defaultProfile(), paperProfile()})
      EXPECT_LE(required(size, options) + inputBytes(size), 10'000'000u);
  }
}

TEST(LocalizerMemory, IsDividedAmongTheStages) {
  const Case scene = stationCase(1, true);
  for (const auto& [name, options] : variants()) {
    SCOPED_TRACE(name);
    MemoryUse use;
    ASSERT_EQ(requiredMemory(sizeOf(scene.problem()), options, 1, use), Status::kOk);
    std::size_t most = use.kept + use.construction;
    for (int i = 0; i < static_cast<int>(Stage::kFinished); ++i) {
      const auto stage = static_cast<Stage>(i);
      EXPECT_EQ(use.of(stage) == use.kept, stage == Stage::kSearch && !options.search.enabled)
          << stageText(stage);
      most = std::max(most, use.of(stage));
    }
    EXPECT_EQ(use.total(), most);
    EXPECT_EQ(use.of(Stage::kFinished), use.kept);
    const OwnedRun run(scene.problem(), options);
    EXPECT_EQ(run.localizer.memoryUse().total(), most);
    EXPECT_EQ(run.localizer.memoryUse().stage, use.stage);
  }
}

TEST(LocalizerMemory, EdgeMapsOfUnmatchedLevelsLastUntilTheFirstRender) {
  const Case scene = stationCase(1);
  LocalizerOptions options;
  options.loop.coarse_size_px = 128;  // levels 2 and 1 are rendered
  OwnedRun run(scene.problem(), options);
  while (!run.localizer.step().stage_complete) {
  }
  const EdgeMap& edges = run.workspace.edges;
  std::vector<std::byte> memory(std::size_t{1} << 21);
  Arena arena(memory);
  EdgeMap expected;
  ASSERT_EQ(detectEdges(scene.problem().image, nullptr, options.edges, arena, expected),
            Status::kOk);
  const auto isHeld = [&](std::size_t level) {
    return std::ranges::equal(expected.level[level].words, edges.level[level].words);
  };
  for (std::size_t level = 0; level < expected.level.size(); ++level) EXPECT_TRUE(isHeld(level));
  run.finish();
  for (const std::size_t level : {0u, 3u}) {
    EXPECT_TRUE(edges.level[level].words.empty());
    EXPECT_EQ(edges.level[level].width, 0);
  }
  EXPECT_TRUE(isHeld(1));
  EXPECT_TRUE(isHeld(2));
}

TEST(LocalizerMemory, NothingIsAllocated) {
  {
    // The counter registers all of them.
    const int before = heapAllocations();
    void* volatile block = std::malloc(10);
    std::free(block);
    EXPECT_EQ(heapAllocations(), before + 1);
    const auto owned = std::make_unique<double[]>(1000);
    EXPECT_EQ(heapAllocations(), before + 2);
    const Eigen::VectorXd vector = Eigen::VectorXd::Zero(1000 + before % 2);
    EXPECT_EQ(heapAllocations(), before + 3);
    EXPECT_EQ(vector[3], owned[3]);
  }
  for (const bool distorted : {false, true}) {
    Mask mask(512, 512);
    mask.fill(30, 30, 90, 90);
    Case scene = stationCase(3, distorted);
    scene.ignore = &mask.bits;
    for (const auto& [name, options] : variants()) {
      SCOPED_TRACE(name);
      const LocalizationProblem problem = scene.problem();
      std::vector<std::byte> memory = blockFor(problem, options);
      const int before = heapAllocations();
      Localizer localizer(problem, options, memory);
      while (!localizer.step().finished) {
      }
      const Status restarted = localizer.restart(problem, options);
      std::size_t bytes = 0;
      const Status sized = requiredBytes(sizeOf(problem), options, bytes);
      const auto digest = localizer.digest();
      EXPECT_EQ(heapAllocations(), before);
      EXPECT_EQ(restarted, Status::kOk);
      EXPECT_EQ(sized, Status::kOk);
      EXPECT_EQ(digest, localizer.digest());
    }
  }
}

}  // namespace
}  // namespace boresight::test
