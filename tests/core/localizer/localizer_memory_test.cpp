// SPDX-License-Identifier: Apache-2.0
// A run uses one block of exactly the required bytes and no other memory.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>

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
    const auto is_canary = [](std::byte value) { return value == kCanary; };
    return std::all_of(memory_.begin(), memory_.begin() + static_cast<std::ptrdiff_t>(first_),
                       is_canary) &&
           std::all_of(memory_.begin() + static_cast<std::ptrdiff_t>(first_ + bytes_),
                       memory_.end(), is_canary);
  }

 private:
  static constexpr std::size_t kFence = 65536;
  static constexpr std::byte kCanary{0xC7};
  std::vector<std::byte> memory_;
  std::size_t first_;
  std::size_t bytes_;
};

struct Variant {
  const char* name;
  LocalizerOptions options;
};

std::vector<Variant> variants() {
  std::vector<Variant> variants = {{"default", {}},           {"paper", paperProfile()},
                                   {"pyramid", {}},           {"unrolled", {}},
                                   {"unrefined", {}},         {"fixed", {}},
                                   {"equalized locally", {}}, {"without search", {}}};
  variants[7].options.search.enabled = false;
  variants[2].options.loop.coarse_size_px = 128;
  variants[3].options.loop.max_rolled_hypotheses = 1;
  variants[4].options.refinement.enabled = false;
  variants[5].options.edges.thresholds = CannyThresholds::kAbsolute;
  variants[5].options.edges.gaussian_sigma_px = 0.0;
  variants[6].options.edges.equalization = Equalization::kClahe;
  variants[6].options.edges.gaussian_sigma_px = 8.0;
  return variants;
}

TEST(LocalizerMemory, UsedBytes_EqualTheRequiredBytes) {
  Mask mask(512, 512);
  mask.fill(0, 0, 40, 40);
  for (const bool distorted : {false, true}) {
    for (const bool masked : {false, true}) {
      Case scene = stationCase(1, distorted);
      if (masked) scene.ignore = &mask.bits;
      for (const Variant& variant : variants()) {
        SCOPED_TRACE(variant.name);
        std::size_t bytes = 0;
        ASSERT_EQ(requiredBytes(sizeOf(scene.problem()), variant.options, bytes), Status::kOk);
        Fenced enough(bytes);
        Localizer localizer(scene.problem(), variant.options, enough.block());
        EXPECT_EQ(localizer.status(), Status::kOk);
        EXPECT_EQ(localizer.highWaterBytes(), bytes);
        if (distorted && masked) {
          while (!localizer.step().finished) {
          }
          EXPECT_EQ(localizer.highWaterBytes(), bytes);
        }
        EXPECT_TRUE(enough.intact());

        Fenced little(bytes - Arena::kAlignment);
        Localizer starved(scene.problem(), variant.options, little.block());
        EXPECT_EQ(starved.status(), Status::kArenaTooSmall);
        EXPECT_TRUE(starved.step().finished);
        EXPECT_EQ(starved.workspace().fault, Status::kArenaTooSmall);
        EXPECT_TRUE(little.intact());
      }
    }
  }
}

TEST(LocalizerMemory, BlockTooSmall_IsReportedAndNotOverrun) {
  const Case scene = stationCase(1, true);
  std::size_t bytes = 0;
  ASSERT_EQ(requiredBytes(sizeOf(scene.problem()), {}, bytes), Status::kOk);
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    const std::size_t few =
        i < 20 ? static_cast<std::size_t>(i) : random.below(static_cast<std::uint32_t>(bytes));
    Fenced little(few);
    Localizer localizer(scene.problem(), {}, little.block());
    EXPECT_EQ(localizer.status(), Status::kArenaTooSmall) << few;
    EXPECT_TRUE(localizer.step().finished);
    EXPECT_TRUE(little.intact()) << few;
  }
}

TEST(LocalizerMemory, UnalignedBlocks_Work) {
  const Case scene = stationCase(1);
  std::size_t bytes = 0;
  ASSERT_EQ(requiredBytes(sizeOf(scene.problem()), {}, bytes), Status::kOk);
  OwnedRun aligned(scene.problem(), {});
  aligned.finish();
  for (const std::size_t shift : {1u, 4u, 8u, 15u}) {
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
    EXPECT_EQ(localizer.digest(), aligned.localizer.digest());
  }
}

TEST(LocalizerMemory, RequiredBytes_GrowWithTheProblem) {
  Random random(5);
  for (int i = 0; i < 12; ++i) {
    ProblemSize size;
    size.width = 1 + static_cast<int>(random.below(1500));
    size.height = 1 + static_cast<int>(random.below(1500));
    size.vertices = 1 + static_cast<int>(random.below(20000));
    size.faces = 1 + static_cast<int>(random.below(40000));
    LocalizerOptions options;
    std::size_t bytes = 0;
    ASSERT_EQ(requiredBytes(size, options, bytes), Status::kOk);
    EXPECT_EQ(bytes % Arena::kAlignment, 0u);
    EXPECT_GT(bytes, static_cast<std::size_t>(size.faces) * 12);
    std::size_t more = 0;
    size.width += 200;
    size.faces += 1000;
    ASSERT_EQ(requiredBytes(size, options, more), Status::kOk);
    EXPECT_GE(more, bytes);
  }
}

/// Bytes of the caller's inputs.
std::size_t inputBytes(const ProblemSize& size) {
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  const std::size_t mask = size.ignore ? pixels / 8 : 0;
  return pixels + mask + static_cast<std::size_t>(size.vertices) * sizeof(Eigen::Vector3f) +
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
    for (const LocalizerOptions& options : {defaultProfile(), paperProfile()}) {
      std::size_t bytes = 0;
      ASSERT_EQ(requiredBytes(size, options, bytes), Status::kOk);
      EXPECT_LE(bytes + inputBytes(size), 10'000'000u);
    }
  }
}

TEST(LocalizerMemory, IsDividedAmongTheStages) {
  const Case scene = stationCase(1, true);
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name);
    MemoryUse use;
    ASSERT_EQ(requiredMemory(sizeOf(scene.problem()), variant.options, 1, use), Status::kOk);
    std::size_t most = use.kept + use.construction;
    for (int i = 0; i < static_cast<int>(Stage::kFinished); ++i) {
      const auto stage = static_cast<Stage>(i);
      EXPECT_EQ(use.of(stage) == use.kept,
                stage == Stage::kSearch && !variant.options.search.enabled)
          << stageText(stage);
      most = std::max(most, use.of(stage));
    }
    EXPECT_EQ(use.total(), most);
    EXPECT_EQ(use.of(Stage::kFinished), use.kept);
    OwnedRun run(scene.problem(), variant.options);
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
  const EdgeMap& edges = run.localizer.workspace().edges;
  std::vector<std::byte> memory(std::size_t{1} << 21);
  Arena arena(memory);
  EdgeMap expected;
  ASSERT_EQ(detectEdges(scene.problem().image, nullptr, options.edges, arena, expected),
            Status::kOk);
  for (std::size_t level = 0; level < expected.level.size(); ++level) {
    EXPECT_TRUE(std::equal(expected.level[level].words.begin(), expected.level[level].words.end(),
                           edges.level[level].words.begin(), edges.level[level].words.end()));
  }
  run.finish();
  for (const std::size_t level : {0u, 3u}) {
    EXPECT_TRUE(edges.level[level].words.empty());
    EXPECT_EQ(edges.level[level].width, 0);
  }
  for (const std::size_t level : {1u, 2u}) {
    EXPECT_TRUE(std::equal(expected.level[level].words.begin(), expected.level[level].words.end(),
                           edges.level[level].words.begin(), edges.level[level].words.end()));
  }
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
    for (const Variant& variant : variants()) {
      SCOPED_TRACE(variant.name);
      std::vector<std::byte> memory = blockFor(scene.problem(), variant.options);
      const LocalizationProblem problem = scene.problem();
      const int before = heapAllocations();
      Localizer localizer(problem, variant.options, memory);
      while (!localizer.step().finished) {
      }
      const Status restarted = localizer.restart(problem, variant.options);
      std::size_t bytes = 0;
      const Status sized = requiredBytes(sizeOf(problem), variant.options, bytes);
      const auto digest = localizer.digest();
      const int after = heapAllocations();
      EXPECT_EQ(after, before);
      EXPECT_EQ(restarted, Status::kOk);
      EXPECT_EQ(sized, Status::kOk);
      EXPECT_EQ(digest, localizer.digest());
    }
  }
}

}  // namespace
}  // namespace boresight::test
