// SPDX-License-Identifier: Apache-2.0
// Other options from one iteration on.
#include <algorithm>
#include <functional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/localizer.h"
#include "tests/core/localizer/random_options.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/all_cases.h"

namespace boresight::test {
namespace {

/// Results of a run by iteration.
struct Course {
  std::vector<Pose> poses;  ///< after each iteration
  Digest digest{};
  LocalizationStatus status = LocalizationStatus::kRunning;
  Pose camera_from_station;
  std::size_t used_bytes = 0;
};

/// Runs, and calls `between` with the number of iterations done whenever it is between two.
Course courseOf(const LocalizationProblem& problem, const LocalizerOptions& options,
                const std::function<void(Localizer&, int)>& between) {
  OwnedRun run(problem, options);
  EXPECT_EQ(run.localizer.status(), Status::kOk);
  std::vector<Pose> poses;
  for (bool finished = false; !finished;) {
    if (run.localizer.isBetweenIterations()) between(run.localizer, static_cast<int>(poses.size()));
    const StepReport report = run.localizer.step();
    finished = report.finished;
    if (report.iteration_complete) poses.push_back(run.workspace.iteration->camera_from_station);
  }
  return {poses, run.localizer.digest(), run.workspace.status, run.workspace.camera_from_station,
          run.localizer.highWaterBytes()};
}

Course courseWithChange(const LocalizationProblem& problem, const LocalizerOptions& before,
                        const LocalizerOptions& after, int at) {
  return courseOf(problem, before, [&](Localizer& localizer, int done) {
    if (done != at) return;
    EXPECT_TRUE(localizer.changeOptions(after));
    EXPECT_TRUE(sameOptions(localizer.options(), after));
  });
}

Course plainCourse(const LocalizationProblem& problem, const LocalizerOptions& options) {
  return courseOf(problem, options, [](Localizer&, int) {});
}

/// `wanted`, with the fixed options of `base`.
LocalizerOptions changeable(const LocalizerOptions& base, LocalizerOptions wanted) {
  wanted.edges = base.edges;
  wanted.render = base.render;
  wanted.templates.count = base.templates.count;
  wanted.refinement.enabled = base.refinement.enabled;
  wanted.refinement.max_samples = base.refinement.max_samples;
  wanted.loop.coarse_size_px = base.loop.coarse_size_px;
  wanted.loop.halved_size_px = base.loop.halved_size_px;
  wanted.loop.max_rolled_hypotheses = base.loop.max_rolled_hypotheses;
  wanted.loop.correction_point = base.loop.correction_point;
  wanted.search = base.search;
  return wanted;
}

TEST(LocalizerChange, SameOptions_ChangeNoBit) {
  const Case scene = stationCase(4);
  int asked = 0;
  const Course course =
      courseOf(scene.problem(), withoutSearch(), [&asked](Localizer& localizer, int) {
        EXPECT_TRUE(localizer.changeOptions(withoutSearch()));
        ++asked;
      });
  EXPECT_GT(asked, 3);
  EXPECT_EQ(course.digest, digestOf(scene.problem(), withoutSearch()));
}

TEST(LocalizerChange, Digest_DependsOnTheChangedOptionsAndTheirIteration) {
  const Case scene = stationCase(4);
  LocalizerOptions other = withoutSearch();
  other.loop.render_again_px *= 2.0;
  other.loop.leave_factor *= 2.0;
  const Course plain = plainCourse(scene.problem(), withoutSearch());
  std::set<Digest> digests = {plain.digest};
  for (int at = 0; at < static_cast<int>(plain.poses.size()); ++at) {
    const Course course = courseWithChange(scene.problem(), withoutSearch(), other, at);
    EXPECT_TRUE(std::equal(plain.poses.begin(), plain.poses.begin() + at, course.poses.begin()));
    EXPECT_TRUE(digests.insert(course.digest).second) << "at " << at;
    EXPECT_EQ(courseWithChange(scene.problem(), withoutSearch(), other, at).digest, course.digest);
  }
}

/// Oracle of a change: before the first iteration the run must equal a run with the new options
/// from the start.
TEST(LocalizerChange, ChangeBeforeTheFirstIteration_EqualsARunWithTheNewOptions) {
  Random random(5);
  int changed = 0;
  const int trials = allCases() ? 40 : 16;
  for (int i = 0; i < trials; ++i) {
    SCOPED_TRACE(i);
    const Case scene = smallCase(static_cast<std::uint64_t>(i));
    const LocalizerOptions before = randomOptions(random);
    const LocalizerOptions after = changeable(before, randomOptions(random));
    const Course course = courseWithChange(scene.problem(), before, after, 0);
    const Course expected = plainCourse(scene.problem(), after);
    EXPECT_EQ(course.poses, expected.poses);
    EXPECT_EQ(course.status, expected.status);
    if (plainCourse(scene.problem(), before).poses != expected.poses) ++changed;
  }
  EXPECT_GT(changed, trials / 2) << "too few changes have an effect";
}

TEST(LocalizerChange, AnyChangeAtAnyIteration_EndsWithinTheMemory) {
  Random random(6);
  for (int i = 0; i < (allCases() ? 60 : 24); ++i) {
    SCOPED_TRACE(i);
    const Case scene = smallCase(static_cast<std::uint64_t>(i));
    const LocalizerOptions before = randomOptions(random);
    const Course course = courseOf(scene.problem(), before, [&](Localizer& localizer, int) {
      if (random.below(2) != 0) return;
      EXPECT_TRUE(localizer.changeOptions(changeable(before, randomOptions(random))));
    });
    EXPECT_NE(course.status, LocalizationStatus::kRunning);
    EXPECT_NE(course.status, LocalizationStatus::kFault);
    EXPECT_TRUE(course.camera_from_station.isFinite());
    EXPECT_EQ(course.used_bytes, blockFor(scene.problem(), before).size());
  }
}

TEST(LocalizerChange, FixedOptions_AreRefused) {
  const Case scene = stationCase(4);
  int refused = 0;
  int accepted = 0;
  const Course course =
      courseOf(scene.problem(), defaultProfile(), [&](Localizer& localizer, int done) {
        if (done != 1) return;
        LocalizerOptions options = defaultProfile();
        LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
          using Field = std::remove_reference_t<decltype(field)>;
          const Field kept = field;
          const bool at_most = static_cast<double>(field) >= info.maximum;
          field = static_cast<Field>(at_most ? info.minimum : info.maximum);
          const LocalizerOptions expected = changeable(defaultProfile(), options);
          const bool fixed = !sameOptions(expected, options);
          const char* named = firstFixedOption(defaultProfile(), options);
          EXPECT_EQ(named != nullptr, fixed) << info.name;
          if (fixed) {
            EXPECT_STREQ(named, info.name);
            EXPECT_FALSE(localizer.changeOptions(options)) << info.name;
            ++refused;
          } else {
            ++accepted;
          }
          field = kept;
        });
        options.loop.inlier_threshold_px = -1.0;
        EXPECT_FALSE(localizer.changeOptions(options)) << "out of range";
      });
  EXPECT_EQ(course.digest, digestOf(scene.problem(), defaultProfile()))
      << "a refused change must not change the digest";
  EXPECT_EQ(refused, 16);
  EXPECT_EQ(accepted, 25);
}

TEST(LocalizerChange, ChangeWithinAnIteration_IsRefused) {
  const Case scene = stationCase(4);
  LocalizerOptions other = defaultProfile();
  other.pnp.seed = 99;
  OwnedRun run(scene.problem(), defaultProfile());
  for (bool finished = false; !finished;) {
    EXPECT_TRUE(run.localizer.isBetweenIterations() || !run.localizer.changeOptions(other));
    finished = run.localizer.step().finished;
  }
  EXPECT_FALSE(run.localizer.changeOptions(other));
  EXPECT_EQ(run.localizer.digest(), digestOf(scene.problem(), defaultProfile()));
}

}  // namespace
}  // namespace boresight::test
