// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_controller.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <QtTest>

#include "sessions/evaluation/pose_error.h"
#include "sessions/review/annotated_seed.h"
#include "tests/support/loaded_example.h"
#include "tests/support/turned_view.h"
#include "tests/ui/annotation/annotation_fixture.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/station_snapper.h"

namespace boresight::ui {
namespace {

class AnnotationControllerTest : public AnnotationTest {};

TEST_F(AnnotationControllerTest, Pair_AnySideFirst_StaysIncompleteUntilTheOther) {
  const Vector3d corner_m = corners_m(1).front();
  const auto& points = annotations().points;
  EXPECT_EQ(controller_.placeInImage({10.25, 20.5}), "p1");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_FALSE(points[0].complete());
  EXPECT_EQ(controller_.placeOnStation(corner_m), "p1") << "the chosen half-made pair is completed";
  EXPECT_TRUE(points[0].complete());
  EXPECT_EQ(controller_.placeOnStation(corner_m), "p2") << "a complete pair is not overwritten";
  EXPECT_EQ(controller_.placeInImage({30.0, 40.0}), "p2");
  EXPECT_EQ(points[1].pixel, Vector2d(30.0, 40.0));
  EXPECT_EQ(document_.undoText(), QStringLiteral("Place p2 on the image"));
  ASSERT_TRUE(document_.undo());
  EXPECT_FALSE(points[1].pixel);
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(points.size(), 1u);
  ASSERT_TRUE(document_.redo() && document_.redo());
  EXPECT_TRUE(points[1].complete());

  EXPECT_EQ(controller_.placeEdgeOnStation({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}), "l1");
  EXPECT_EQ(controller_.placeLineInImage({{10.0, 10.0}, {50.0, 10.0}}), "l1");
  ASSERT_EQ(annotations().lines.size(), 1u);
  EXPECT_TRUE(annotations().lines[0].complete());
  QSignalSpy told(&controller_, &AnnotationController::told);
  EXPECT_EQ(controller_.placeLineInImage({{10.0, 10.0}, {10.2, 10.0}}), "") << "too short";
  EXPECT_EQ(told.count(), 1);
}

TEST_F(AnnotationControllerTest, SolvesAsSoonAsTheGeometryAllowsAndFollowsEveryEdit) {
  const auto ids = markCorners(8);
  ASSERT_EQ(ids.size(), 8u);
  EXPECT_TRUE(controller_.stale()) << "until it has been solved again";
  ASSERT_TRUE(solved());
  const auto pose = controller_.solvedPose();
  ASSERT_TRUE(pose);
  const auto error = sessions::poseError(truth(), *pose, std::nullopt);
  EXPECT_LT(std::abs(error.normal_mm), 1e-3);
  EXPECT_LT(error.lateral_mm, 1e-3);
  EXPECT_LT(error.geodesic_mrad, 1e-3);
  EXPECT_EQ(state_.annotatedPose(), pose) << "the views have it";

  const sessions::SessionCase expected = sessions::withMeasuredSeed(
      *document_.session().findCase(source().id), state_.currentCase()->scene.view(), *pose,
      *controller_.answer().covariance);
  controller_.useAsSeed();
  EXPECT_EQ(*document_.session().findCase(source().id), expected) << "with three sigma";
  EXPECT_EQ(expected.camera_from_station_seed, *pose);
  ASSERT_TRUE(document_.undo()) << "one edit";
  EXPECT_NE(*document_.session().findCase(source().id), expected);

  ASSERT_TRUE(controller_.dragInImage(ids[2], pixelOf(corners_m(8)[2]) + Vector2d(5, 0)));
  EXPECT_TRUE(controller_.stale());
  ASSERT_TRUE(solved()) << "also before the gesture has ended";
  EXPECT_NE(*controller_.solvedPose(), *pose);
}

TEST_F(AnnotationControllerTest, LockedOrOutsideEdit_IsRefusedWithAReason) {
  const std::string id = controller_.placeInImage({100.0, 100.0});
  sessions::PointPair locked = *controller_.selectedPoint();
  locked.locked = true;
  ASSERT_TRUE(controller_.replacePoint(id, locked, QStringLiteral("Lock")));
  QSignalSpy told(&controller_, &AnnotationController::told);
  EXPECT_FALSE(controller_.dragInImage(id, {1.0, 1.0}));
  EXPECT_FALSE(controller_.nudge({1.0, 0.0}));
  controller_.remove(id);
  EXPECT_EQ(annotations().points.size(), 1u);
  EXPECT_EQ(controller_.placeInImage({-3.0, 10.0}), "");
  EXPECT_EQ(controller_.placeInImage({std::nan(""), 10.0}), "");
  EXPECT_EQ(told.count(), 5);
  locked.id = "";
  EXPECT_FALSE(controller_.replacePoint(id, locked, QStringLiteral("Rename")));
}

/// It predicts nothing: at once, before anything is solved again, and until the last place is set.
TEST_F(AnnotationControllerTest, BlindRound_KeepsStationPointsAndReportsRepeatability) {
  const auto ids = solveCorners(6);
  const sessions::Annotations first = annotations();
  const auto place = [&](const std::string& id) {
    controller_.select(id);
    controller_.placeInImage(*sessions::findPoint(first, id)->pixel + Vector2d(0.5, -0.5));
  };
  controller_.putAside(QStringLiteral(" Ada "));
  EXPECT_FALSE(controller_.solvedPose() || state_.annotatedPose());
  for (const sessions::PointPair& point : annotations().points)
    EXPECT_TRUE(point.point_in_station_m && !point.pixel);
  std::for_each(ids.begin(), ids.end() - 1, place);
  ASSERT_TRUE(solved());
  EXPECT_TRUE(controller_.answer().blind);
  EXPECT_FALSE(controller_.solvedPose() || state_.annotatedPose()) << "of five pairs";
  EXPECT_TRUE(controller_.answer().proposals.empty());
  ASSERT_EQ(controller_.answer().rounds.size(), 1u) << "it can be taken up";
  EXPECT_FALSE(controller_.answer().rounds[0].camera_from_station);
  place(ids.back());
  ASSERT_TRUE(solved());
  EXPECT_FALSE(controller_.answer().blind);
  EXPECT_TRUE(controller_.solvedPose() && state_.annotatedPose());
  ASSERT_EQ(controller_.answer().rounds.size(), 1u);
  const RoundAnswer& round = controller_.answer().rounds[0];
  EXPECT_EQ(round.by, "Ada");
  EXPECT_TRUE(round.camera_from_station);
  EXPECT_EQ(round.repeatability.annotations.size(), ids.size());
  EXPECT_NEAR(round.repeatability.sigma_px, 0.5 / std::sqrt(2.0), 1e-9);
  controller_.takeUp(0);
  EXPECT_EQ(annotations(), first);
  EXPECT_EQ(document_.session().rounds.at(source().id)->size(), 2u)
      << "the annotations that were at work are put aside";
  ASSERT_TRUE(document_.undo()) << "the second round is not lost";
  EXPECT_TRUE(annotations().points[0].complete());
  controller_.removeRound(0);
  EXPECT_TRUE(document_.session().rounds.empty());
}

/// The pose of the rig is known by its other camera.
TEST_F(AnnotationControllerTest, BlindRoundInARig_PredictsNothing) {
  const sessions::Session rig = test::sessionOfTwoViews(folder_.path());
  ASSERT_TRUE(document_.create(folder_.path() / "rig.boresight.json", rig));
  for (const auto& session_case : {rig.cases.back(), rig.cases.front()}) {
    open(session_case->id);
    solveCorners(6);
  }
  ASSERT_EQ(controller_.solution()->annotations.views.size(), 2u);
  EXPECT_TRUE(solutionHeadline(controller_.answer(), false)
                  .startsWith(QStringLiteral("Solved from 12 annotations of 2 cameras")));
  controller_.putAside(QStringLiteral("Ada"));
  ASSERT_TRUE(solved());
  EXPECT_TRUE(controller_.answer().blind);
  EXPECT_FALSE(controller_.solvedPose() || state_.annotatedPose());
}

TEST_F(AnnotationControllerTest, Annotations_AreStoredPerCaseAndReloaded) {
  controller_.placeInImage({12.0, 34.0});
  const std::string id = source().id;
  const auto other = document_.session().cases.back()->id;
  ASSERT_NE(other, id);
  open(other);
  EXPECT_TRUE(annotations().empty());
  open(id);
  EXPECT_EQ(annotations().points.size(), 1u);
  const auto killed =
      sessions::SessionDocument::open(document_.file(), sessions::Access::kReadOnly);
  ASSERT_TRUE(killed.recovery());
  EXPECT_EQ(killed.recovery()->session.annotations, document_.session().annotations);
}

TEST_F(AnnotationControllerTest, MoveUnderWay_OnAnotherCase_ANudgeIsKeptADragIsDropped) {
  const std::string id = source().id;
  const auto other = document_.session().cases.back()->id;
  const auto stored = [&] { return *document_.session().annotations.at(id)->points.at(0).pixel; };
  controller_.select(controller_.placeInImage({12.0, 34.0}));
  ASSERT_TRUE(controller_.nudge({0.5, 0.0}));
  open(other);
  EXPECT_EQ(stored(), Vector2d(12.5, 34.0));
  open(id);
  ASSERT_TRUE(controller_.dragInImage(annotations().points.at(0).id, {50.0, 60.0}));
  open(other);
  EXPECT_EQ(stored(), Vector2d(12.5, 34.0)) << "its button is still down";
  EXPECT_TRUE(annotations().empty());
}

TEST(StationSnapper, PutsCornersFirst_AndKeepsItsMeshUntilAnotherCaseIsShown) {
  ViewState state;
  StationSnapper snapper(state);
  const auto found = [&] {
    return QTest::qWaitFor([&] { return snapper.mesh() != nullptr; }, test::kPatienceMs);
  };
  EXPECT_TRUE(snapper.near(Camera(), Pose(), {0.0, 0.0}, 1e6).empty()) << "there is no case";
  const auto value = test::loadedExample("bc");
  state.setCase(value);
  ASSERT_TRUE(found());
  const auto mesh = snapper.mesh();
  const Camera& camera = value->source.camera;
  const Pose& pose = *value->source.camera_from_station_truth;
  int corners = 0;
  for (std::size_t i = 0; i < mesh->edges().size(); i += 41) {
    const Vector3d corner = mesh->edges()[i].start_in_station_m;
    Vector2d pixel;
    if (!project(camera, pose * corner, pixel)) continue;
    const auto snaps = snapper.near(camera, pose, pixel, 3.0);
    const bool seen = !snaps.empty() && snaps[0].kind == sessions::MeshSnapKind::kVertex &&
                      snaps[0].point_in_station_m == corner;
    if (!seen) continue;  // something hides it
    ++corners;
    const auto nearby = snapper.near(camera, pose, pixel + Vector2d(0.4, 0.3), 3.0);
    ASSERT_FALSE(nearby.empty());
    EXPECT_NE(nearby[0].kind, sessions::MeshSnapKind::kEdge) << "those that meet there are as near";
  }
  EXPECT_GT(corners, 5);

  sessions::SessionCase edited = value->source;
  edited.ignore_strokes.emplace_back().kind = sessions::StrokeKind::kSaturation;
  QSignalSpy changes(&snapper, &StationSnapper::meshChanged);
  state.replaceCase(sessions::reloadCase(*value, edited));
  EXPECT_EQ(snapper.mesh(), mesh);
  EXPECT_EQ(changes.count(), 0);
  state.setCase(test::loadedExample("os"));
  EXPECT_EQ(snapper.mesh(), nullptr) << "until it is searched";
  ASSERT_TRUE(found());
  EXPECT_NE(snapper.mesh()->edges().front(), mesh->edges().front());
  state.setCase(nullptr);
  EXPECT_EQ(snapper.mesh(), nullptr);
}

}  // namespace
}  // namespace boresight::ui
