// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/mask_edits.h"

#include <gtest/gtest.h>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/example_case.h"

namespace boresight::test {
namespace {

using sessions::MaskStroke;
using sessions::MaskStrokes;
using sessions::Session;
using sessions::StrokeKind;

MaskStroke polygon(const std::string& name) {
  MaskStroke stroke;
  stroke.kind = StrokeKind::kPolygon;
  stroke.points = {{10.0, 20.0}, {200.0, 30.0}, {90.0, 300.0}};
  stroke.name = name;
  return stroke;
}

Session exampleSession() { return sessions::makeSession(exampleFolder() / "dataset.json"); }

/// Cases a, b of one camera, c of another.
Session threeCases() {
  Random random = randomFor("MaskEdits");
  Session session;
  sessions::SessionCase one = randomCase(random, "a");
  one.ignore_strokes.clear();
  session = withCase(session, one);
  one.id = "b";
  session = withCase(session, one);
  one.id = "c";
  one.camera.fx += 1.0;
  return withCase(session, one);
}

TEST(MaskEdits, AppendAndReplaceStrokesOfOneCaseOnly) {
  const Session before = threeCases();
  const Session after = withStroke(withStroke(before, "a", polygon("")), "a", polygon("x"));
  EXPECT_EQ(after.findCase("a")->ignore_strokes, (MaskStrokes{polygon(""), polygon("x")}));
  EXPECT_EQ(*after.findCase("b"), *before.findCase("b"));
  EXPECT_EQ(withStrokes(after, "a", {}), before);
  EXPECT_EQ(withStroke(before, "nobody", polygon("")), before);
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

TEST(MaskEdits, StrokesWithoutANameAreNotOffered) {
  const Session session = withStroke(threeCases(), "a", polygon(""));
  EXPECT_TRUE(namedStrokesOfCamera(session, "b").empty());
}

TEST(MaskEdits, ANameDoesNotMakeARunStale) {
  const Session session = withStroke(threeCases(), "a", polygon(""));
  const Session named = withStrokes(session, "a", {polygon("gripper")});
  EXPECT_EQ(inputsDigest(*session.findCase("a")), inputsDigest(*named.findCase("a")));
  EXPECT_NE(inputsDigest(*session.findCase("a")), inputsDigest(*threeCases().findCase("a")));
}

TEST(MaskEdits, ClearedIgnoresNothingOfAMaskImageEither) {
  Session session = exampleSession();
  sessions::SessionCase one = *session.cases.front();
  EXPECT_TRUE(sessions::clearedStrokes(one).empty());
  one.ignore = one.image.source;  // the image itself: nonzero nearly everywhere
  one.ignore_strokes = {polygon("")};
  EXPECT_GT(sessions::loadCase(one)->ignore->ignored_count, 1000);
  one.ignore_strokes = sessions::clearedStrokes(one);
  EXPECT_EQ(sessions::loadCase(one)->ignore->ignored_count, 0);
}

TEST(MaskEdits, AnEditedCaseIsReloadedAsItWouldBeLoaded) {
  const Session session = exampleSession();
  sessions::SessionCase one = *session.cases.front();
  const auto before = sessions::loadCase(one);
  one.ignore_strokes = {polygon("")};
  one.image.eight_bit.bit_depth = 8;
  const auto loaded = sessions::loadCase(one);
  const auto reloaded = sessions::reloadCase(*before, one);
  EXPECT_EQ(reloaded->source, one);
  EXPECT_EQ(reloaded->image.pixels, loaded->image.pixels);
  EXPECT_TRUE(reloaded->image.bit_depth_stated) << "the image was read by the new rule";
  EXPECT_EQ(reloaded->ignore->words, loaded->ignore->words);
  EXPECT_EQ(reloaded->ignore_bits.words.data(), reloaded->ignore->words.data());
  EXPECT_EQ(reloaded->scene.view().faces.size(), before->scene.view().faces.size());
  EXPECT_EQ(runCase(session, *reloaded, sessions::RecordLevel::kSummary).digest,
            runCase(session, *loaded, sessions::RecordLevel::kSummary).digest);
}

}  // namespace
}  // namespace boresight::test
