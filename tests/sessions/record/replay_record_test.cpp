// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stop_token>
#include <variant>

#include "sessions/io/json/option_value.h"
#include "sessions/trace/match_details.h"
#include "sessions/trace/run_text.h"
#include "tests/sessions/record/recorded_run.h"
#include "tests/support/all_cases.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// Numbers of 32 bits near those of 64 that they were made of.
constexpr double kFloat_px = 1e-4;

const LocalizationTrace& replayed() {
  static const LocalizationTrace trace =
      replayRecord(exampleRun().run.record, exampleRun().problem);
  return trace;
}

/// The image with colours that differ from its gray.
std::vector<std::uint8_t> colorOf(const ImageView& image) {
  std::vector<std::uint8_t> color;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const int shift : {0, 3, 9})
        color.push_back(static_cast<std::uint8_t>(image.at(x, y) >> (shift % 4)));
  return color;
}

void expectSameRender(const RenderTrace& a, const RenderTrace& b) {
  EXPECT_EQ(a.camera_from_station, b.camera_from_station);
  EXPECT_EQ(a.edges.words, b.edges.words);
  EXPECT_EQ(a.mask.words, b.mask.words);
  EXPECT_EQ(a.row_begin, b.row_begin);
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    ASSERT_EQ(a.pixels[i].depth_m, b.pixels[i].depth_m);
    ASSERT_EQ(a.pixels[i].face, b.pixels[i].face);
  }
}

void expectEqualTemplates(const IterationTrace& a, const IterationTrace& b) {
  ASSERT_EQ(a.templates.size(), b.templates.size());
  ASSERT_EQ(a.matches.size(), b.matches.size());
  for (std::size_t i = 0; i < a.templates.size(); ++i) {
    EXPECT_EQ(a.templates[i].center_x, b.templates[i].center_x);
    EXPECT_EQ(a.templates[i].center_y, b.templates[i].center_y);
    EXPECT_EQ(a.templates[i].depth_m, b.templates[i].depth_m);
    EXPECT_EQ(a.templates[i].distinctness, b.templates[i].distinctness);
    EXPECT_EQ(a.templates[i].point_in_station_m, b.templates[i].point_in_station_m);
  }
  for (std::size_t i = 0; i < a.matches.size(); ++i) {
    const Match& m = a.matches[i];
    const Match& n = b.matches[i];
    ASSERT_EQ(m.searched, n.searched);
    EXPECT_EQ(m.window.x_min, n.window.x_min);
    EXPECT_EQ(m.window.y_max, n.window.y_max);
    if (!m.searched) continue;
    EXPECT_EQ(m.norms, n.norms);
    EXPECT_EQ(m.at_border, n.at_border);
    EXPECT_NEAR(m.x, n.x, kFloat_px);
    EXPECT_NEAR(m.y, n.y, kFloat_px);
  }
}

void expectSamePairs(const IterationTrace& a, const IterationTrace& b) {
  EXPECT_EQ(a.template_of, b.template_of);
  EXPECT_EQ(a.pnp.inlier, b.pnp.inlier);
  ASSERT_EQ(a.correspondences.size(), b.correspondences.size());
  for (std::size_t i = 0; i < a.correspondences.size(); ++i) {
    EXPECT_EQ(a.correspondences[i].point_in_station_m, b.correspondences[i].point_in_station_m);
    EXPECT_NEAR((a.correspondences[i].pixel - b.correspondences[i].pixel).norm(), 0.0, 1e-3);
    EXPECT_EQ(a.correspondences[i].sigma_px, b.correspondences[i].sigma_px);
  }
  if (!(b.pnp.camera_from_station == b.camera_from_station)) return;
  for (std::size_t i = 0; i < a.pnp.residual_px.size(); ++i)
    EXPECT_NEAR(a.pnp.residual_px[i], b.pnp.residual_px[i], 1e-3);
}

void expectSameScores(const IterationTrace& a, const IterationTrace& b) {
  const auto all_replayed = matchDetails(a);
  const auto all_traced = matchDetails(b);
  ASSERT_EQ(all_replayed.size(), all_traced.size());
  for (std::size_t i = 0; i < all_traced.size(); ++i) {
    const auto& replayed_match = all_replayed[i];
    const auto& traced = all_traced[i];
    if (!traced.searched) continue;
    EXPECT_NEAR(replayed_match.score, traced.score, 1e-6);
    EXPECT_EQ(std::isnan(replayed_match.second_score), std::isnan(traced.second_score));
    if (!std::isnan(traced.second_score)) {
      EXPECT_NEAR(replayed_match.second_score, traced.second_score, 1e-6);
      EXPECT_NEAR(replayed_match.margin, traced.margin, 1e-6);
    }
    EXPECT_TRUE(std::isnan(replayed_match.edge_share)) << "a record does not have it";
  }
}

TEST(ReplayRecord, EqualsTheGroundRunInCommonFields) {
  const LocalizationTrace& a = replayed();
  const LocalizationTrace& b = exampleRun().run.trace;
  EXPECT_TRUE(a.replayed && a.finished);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.camera_from_station, b.camera_from_station);
  EXPECT_EQ(a.camera_from_station_seed, b.camera_from_station_seed);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.support.share(), b.support.share());
  EXPECT_TRUE(sameOptions(a.options, b.options));
  for (std::size_t i = 0; i < b.edges->level.size(); ++i)
    EXPECT_EQ(a.edges->level[i].words, b.edges->level[i].words);
  EXPECT_EQ(a.edges->high_threshold, b.edges->high_threshold);
  ASSERT_EQ(a.iterations.size(), b.iterations.size());
  for (std::size_t i = 0; i < b.iterations.size(); ++i) {
    SCOPED_TRACE(i);
    const IterationTrace& x = *a.iterations[i];
    const IterationTrace& y = *b.iterations[i];
    EXPECT_EQ(x.camera_from_station, y.camera_from_station);
    EXPECT_EQ(x.camera_from_station_before, y.camera_from_station_before);
    EXPECT_EQ(x.uncertainty.rotation_rad, y.uncertainty.rotation_rad);
    EXPECT_EQ(x.uncertainty.pivot_in_camera_m, y.uncertainty.pivot_in_camera_m);
    EXPECT_EQ(x.support(), y.support());
    EXPECT_EQ(x.rms_px(), y.rms_px());
    EXPECT_NEAR(x.mean_score, y.mean_score, 1e-6);
    expectSameRender(x.render, y.render);
    expectEqualTemplates(x, y);
    expectSamePairs(x, y);
    expectSameScores(x, y);
  }
  EXPECT_THAT(a.remarks, ElementsAre(HasSubstr("edge points of refinements")));
  EXPECT_THAT(runStatusText(a), StartsWith("Onboard record, replayed. Converged"));
}

TEST(ReplayRecord, FollowsRollsAttemptsAndOptionsTakenUpOnTheWay) {
  LocalizationProblem problem = exampleRun().problem;
  problem.uncertainty.rotation_rad.z() = 0.4;
  problem.camera_from_station_seed = perturbed(
      (Vector6d() << 0.0, 0.0, 0.3, 0.0, 0.0, 0.0).finished(), problem.camera_from_station_seed);
  LocalizerOptions first = recordedOptions();
  first.search.enabled = false;
  LocalizerOptions later = first;
  later.support.min_support = 1.0;
  const RecordedRun run = recordRun(problem, {first, {{2, later}}});
  ASSERT_GT(run.trace.attempts, 1);
  ASSERT_TRUE(run.record.whole());
  ASSERT_EQ(run.record.options.size(), 2u);
  EXPECT_EQ(run.record.options[1].first_iteration, 2);
  EXPECT_TRUE(sameOptions(planOf(run.record).plan.last(), later));
  EXPECT_TRUE(std::any_of(run.trace.iterations.begin(), run.trace.iterations.end(),
                          [](const auto& item) { return item->chosen_hypothesis > 0; }));
  const LocalizationTrace replay = replayRecord(run.record, problem);
  ASSERT_EQ(replay.iterations.size(), run.trace.iterations.size());
  for (std::size_t i = 0; i < replay.iterations.size(); ++i) {
    SCOPED_TRACE(i);
    expectSameRender(replay.iterations[i]->render, run.trace.iterations[i]->render);
    expectEqualTemplates(*replay.iterations[i], *run.trace.iterations[i]);
  }
  EXPECT_THAT(replay.remarks, ElementsAre(HasSubstr("edge points of refinements")));
}

/// What a replay shows is the whole record's, as far as it goes.
void expectBeginning(const LocalizationTrace& part, const LocalizationTrace& whole) {
  ASSERT_LE(part.iterations.size(), whole.iterations.size());
  for (std::size_t i = 0; i < part.iterations.size(); ++i) {
    EXPECT_EQ(part.iterations[i]->camera_from_station, whole.iterations[i]->camera_from_station);
    if (!part.iterations[i]->templates.empty()) {
      EXPECT_EQ(part.iterations[i]->templates.size(), whole.iterations[i]->templates.size());
    }
  }
  if (part.finished) {
    EXPECT_EQ(part.digest, whole.digest);
  } else {
    EXPECT_FALSE(part.converged());
    EXPECT_TRUE(part.digest.empty());
    EXPECT_THAT(part.remarks, Contains(HasSubstr("The record is incomplete")));
  }
}

TEST(ReplayRecord, ShowsWhatIsLeftOfACutOrDamagedRecord) {
  const ExampleRun& whole = exampleRun();
  Random random = randomFor("ReplayRecord.Damage");
  const std::size_t size = whole.run.bytes.size();
  const int trials = allCases() ? 40 : 12;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<std::uint8_t> bytes = whole.run.bytes;
    if (trial % 2 == 0)
      bytes.resize(12 +
                   size * static_cast<std::size_t>(trial) / static_cast<std::size_t>(trials + 5));
    else
      bytes[12 + random.below(static_cast<std::uint32_t>(size - 12))] ^=
          static_cast<std::uint8_t>(1u << random.below(8));
    const OnboardRecord record = parseRecord("cut.whsr", bytes);
    EXPECT_FALSE(record.whole());
    expectBeginning(replayRecord(record, whole.problem), replayed());
  }
}

/// The first iterations of the example's record: replayed in less time than all.
OnboardRecord beginningOfRecord(std::size_t iterations) {
  OnboardRecord record = exampleRun().run.record;
  record.iterations.resize(iterations);
  return record;
}

/// Invalid contents under valid checksums do not crash.
TEST(ReplayRecord, SurvivesContentsThatMakeNoSense) {
  const ExampleRun& whole = exampleRun();
  Random random = randomFor("ReplayRecord.Nonsense");
  for (int trial = 0; trial < (allCases() ? 30 : 10); ++trial) {
    OnboardRecord record = beginningOfRecord(4);
    auto& value = record.iterations[random.below(2)];
    const auto number = [&random] {
      return static_cast<std::int32_t>(random.below(2'000'000'000));
    };
    value.trace.template_side_px = trial % 3 == 0 ? -number() : number();
    value.trace.index = trial % 5 == 0 ? -number() : number();
    value.trace.camera_from_station_before.translation_m.z() = trial % 2 == 0 ? NAN : 1e300;
    for (auto& item : value.templates.value()) {
      item.x = static_cast<int>(random.below(65536));
      item.found_x = trial % 4 == 0 ? NAN : 1e30F;
    }
    const LocalizationTrace replay = replayRecord(record, whole.problem);
    EXPECT_EQ(replay.iterations.size(), record.iterations.size());
    for (const auto& each : replay.iterations) (void)matchDetails(*each);
  }
}

TEST(ReplayRecord, DifferencesFromTheRunOnBoard_AreReported) {
  const ExampleRun& whole = exampleRun();
  ExampleCase other("os");
  for (auto& value : other.image.pixels) value = static_cast<std::uint8_t>(255 - value / 2);
  EXPECT_THAT(replayRecord(whole.run.record, other.problem()).remarks,
              AllOf(Contains(HasSubstr("pixels differ from this case's image")),
                    Contains(HasSubstr("image edges differ"))));
  const ExampleCase bc("bc");
  EXPECT_THAT(replayRecord(whole.run.record, bc.problem()).remarks,
              AllOf(Contains(HasSubstr("mesh differs")),
                    Contains(HasSubstr("render differs from that on board in iteration 1")),
                    Contains(HasSubstr("their points are unknown"))));
  OnboardRecord larger = whole.run.record;
  larger.inputs->width *= 2;
  const LocalizationTrace poses = replayRecord(larger, whole.problem);
  EXPECT_THAT(poses.remarks, Contains(HasSubstr("only its poses are shown")));
  EXPECT_TRUE(poses.iterations.front()->templates.empty());
  EXPECT_EQ(poses.iterations.front()->camera_from_station,
            replayed().iterations.front()->camera_from_station);
}

TEST(ReplayRecord, ColorOfTheImage_CountsOnlyWhereTheRunLookedAtIt) {
  const LocalizationProblem& gray = exampleRun().problem;
  const std::vector<std::uint8_t> color = colorOf(gray.image);
  LocalizationProblem colored = gray;
  colored.color = {color.data(), gray.image.width, gray.image.height, 3 * gray.image.width};
  const auto other_pixels = Contains(HasSubstr("pixels differ"));

  const RecordedRun& of_gray = exampleRun().run;
  EXPECT_THAT(replayRecord(of_gray.record, colored).remarks, Not(other_pixels));
  const RecordedRun of_color = recordRun(colored, recordedOptions());
  EXPECT_NE(of_color.trace.digest, of_gray.trace.digest);
  EXPECT_THAT(replayRecord(of_color.record, colored).remarks, Not(other_pixels));
  EXPECT_THAT(replayRecord(of_color.record, gray).remarks, other_pixels);

  LocalizerOptions blind = recordedOptions();
  blind.search.color = false;
  EXPECT_EQ(recordRun(colored, blind).trace.digest, recordRun(gray, blind).trace.digest);
}

TEST(RecordedPlan, SaysWhichOptionsItDoesNotKnow) {
  OnboardRecord record = exampleRun().run.record;
  EXPECT_TRUE(planOf(record).remarks.empty());
  EXPECT_TRUE(sameOptions(planOf(record).plan.options, recordedOptions()));
  auto& options = record.options.front().options;
  options.push_back({"later.option", boresight::OptionKind::kInteger, 5});
  std::erase_if(options, [](const auto& item) { return item.name == "pnp.seed"; });
  for (auto& item : options)
    if (item.name == "loop.max_attempts") item.bits = 99;
  const RecordedPlan plan = planOf(record);
  EXPECT_TRUE(plan.has_options);
  EXPECT_THAT(plan.remarks, testing::UnorderedElementsAre(HasSubstr("later.option (5 on board)"),
                                                          HasSubstr("lacks the option pnp.seed"),
                                                          HasSubstr("loop.max_attempts was 99")));
  record.options.clear();
  EXPECT_FALSE(planOf(record).has_options);
}

/// The plan of a record in which one option has other bits, and perhaps another kind.
RecordedPlan planWith(const std::string& name, std::uint64_t bits, bool other_kind = false) {
  OnboardRecord record = exampleRun().run.record;
  RecordedOption& option =
      *std::ranges::find(record.options.front().options, name, &RecordedOption::name);
  if (other_kind)
    option.kind = option.kind == boresight::OptionKind::kReal ? boresight::OptionKind::kInteger
                                                              : boresight::OptionKind::kReal;
  option.bits = bits;
  return planOf(record);
}

OptionValue valueIn(const LocalizerOptions& options, const std::string& name) {
  for (const OptionDescription& option : listOptions(options))
    if (option.name == name) return option.value;
  return {};
}

/// Every option takes the ends of its range, and neither a value beyond them nor another kind.
TEST(RecordedPlan, EachOption_IsTakenWithinItsRange) {
  const LocalizerOptions defaults = defaultProfile();
  for (const OptionDescription& option : listOptions(defaults)) {
    SCOPED_TRACE(option.name);
    const bool real = std::holds_alternative<double>(option.value);
    const bool integer = std::holds_alternative<std::int64_t>(option.value);
    const auto bits = [real](double value) {
      return real ? std::bit_cast<std::uint64_t>(value)
                  : static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
    };
    const auto refused = Contains(HasSubstr("The option " + option.name + " was "));
    if (real || integer)
      for (const double value : {option.minimum, option.maximum}) {
        const RecordedPlan plan = planWith(option.name, bits(value));
        EXPECT_THAT(plan.remarks, Not(refused));
        EXPECT_EQ(valueIn(plan.plan.options, option.name),
                  real ? OptionValue(value) : OptionValue(static_cast<std::int64_t>(value)));
      }
    const double last =
        option.choices.empty() ? option.maximum : static_cast<double>(option.choices.size()) - 1.0;
    for (const RecordedPlan& plan : {planWith(option.name, bits(option.minimum), true),
                                     planWith(option.name, bits(last + 1.0)),
                                     planWith(option.name, bits(option.minimum - 1.0))}) {
      EXPECT_THAT(plan.remarks, refused);
      EXPECT_EQ(valueIn(plan.plan.options, option.name), option.value) << "its default";
    }
    if (real) {
      EXPECT_THAT(planWith(option.name, bits(NAN)).remarks, refused);
    }
  }
}

TEST(RecordedPlan, Changes_FollowTheOptionsOfTheStart) {
  OnboardRecord record = exampleRun().run.record;
  const RecordedOptions start = record.options.front();
  const auto changedAt = [&start](std::int32_t iteration) {
    RecordedOptions changed = start;
    changed.first_iteration = iteration;
    return changed;
  };
  record.options = {start, changedAt(2), changedAt(5)};
  const RecordedPlan plan = planOf(record);
  EXPECT_THAT(plan.remarks, IsEmpty());
  ASSERT_EQ(plan.plan.changes.size(), 2u);
  EXPECT_EQ(plan.plan.changes[0].iteration, 2);
  EXPECT_EQ(plan.plan.changes[1].iteration, 5);
  EXPECT_TRUE(sameOptions(plan.plan.changes[1].options, recordedOptions()));
  // Those of the start are lost, or come twice; a change goes back.
  record.options = {changedAt(2)};
  const RecordedPlan lost = planOf(record);
  EXPECT_FALSE(lost.has_options);
  EXPECT_THAT(lost.remarks, Contains("The record has no options; the defaults are used."));
  for (const std::int32_t second : {0, 2}) {
    record.options = {start, changedAt(2), changedAt(second)};
    const RecordedPlan invalid = planOf(record);
    EXPECT_TRUE(invalid.has_options);
    EXPECT_THAT(invalid.plan.changes, IsEmpty());
    EXPECT_THAT(invalid.remarks, Contains(StartsWith("Options changed during the run are left")));
  }
}

TEST(ReplayRecord, LevelThatDoesNotExist_IsNotRendered) {
  for (const int level : {-1, kPyramidLevels}) {
    OnboardRecord record = beginningOfRecord(2);
    record.iterations[0].trace.level = level;
    const LocalizationTrace replay = replayRecord(record, exampleRun().problem);
    EXPECT_TRUE(replay.iterations[0]->render.row_begin.empty());
    EXPECT_FALSE(replay.iterations[1]->render.row_begin.empty());
    EXPECT_THAT(replay.remarks,
                Contains(HasSubstr("The station cannot be rendered in iteration 1")));
  }
}

/// Templates on the border of the image and beyond, and on no edge of the render.
TEST(ReplayRecord, TemplateOutsideTheRender_HasNoPoint) {
  OnboardRecord record = beginningOfRecord(1);
  auto& templates = *record.iterations[0].templates;
  const RenderTrace& render = replayed().iterations[0]->render;
  templates[0].x = render.edges.width;
  templates[1].y = render.edges.height;
  templates[2].x = templates[2].y = 0;
  const LocalizationTrace replay = replayRecord(record, exampleRun().problem);
  const IterationTrace& iteration = *replay.iterations[0];
  for (std::size_t i = 0; i < iteration.templates.size(); ++i)
    EXPECT_EQ(iteration.templates[i].point_in_station_m.allFinite(), i > 2) << i;
  EXPECT_THAT(iteration.template_of, Not(testing::AnyOf(Contains(0), Contains(1), Contains(2))));
  EXPECT_THAT(replay.remarks, Contains("3 of " + std::to_string(templates.size()) +
                                       " templates lie on no rendered edge in iteration 1; their "
                                       "points are unknown."));
}

/// The first edge pixel of a render in raster order is one like the others.
TEST(ReplayRecord, TemplateOnTheFirstEdgePixel_HasItsPoint) {
  OnboardRecord record = beginningOfRecord(1);
  RecordedTemplate& first = record.iterations[0].templates->front();
  const BitImage edges = replayed().iterations[0]->render.edges.view();
  for (int i = 0; i < edges.width * edges.height; ++i) {
    first.x = i % edges.width;
    first.y = i / edges.width;
    if (edges.get(first.x, first.y)) break;
  }
  const LocalizationTrace replay = replayRecord(record, exampleRun().problem);
  EXPECT_TRUE(replay.iterations[0]->templates[0].point_in_station_m.allFinite());
  EXPECT_EQ(replay.iterations[0]->templates[0].depth_m,
            replay.iterations[0]->render.pixels.front().depth_m);
}

TEST(ReplayRecord, OtherMaskOrCamera_IsReported) {
  const auto remarks = [](void (*make)(OnboardRecord&)) {
    OnboardRecord record = beginningOfRecord(1);
    make(record);
    return replayRecord(record, exampleRun().problem).remarks;
  };
  EXPECT_THAT(remarks([](auto& run) { run.inputs->sha256.ignore[0] ^= 1; }),
              Contains(HasSubstr("ignore mask differs")));
  EXPECT_THAT(remarks([](auto& run) { run.inputs->sha256.scene[0] ^= 1; }),
              Contains(HasSubstr("mesh differs")));
  EXPECT_THAT(remarks([](auto& run) { run.inputs->sha256.camera[0] ^= 1; }),
              Contains(HasSubstr("camera differs")));
  EXPECT_THAT(remarks([](auto& run) { run.inputs->height += 1; }),
              Contains(HasSubstr("only its poses are shown")));
  EXPECT_THAT(remarks([](auto& run) { run.inputs.reset(); }), IsEmpty());
}

TEST(ReplayRecord, AStop_LeavesTheIterationsDoneSoFar) {
  std::stop_source stop;
  stop.request_stop();
  const LocalizationTrace replay =
      replayRecord(exampleRun().run.record, exampleRun().problem, stop.get_token());
  EXPECT_THAT(replay.iterations, IsEmpty());
  EXPECT_EQ(replay.digest, exampleRun().run.trace.digest) << "the record has its end";
}

/// Without the block of its end: what the iterations show is kept.
TEST(ReplayRecord, RecordWithoutAnEnd_CountsItsAttempts) {
  OnboardRecord record = beginningOfRecord(2);
  record.end.reset();
  record.iterations.back().trace.attempt = 11;
  record.iterations.back().support = exampleRun().run.record.iterations.back().support;
  const LocalizationTrace replay = replayRecord(record, exampleRun().problem);
  EXPECT_FALSE(replay.finished);
  EXPECT_EQ(replay.attempts, 12);
  EXPECT_EQ(replay.support.share(), replayed().support.share());
}

}  // namespace
}  // namespace boresight::test
