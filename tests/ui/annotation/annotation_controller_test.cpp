// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_controller.h"

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
  const Eigen::Vector3d corner_m = corners_m(1).front();
  const std::string first = controller_.placeInImage({10.25, 20.5});
  EXPECT_EQ(first, "p1");
  ASSERT_EQ(controller_.annotations().points.size(), 1u);
  EXPECT_FALSE(controller_.annotations().points[0].complete());
  EXPECT_EQ(controller_.placeOnStation(corner_m), first)
      << "the chosen half-made pair is completed";
  EXPECT_TRUE(controller_.annotations().points[0].complete());
  const std::string second = controller_.placeOnStation(corner_m);
  EXPECT_EQ(second, "p2") << "a complete pair is not overwritten";
  EXPECT_EQ(controller_.placeInImage({30.0, 40.0}), second);
  EXPECT_EQ(controller_.annotations().points[1].pixel, Eigen::Vector2d(30.0, 40.0));
  EXPECT_EQ(document_.undoText(), QStringLiteral("Place p2 on the image"));
  ASSERT_TRUE(document_.undo());
  EXPECT_FALSE(controller_.annotations().points[1].pixel);
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(controller_.annotations().points.size(), 1u);
  ASSERT_TRUE(document_.redo());
  ASSERT_TRUE(document_.redo());
  EXPECT_TRUE(controller_.annotations().points[1].complete());
}

TEST_F(AnnotationControllerTest, LinePair_AnySideFirst_IsCompleted) {
  const sessions::ModelEdge edge{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}};
  const std::string id = controller_.placeEdgeOnStation(edge);
  EXPECT_EQ(id, "l1");
  EXPECT_EQ(controller_.placeLineInImage({{10.0, 10.0}, {50.0, 10.0}}), id);
  ASSERT_EQ(controller_.annotations().lines.size(), 1u);
  EXPECT_TRUE(controller_.annotations().lines[0].complete());
  QSignalSpy told(&controller_, &AnnotationController::told);
  EXPECT_EQ(controller_.placeLineInImage({{10.0, 10.0}, {10.2, 10.0}}), "");
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
  ASSERT_TRUE(controller_.dragInImage(ids[2], pixelOf(corners_m(8)[2]) + Eigen::Vector2d(5, 0)));
  EXPECT_TRUE(controller_.stale());
  ASSERT_TRUE(solved()) << "also before the gesture has ended";
  EXPECT_NE(*controller_.solvedPose(), *pose);
}

TEST_F(AnnotationControllerTest, AGestureIsOneStepOfUndo) {
  const std::string id = controller_.placeInImage({100.0, 100.0});
  const QString before = document_.undoText();
  for (int i = 0; i < 20; ++i) controller_.dragInImage(id, {100.0 + i, 100.0});
  EXPECT_EQ(document_.undoText(), before) << "nothing is done before the gesture ends";
  controller_.finishMove();
  EXPECT_EQ(document_.undoText(), QStringLiteral("Move p1"));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(controller_.nudge({0.1, 0.0}));
  controller_.finishMove();
  EXPECT_NEAR(controller_.annotations().points[0].pixel->x(), 119.5, 1e-9);
  ASSERT_TRUE(document_.undo());
  EXPECT_NEAR(controller_.annotations().points[0].pixel->x(), 119.0, 1e-9);
  ASSERT_TRUE(document_.undo());
  EXPECT_NEAR(controller_.annotations().points[0].pixel->x(), 100.0, 1e-9);
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
  EXPECT_EQ(controller_.annotations().points.size(), 1u);
  EXPECT_EQ(controller_.placeInImage({-3.0, 10.0}), "");
  EXPECT_EQ(controller_.placeInImage({std::nan(""), 10.0}), "");
  EXPECT_EQ(told.count(), 5);
  sessions::PointPair renamed = *controller_.selectedPoint();
  renamed.id = "";
  EXPECT_FALSE(controller_.replacePoint(id, renamed, QStringLiteral("Rename")));
}

TEST_F(AnnotationControllerTest, BlindRound_KeepsStationPointsAndReportsRepeatability) {
  const auto ids = markCorners(6);
  const sessions::Annotations first = controller_.annotations();
  controller_.putAside(QStringLiteral(" Ada "));
  for (const sessions::PointPair& point : controller_.annotations().points) {
    EXPECT_TRUE(point.point_in_station_m);
    EXPECT_FALSE(point.pixel);
  }
  for (const std::string& id : ids) {
    controller_.select(id);
    controller_.placeInImage(*sessions::findPoint(first, id)->pixel + Eigen::Vector2d(0.5, -0.5));
  }
  ASSERT_TRUE(solved());
  ASSERT_EQ(controller_.answer().rounds.size(), 1u);
  EXPECT_EQ(controller_.answer().rounds[0].by, "Ada");
  EXPECT_TRUE(controller_.answer().rounds[0].camera_from_station);
  EXPECT_EQ(controller_.answer().rounds[0].repeatability.annotations.size(), ids.size());
  EXPECT_NEAR(controller_.answer().rounds[0].repeatability.sigma_px, 0.5 / std::sqrt(2.0), 1e-9);
  controller_.takeUp(0);
  EXPECT_EQ(controller_.annotations(), first);
  EXPECT_EQ(document_.session().rounds.at(source().id)->size(), 2u)
      << "the annotations that were at work are put aside";
  ASSERT_TRUE(document_.undo()) << "the second round is not lost";
  EXPECT_TRUE(controller_.annotations().points[0].complete());
  controller_.removeRound(0);
  EXPECT_TRUE(document_.session().rounds.empty());
}

/// At once, before anything is solved again, and until the last place is set.
TEST_F(AnnotationControllerTest, BlindRound_PredictsNothing) {
  const auto ids = markCorners(6);
  const sessions::Annotations first = controller_.annotations();
  ASSERT_TRUE(solved());
  controller_.putAside(QStringLiteral("Ada"));
  const auto place = [&](std::size_t i) {
    controller_.select(ids[i]);
    controller_.placeInImage(*sessions::findPoint(first, ids[i])->pixel);
  };
  EXPECT_FALSE(controller_.solvedPose() || state_.annotatedPose());
  for (std::size_t i = 0; i + 1 < ids.size(); ++i) place(i);
  ASSERT_TRUE(solved());
  EXPECT_TRUE(controller_.answer().blind);
  EXPECT_FALSE(controller_.solvedPose() || state_.annotatedPose()) << "of five pairs";
  EXPECT_TRUE(controller_.answer().proposals.empty());
  ASSERT_EQ(controller_.answer().rounds.size(), 1u) << "it can be taken up";
  EXPECT_FALSE(controller_.answer().rounds[0].camera_from_station);
  place(ids.size() - 1);
  ASSERT_TRUE(solved());
  EXPECT_FALSE(controller_.answer().blind);
  EXPECT_TRUE(controller_.solvedPose() && state_.annotatedPose());
}

/// The pose of the rig is known by its other camera.
TEST_F(AnnotationControllerTest, BlindRoundInARig_PredictsNothing) {
  const sessions::Session rig = test::sessionOfTwoViews(folder_.path());
  ASSERT_TRUE(document_.create(folder_.path() / "rig.boresight.json", rig));
  for (const auto& session_case : {rig.cases.back(), rig.cases.front()}) {
    open(session_case->id);
    markCorners(6);
    ASSERT_TRUE(solved());
  }
  ASSERT_EQ(controller_.solution()->annotations.views.size(), 2u);
  EXPECT_TRUE(solutionHeadline(controller_.answer(), false)
                  .startsWith(QStringLiteral("Solved from 12 annotations of 2 cameras")));
  controller_.putAside(QStringLiteral("Ada"));
  ASSERT_TRUE(solved());
  EXPECT_TRUE(controller_.answer().blind);
  EXPECT_FALSE(controller_.solvedPose() || state_.annotatedPose());
}

TEST_F(AnnotationControllerTest, UseAsSeed_StatesThreeSigma) {
  markCorners(8);
  ASSERT_TRUE(solved());
  const Pose pose = *controller_.solvedPose();
  const sessions::SessionCase expected = sessions::withMeasuredSeed(
      *document_.session().findCase(source().id), state_.currentCase()->scene.view(), pose,
      *controller_.answer().covariance);
  controller_.useAsSeed();
  EXPECT_EQ(*document_.session().findCase(source().id), expected);
  EXPECT_EQ(expected.camera_from_station_seed, pose);
  ASSERT_TRUE(document_.undo()) << "one edit";
  EXPECT_NE(*document_.session().findCase(source().id), expected);
}

TEST_F(AnnotationControllerTest, Landmarks_AfterThreeAnnotations_AreProposedAtTheirProjection) {
  openLandmarks(corners_m(8), {0, 3, 7});
  ASSERT_TRUE(solved());
  ASSERT_EQ(controller_.answer().proposals.size(), 5u);
  for (const sessions::Proposal& proposal : controller_.answer().proposals)
    EXPECT_LT((proposal.pixel - pixelOf(proposal.landmark.point_in_station_m)).norm(), 0.5);
  const sessions::Proposal taken = controller_.answer().proposals.front();
  controller_.confirm(taken, taken.pixel);
  ASSERT_TRUE(solved());
  EXPECT_EQ(controller_.answer().proposals.size(), 4u);
  EXPECT_EQ(controller_.selected(), taken.landmark.name);
  EXPECT_EQ(controller_.seenProposals(), 4) << "all are corners that are seen";
}

TEST_F(AnnotationControllerTest, TruthFromAnnotations_KeepsItsCovarianceAndWarnsIfCoarse) {
  QStringList said;
  QObject::connect(&controller_, &AnnotationController::told,
                   [&said](const QString& sentence) { said << sentence; });
  const Pose before = truth();
  const auto stored = [this] {
    return document_.session().findCase(source().id)->camera_from_station_truth;
  };
  controller_.useAsTruth();
  EXPECT_EQ(stored(), before) << "there is no pose yet";
  said.clear();
  const auto ids = markCorners(5);
  ASSERT_TRUE(solved());
  controller_.useAsTruth();
  EXPECT_EQ(stored(), controller_.solvedPose());
  ASSERT_EQ(said.size(), 1);
  EXPECT_FALSE(said[0].contains(QStringLiteral("sigma"))) << said[0].toStdString();
  controller_.dragInImage(ids[0], pixelOf(corners_m(5)[0]) + Eigen::Vector2d(30.0, 40.0));
  controller_.finishMove();
  ASSERT_TRUE(solved());
  controller_.useAsTruth();
  ASSERT_EQ(said.size(), 2);
  EXPECT_TRUE(said[1].contains(QStringLiteral("Its one sigma is"))) << said[1].toStdString();
  EXPECT_TRUE(said[1].contains(QStringLiteral("required"))) << said[1].toStdString();
  const sessions::SessionCase& session_case = *document_.session().findCase(source().id);
  EXPECT_EQ(session_case.camera_from_station_truth, controller_.solvedPose())
      << "the operator may go on";
  EXPECT_EQ(session_case.truth_covariance, controller_.answer().covariance);
  ASSERT_TRUE(session_case.truth_covariance);
  ASSERT_TRUE(document_.undo());
  ASSERT_TRUE(document_.undo());  // the drag
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(stored(), before);
}

TEST_F(AnnotationControllerTest, Annotations_AreStoredPerCaseAndReloaded) {
  controller_.placeInImage({12.0, 34.0});
  const std::string id = source().id;
  const auto other = document_.session().cases.back()->id;
  ASSERT_NE(other, id);
  open(other);
  EXPECT_TRUE(controller_.annotations().empty());
  open(id);
  EXPECT_EQ(controller_.annotations().points.size(), 1u);
  const auto killed =
      sessions::SessionDocument::open(document_.file(), sessions::Access::kReadOnly);
  ASSERT_TRUE(killed.recovery());
  EXPECT_EQ(killed.recovery()->session.annotations, document_.session().annotations);
}

class StationSnapperTest : public ::testing::Test {
 protected:
  void takeCase(const ViewState::CasePtr& loaded_case) {
    state_.setCase(loaded_case);
    ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, 60000));
  }

  ViewState state_;
  StationSnapper snapper_{state_};
};

/// Where a corner of the mesh projects, the corner is the likeliest: the edges that meet there are
/// just as near.
TEST_F(StationSnapperTest, ACornerComesBeforeTheEdgesThatMeetInIt) {
  takeCase(test::loadedExample("bc"));
  const auto& source = state_.currentCase()->source;
  const Pose& pose = *source.camera_from_station_truth;
  int corners = 0;
  for (std::size_t i = 0; i < snapper_.mesh()->edges().size(); i += 41) {
    const Eigen::Vector3d corner = snapper_.mesh()->edges()[i].start_in_station_m;
    Eigen::Vector2d pixel;
    if (!project(source.camera, pose * corner, pixel)) continue;
    const auto snaps = snapper_.near(source.camera, pose, pixel, 3.0);
    const bool seen = !snaps.empty() && snaps[0].kind == sessions::MeshSnapKind::kVertex &&
                      snaps[0].point_in_station_m == corner;
    if (!seen) continue;  // something hides it
    ++corners;
    const auto nearby = snapper_.near(source.camera, pose, pixel + Eigen::Vector2d(0.4, 0.3), 3.0);
    ASSERT_FALSE(nearby.empty());
    EXPECT_NE(nearby[0].kind, sessions::MeshSnapKind::kEdge);
  }
  EXPECT_GT(corners, 5);
}

TEST_F(StationSnapperTest, AnotherCasesMeshIsNotGivenForThisOne) {
  EXPECT_TRUE(snapper_.near(Camera(), Pose(), {0.0, 0.0}, 1e6).empty()) << "there is no case";
  takeCase(test::loadedExample("bc"));
  const auto before = snapper_.mesh();
  state_.setCase(test::loadedExample("os"));
  EXPECT_EQ(snapper_.mesh(), nullptr) << "until it is searched";
  ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, 60000));
  EXPECT_NE(snapper_.mesh()->edges().front(), before->edges().front());
  state_.setCase(nullptr);
  EXPECT_EQ(snapper_.mesh(), nullptr);
}

TEST_F(StationSnapperTest, AnEditOfTheMaskLeavesItAlone) {
  const auto value = test::loadedExample("bc");
  takeCase(value);
  const auto before = snapper_.mesh();
  sessions::SessionCase edited = value->source;
  edited.ignore_strokes.emplace_back();
  edited.ignore_strokes.back().kind = sessions::StrokeKind::kSaturation;
  QSignalSpy changes(&snapper_, &StationSnapper::meshChanged);
  state_.replaceCase(sessions::reloadCase(*value, edited));
  EXPECT_EQ(snapper_.mesh(), before);
  EXPECT_EQ(changes.count(), 0);
}

}  // namespace
}  // namespace boresight::ui
