// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/annotation_exchange.h"

#include <gmock/gmock.h>

#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/evaluation/bop_scene.h"
#include "sessions/exchange/colmap_text.h"
#include "sessions/io/cameras/undistort.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"
#include "sessions/session/image_names.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/annotated_example.h"
#include "tests/support/bop_results.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using namespace sessions;

class AnnotationExchange : public testing::Test {
 protected:
  Pose solved(const std::string& id) const {
    return *solveCaseAnnotations(session_, id).camera_from_station();
  }
  static HandedPoses annotated(const Session& session, std::vector<std::string> ids = {}) {
    return annotatedPoses(session, ids);
  }
  std::string message(const std::function<void()>& call) const { return folder_.message(call); }

  TemporaryFolder folder_;
  Session session_ = annotatedExample(0.2);
  const std::string bc_ = caseOfStation(session_, "bc");
  const std::string os_ = caseOfStation(session_, "os");
};

TEST_F(AnnotationExchange, Colmap_ExportAndImport_IsEqualToTheBit) {
  const auto result = exportColmap(session_, folder_ / "model", annotated(session_, {bc_}));
  EXPECT_THAT(result.case_ids, ElementsAre(bc_));
  EXPECT_EQ(readColmapText(folder_ / "model").at(0).name, "bc/image.png");
  const auto read = importColmap(session_, folder_ / "model", true);
  EXPECT_THAT(read.case_ids, ElementsAre(bc_));
  EXPECT_TRUE(read.notes.empty());
  EXPECT_EQ(*read.session.findCase(bc_)->camera_from_station_truth, solved(bc_));
  // Nothing else has changed.
  SessionCase before = *session_.findCase(bc_);
  setTruth(before, solved(bc_), {TruthOrigin::kImported, "model", "", ""});
  EXPECT_TRUE(read.session == withCase(session_, before));
}

TEST_F(AnnotationExchange, Bop_ExportAndImport_UsesUndistortedImages) {
  EXPECT_THAT(exportBop(session_, folder_ / "scene", annotated(session_)).case_ids, SizeIs(2));
  const auto objects = readBopScene(folder_ / "scene");
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_NE(objects[0].object_id, objects[1].object_id);
  const auto read = importBop(session_, folder_ / "scene", true);
  EXPECT_THAT(read.case_ids, SizeIs(2));
  for (const std::string& id : {bc_, os_}) {
    const Pose& truth = *read.session.findCase(id)->camera_from_station_truth;
    EXPECT_LT(perturbationBetween(solved(id), truth).norm(), 1e-12);
  }
  // A pinhole with BOP's numbers sees a corner where the undistorted image has it.
  Camera camera = session_.cases[0]->camera;
  ASSERT_EQ(prepareCamera(camera), Status::kOk);
  const auto image = readImage(session_.cases[0]->image.source.file);
  EXPECT_EQ(readImage(folder_ / "scene/gray/000001.png").pixels,
            undistort(camera, image.view()).pixels);
}

TEST_F(AnnotationExchange, Points_ExportAndImport_AreEqual) {
  for (const char* name : {"points.json", "points.csv"}) {
    exportAnnotations(session_, bc_, folder_ / name);
    const Session without = withAnnotations(session_, bc_, {});
    const auto read = importAnnotations(without, bc_, folder_ / name, false);
    EXPECT_TRUE(read.session == session_) << name;
    // The same annotations once more are no others.
    EXPECT_TRUE(importAnnotations(session_, bc_, folder_ / name, false).session == session_);
    EXPECT_THAT(message([&] { (void)importAnnotations(session_, os_, folder_ / name, false); }),
                HasSubstr("already has other annotations"));
    EXPECT_EQ(*importAnnotations(session_, os_, folder_ / name, true).session.annotations.at(os_),
              *session_.annotations.at(bc_));
  }
}

TEST_F(AnnotationExchange, LandmarksAreAddedToThoseOfTheFile) {
  const std::vector<Landmark> before = {{"kept", {1, 2, 3}, "mine"}, {"p1", {9, 9, 9}, "old"}};
  writeLandmarks(folder_ / "l.json", before);
  exportLandmarks(session_, bc_, folder_ / "l.json");
  const auto after = readLandmarks(folder_ / "l.json");
  EXPECT_EQ(after, withAnnotations(before, *session_.annotations.at(bc_)));
  EXPECT_EQ(after.size(), 11u);
  EXPECT_EQ(after[0], before[0]);
  folder_.write("broken.json", std::string_view("{"));
  EXPECT_THROW(exportLandmarks(session_, bc_, folder_ / "broken.json"), InputError);
  EXPECT_EQ(folder_.read("broken.json"), "{");
}

TEST_F(AnnotationExchange, Export_OfUnsupportedCases_ReportsTheReason) {
  const auto colmap = [&](const Session& session, const std::vector<std::string>& ids) {
    return message([&] { (void)exportColmap(session, folder_ / "m", annotated(session, ids)); });
  };
  EXPECT_THAT(colmap(session_, {}), HasSubstr("have different stations"));
  EXPECT_THAT(colmap(session_, {"x"}), HasSubstr("there is no case 'x'"));
  const Session none = withAnnotations(withAnnotations(session_, bc_, {}), os_, {});
  EXPECT_THAT(colmap(none, {}), HasSubstr("no case has annotations"));
  EXPECT_THAT(colmap(none, {bc_}), HasSubstr("case '" + bc_ + "' has no pose: "));
  EXPECT_THAT(message([&] { exportAnnotations(none, bc_, folder_ / "p.json"); }),
              HasSubstr("has no annotations"));
  SessionCase moved = *session_.findCase(os_);
  moved.image.source.file = folder_ / "gone.png";
  const Session gone = withCase(session_, moved);
  EXPECT_THAT(message([&] { (void)exportBop(gone, folder_ / "s", annotated(gone)); }),
              HasSubstr("gone.png"));
  // No half-written folder.
  EXPECT_EQ(folder_.fileCount(), 0u);
  // One case without a pose does not keep the others from being written.
  auto few = *session_.annotations.at(os_);
  few.points.resize(2);
  const Session session = withAnnotations(session_, os_, few);
  const auto result = exportBop(session, folder_ / "s", annotated(session));
  EXPECT_THAT(result.case_ids, ElementsAre(bc_));
  EXPECT_THAT(result.notes, ElementsAre(HasSubstr("case '" + os_ + "' has no pose: ")));
}

TEST_F(AnnotationExchange, Import_OfUnsupportedFiles_ReportsTheReason) {
  PosedImage image{1, "bc/image.png", session_.findCase(bc_)->camera, Pose()};
  ASSERT_EQ(prepareCamera(image.camera), Status::kOk);
  image.camera_from_station.translation_m.z() = 0.5;
  const auto read = [&](std::vector<PosedImage> images, bool replace) {
    writeColmapText(folder_ / "", images);
    return message([&] { (void)importColmap(session_, folder_ / "", replace); });
  };
  EXPECT_EQ(read({image}, true), "(nothing)");
  EXPECT_THAT(read({image}, false), HasSubstr("already has another truth"));
  PosedImage other = image;
  other.id = 2;
  EXPECT_THAT(read({image, other}, true), HasSubstr("two of the poses"));
  other.name = "image.png";
  EXPECT_THAT(read({other}, true), HasSubstr("may be the image of case"));
  other.name = "stranger.png";
  EXPECT_THAT(read({other}, true), HasSubstr("'stranger.png' is no case's"));
  EXPECT_EQ(read({image, other}, true), "(nothing)");
  other = image;
  other.camera.fx += 0.01;
  EXPECT_THAT(read({other}, true), HasSubstr("its camera is not that of case"));
  EXPECT_THAT(message([&] { (void)importBop(session_, folder_ / "none", true); }),
              HasSubstr("scene_camera.json"));
}

TEST(ImageNames, AreRelativeToWhatHoldsAllImages) {
  Session session;
  Random random = randomFor("ImageNames");
  for (const char* file : {"/data/a/000012.png", "/data/b/7.png", "/data/b/c/3.png"}) {
    SessionCase session_case = randomCase(random, file);
    session_case.image.source.file = file;
    session = withCase(session, session_case);
  }
  EXPECT_THAT(imageNames(session), ElementsAre("a/000012.png", "b/7.png", "b/c/3.png"));
  EXPECT_THAT(imageNumbers(session), ElementsAre(12, 7, 3));
  EXPECT_THAT(stationNumbers(session), ElementsAre(1, 2, 3));
  SessionCase again = *session.cases[0];
  again.id = "again";
  again.image.source.file = "/data/a/left.png";
  session = withCase(session, again);
  EXPECT_THAT(imageNumbers(session), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(stationNumbers(session), ElementsAre(1, 2, 3, 1));
  for (const char* end : {"b/7.png", "./7.png"}) EXPECT_TRUE(isEndOf(end, "/data/b/7.png")) << end;
  EXPECT_FALSE(isEndOf("7.png", "/data/b/17.png"));
  for (const char* end : {"a/7.png", ""}) EXPECT_FALSE(isEndOf(end, "/data/b/7.png")) << end;
}

TEST_F(AnnotationExchange, TruthThatIsTheExportedPoseOfARun_IsNamedAsSuch) {
  session_.options = {{"search.enabled", false}};
  const LocalizationTrace trace = runCase(session_, os_);
  ASSERT_TRUE(trace.converged());
  session_ = withRun(session_, storeRun(session_, os_, trace, folder_ / "s.boresight.json"));
  exportBop(session_, folder_ / "scene", posesToHandOver(session_, {os_}));
  const ImportReport report = importBop(session_, folder_ / "scene", true);
  EXPECT_THAT(report.notes, Contains(HasSubstr("is the pose of its run")));
  const SessionCase& imported = *report.session.findCase(os_);
  ASSERT_TRUE(imported.truth_source);
  EXPECT_EQ(imported.truth_source->origin, TruthOrigin::kRun);
  EXPECT_EQ(imported.truth_source->run, trace.digest);
  EXPECT_EQ(judgingTruth(imported), nullptr);
  EXPECT_FALSE(truthError(*loadCase(imported), trace.camera_from_station));
}

/// Both stations are annotated, the annotations of the OS one validated.
class PoseExchange : public AnnotationExchange {
 protected:
  PoseExchange() {
    session_ = annotatedExample(0.1);
    const auto subject =
        reviewSubject(session_, loadCase(*session_.findCase(os_)), PoseSource::kAnnotation);
    session_ = validated(session_, subject, {JudgedCase::check("coverage", CheckState::kPassed)},
                         {}, {"Ada", "right"});
  }
};

TEST_F(PoseExchange, EveryFile_StatesTheReviewStatus) {
  exportColmap(session_, folder_ / "os", posesToHandOver(session_, {os_}));
  exportColmap(session_, folder_ / "bc", posesToHandOver(session_, {bc_}));
  EXPECT_THAT(folder_.read("os/images.txt"), HasSubstr("image.png: validated by Ada"));
  EXPECT_THAT(folder_.read("bc/images.txt"), HasSubstr("image.png: NOT VALIDATED: annotated"));
  exportBop(session_, folder_ / "bop", posesToHandOver(session_, {}));
  const std::string truth = folder_.read("bop/scene_gt.json");
  EXPECT_THAT(truth, AllOf(HasSubstr("\"remark\": \"validated by Ada\""),
                           HasSubstr("\"remark\": \"NOT VALIDATED: annotated\"")));
  // Another pose of a validated case is not the validated one.
  HandedPoses other = posesToHandOver(session_, {os_});
  other.poses[0].camera_from_station.translation_m.x() += 1e-9;
  exportColmap(session_, folder_ / "other", other);
  EXPECT_THAT(folder_.read("other/images.txt"),
              HasSubstr("NOT VALIDATED: the validation is of another pose"));
}

TEST_F(PoseExchange, ResultsThatAreNotValidatedNeedANameThatSaysSo) {
  EXPECT_THROW(exportBopResults(session_, folder_ / "r.csv", {}, 1), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r.csv"));
  EXPECT_EQ(exportBopResults(session_, folder_ / "r.csv", {os_}, 1).case_ids.size(), 1u);
  const auto named = folder_ / "a-NOT-VALIDATED_os-test.csv";
  EXPECT_EQ(exportBopResults(session_, named, {}, 7).case_ids.size(), 2u);
  const auto read = readBopResults(named);
  EXPECT_EQ(read[0].scene_id, 7);
  EXPECT_NE(read[0].object_id, read[1].object_id);
}

TEST_F(PoseExchange, PoseThatItsAnnotationsContradict_IsLeftOut) {
  session_.decisions.back().pose->camera_from_station.translation_m.z() = 0.5;
  EXPECT_THROW(posesToHandOver(session_, {os_}), InputError);
  const HandedPoses others = posesToHandOver(session_, {});
  EXPECT_EQ(others.poses.size(), 1u);
  EXPECT_THAT(others.notes, ElementsAre(HasSubstr("the pose differs")));
}

}  // namespace
}  // namespace boresight::test
