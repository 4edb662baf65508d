// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/ignore_strokes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sessions/session/case_run.h"
#include "sessions/session/session.h"
#include "sessions/session/session_maker.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/example_case.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// The definition, pixel by pixel: brush by the distance to the nearest point of the line, polygon
/// by the winding of the angle under which it is seen.
bool covers(const MaskStroke& stroke, const Eigen::Vector2d& pixel, int gray) {
  const auto& points = stroke.points;
  if (stroke.kind == StrokeKind::kSaturation) return gray >= stroke.level;
  if (stroke.kind == StrokeKind::kBrush) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d a = points[i > 0 ? i - 1 : 0];
      for (int step = 0; step <= 4000; ++step)
        if ((a + step / 4000.0 * (points[i] - a) - pixel).norm() <= stroke.radius_px) return true;
    }
    return false;
  }
  int crossings = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d a = points[i] - pixel;
    const Eigen::Vector2d b = points[(i + 1) % points.size()] - pixel;
    const bool above_a = a.y() > 0.0, above_b = b.y() > 0.0;
    if (above_a != above_b && (a.x() * b.y() - b.x() * a.y() > 0.0) == above_b) ++crossings;
  }
  return crossings % 2 == 1;
}

TEST(IgnoreStrokes, CoverWhatTheyAreDefinedToCover) {
  Random random = randomFor("IgnoreStrokes");
  constexpr int kWidth = 70, kHeight = 20;
  std::vector<std::uint8_t> pixels(kWidth * kHeight);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random.below(256));
  const ImageView image{pixels.data(), kWidth, kHeight, kWidth};
  for (int round = 0; round < 12; ++round) {
    MaskStroke stroke;
    stroke.kind = static_cast<StrokeKind>(round % 3);
    stroke.radius_px = random.uniform(0.5, 6.0);
    stroke.level = static_cast<int>(random.below(256));
    for (int i = 0; i < 4; ++i)
      stroke.points.emplace_back(random.uniform(-20.0, 90.0), random.uniform(-20.0, 40.0));
    IgnoreMask mask = emptyMask(kWidth, kHeight);
    applyStrokes({stroke}, image, mask);
    std::int64_t count = 0, different = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool ignored = mask.view().get(x, y);
        different += ignored != covers(stroke, {x, y}, image.at(x, y));
        count += ignored;
      }
    // The oracle walks the brush in steps: only a pixel just at the rim may differ.
    EXPECT_LE(different, stroke.kind == StrokeKind::kBrush ? 1 : 0) << round;
    EXPECT_EQ(count, mask.ignored_count);
    MaskStroke eraser = stroke;
    eraser.erase = true;
    applyStrokes({eraser}, image, mask);
    EXPECT_EQ(mask.ignored_count, 0);
  }
}

TEST(IgnoreStrokes, AreAppliedInTheirOrder) {
  const std::vector<std::uint8_t> pixels(100, 255);
  const ImageView image{pixels.data(), 10, 10, 10};
  MaskStroke all, dot;
  all.kind = StrokeKind::kSaturation;
  dot.erase = true;
  dot.radius_px = 0.0;
  dot.points = {{3.0, 4.0}};
  IgnoreMask mask = emptyMask(10, 10);
  applyStrokes({all, dot}, image, mask);
  EXPECT_EQ(mask.ignored_count, 99);
  EXPECT_FALSE(mask.view().get(3, 4));
  applyStrokes({all}, image, mask);
  EXPECT_EQ(mask.ignored_count, 100);
}

MaskStroke polygon(const std::string& name) {
  MaskStroke stroke;
  stroke.kind = StrokeKind::kPolygon;
  stroke.points = {{10.0, 20.0}, {200.0, 30.0}, {90.0, 300.0}};
  stroke.name = name;
  return stroke;
}

SessionCase bcExample() { return *makeSession(exampleFolder() / "dataset.json").cases.front(); }

/// Cases a, b of one camera, c of another.
Session threeCases() {
  Random random = randomFor("MaskEdits");
  Session session;
  SessionCase session_case = randomCase(random, "a");
  session_case.ignore_strokes.clear();
  session = withCase(session, session_case);
  session_case.id = "b";
  session = withCase(session, session_case);
  session_case.id = "c";
  session_case.camera.fx += 1.0;
  return withCase(session, session_case);
}

TEST(MaskEdits, AppendAndReplaceStrokesOfOneCaseOnly) {
  const Session before = threeCases();
  const Session after = withStroke(withStroke(before, "a", polygon("")), "a", polygon("x"));
  EXPECT_EQ(after.findCase("a")->ignore_strokes, (MaskStrokes{polygon(""), polygon("x")}));
  EXPECT_EQ(*after.findCase("b"), *before.findCase("b"));
  EXPECT_EQ(withStrokes(after, "a", {}), before);
  EXPECT_EQ(withStroke(before, "unknown", polygon("")), before);
}

TEST(MaskEdits, AStrokeIsCopiedToTheCamerasOtherCasesOnce) {
  Session session = withStroke(threeCases(), "a", polygon("gripper"));
  EXPECT_EQ(namedStrokesOfCamera(session, "b"), MaskStrokes{polygon("gripper")});
  EXPECT_TRUE(namedStrokesOfCamera(session, "c").empty());
  session = copyingStroke(session, "a", 0);
  EXPECT_EQ(session.findCase("b")->ignore_strokes, MaskStrokes{polygon("gripper")});
  EXPECT_TRUE(session.findCase("c")->ignore_strokes.empty());
  EXPECT_TRUE(namedStrokesOfCamera(session, "b").empty());
  EXPECT_EQ(copyingStroke(session, "a", 0), session);
  EXPECT_EQ(copyingStroke(session, "a", 1), session);
}

TEST(MaskEdits, AStrokeWithoutANameIsNotOfferedAndANameDoesNotMakeARunStale) {
  const Session session = withStroke(threeCases(), "a", polygon(""));
  EXPECT_TRUE(namedStrokesOfCamera(session, "b").empty());
  const Session named = withStrokes(session, "a", {polygon("gripper")});
  EXPECT_EQ(inputsDigest(*session.findCase("a")), inputsDigest(*named.findCase("a")));
  EXPECT_NE(inputsDigest(*session.findCase("a")), inputsDigest(*threeCases().findCase("a")));
}

TEST(MaskEdits, ClearedIgnoresNothingOfAMaskImageEither) {
  SessionCase session_case = bcExample();
  EXPECT_TRUE(clearedStrokes(session_case).empty());
  session_case.ignore = session_case.image.source;  // the image itself: nonzero nearly everywhere
  session_case.ignore_strokes = {polygon("")};
  EXPECT_GT(loadCase(session_case)->ignore->ignored_count, 1000);
  session_case.ignore_strokes = clearedStrokes(session_case);
  EXPECT_EQ(loadCase(session_case)->ignore->ignored_count, 0);
}

TEST(MaskEdits, AnEditedCaseIsReloadedAsItWouldBeLoaded) {
  SessionCase session_case = bcExample();
  const auto before = loadCase(session_case);
  session_case.ignore_strokes = {polygon("")};
  session_case.image.eight_bit.bit_depth = 8;
  const auto loaded = loadCase(session_case);
  const auto reloaded = reloadCase(*before, session_case);
  EXPECT_EQ(reloaded->source, session_case);
  EXPECT_EQ(reloaded->image.pixels, loaded->image.pixels);
  EXPECT_TRUE(reloaded->image.bit_depth_stated) << "the image was read by the new rule";
  EXPECT_EQ(reloaded->ignore->words, loaded->ignore->words);
  EXPECT_EQ(reloaded->ignore_bits.words.data(), reloaded->ignore->words.data());
  EXPECT_EQ(reloaded->scene.view().faces.size(), before->scene.view().faces.size());
}

TEST(StrokeText, NamesKindAndSize) {
  MaskStroke stroke = polygon("");
  EXPECT_EQ(strokeText(stroke), "polygon of 3 corners");
  stroke.name = "gripper";
  stroke.erase = true;
  EXPECT_EQ(strokeText(stroke), "gripper (erase: polygon of 3 corners)");
  stroke.name = "";
  stroke.kind = StrokeKind::kBrush;
  stroke.radius_px = 2.5;
  EXPECT_EQ(strokeText(stroke), "erase: brush, 5 px wide");
  stroke.kind = StrokeKind::kSaturation;
  stroke.erase = false;
  stroke.level = 200;
  EXPECT_EQ(strokeText(stroke), "pixels of at least 200");
  stroke.level = 1;
  EXPECT_EQ(strokeText(stroke), "pixels of at least 1");
  stroke.level = 0;
  EXPECT_EQ(strokeText(stroke), "all pixels");
}

TEST(MaskEdits, CasesOfOneCamera_HaveItsImageSizeToo) {
  Session session = threeCases();
  EXPECT_EQ(casesOfSameCamera(session, "a"), std::vector<std::string>{"b"});
  EXPECT_TRUE(casesOfSameCamera(session, "c").empty());
  EXPECT_TRUE(casesOfSameCamera(session, "none").empty());
  for (const auto side : {&ImageInput::width, &ImageInput::height}) {
    const Session other =
        withChanged(session, "b", [side](SessionCase& item) { ++(item.image.*side); });
    EXPECT_TRUE(casesOfSameCamera(other, "a").empty());
  }
  EXPECT_TRUE(namedStrokesOfCamera(session, "none").empty());
  EXPECT_EQ(copyingStroke(session, "none", 0), session);
  session = withStroke(withStroke(session, "a", polygon("x")), "b", polygon("x"));
  EXPECT_TRUE(namedStrokesOfCamera(session, "b").empty()) << "it has it";
}

}  // namespace
}  // namespace boresight::test
