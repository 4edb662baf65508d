// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_maker.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/input_sheet.h"
#include "sessions/session/session_file.h"
#include "sessions/session/stated_inputs.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using namespace sessions;

const std::filesystem::path kDataset = exampleFolder() / "dataset.json";

SessionCase firstExample() { return *makeSession(kDataset).cases[0]; }

/// The session of a copy of the example whose data set is changed.
template <class Change>
Session sessionOfChanged(const TemporaryFolder& folder, Change&& change) {
  const std::filesystem::path file = folder / "stations/dataset.json";
  auto json = nlohmann::json::parse(folder.read("stations/dataset.json"));
  change(json);
  folder.write("stations/dataset.json", json.dump());
  return makeSession(file);
}

TEST(SessionMaker, SaysWhichFileIsWrong) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const auto message = [&](void (*spoil)(CaseFiles&)) {
    CaseFiles files = filesOf(stations / "os");
    spoil(files);
    return folder.message([&] { (void)makeCase(files); });
  };
  EXPECT_EQ(message([](auto&) {}), "(nothing)");
  EXPECT_THAT(message([](auto& f) { f.image = "none.png"; }), HasSubstr("none.png: no such file"));
  EXPECT_THAT(message([](auto& f) { f.image = f.camera; }), HasSubstr("os/camera.json: "));
  EXPECT_THAT(message([](auto& f) { f.camera = f.seed; }), HasSubstr("os/seed.json: format: is"));
  EXPECT_THAT(message([](auto& f) { f.seed = f.camera; }), HasSubstr("os/camera.json: format: is"));
  EXPECT_THAT(message([](auto& f) { f.parts[0].mesh_unit = ""; }), HasSubstr("model.ply: "));
  EXPECT_THAT(message([](auto& f) { f.parts[0].mesh = f.image; }), HasSubstr("os/image.png: "));
  EXPECT_THAT(message([](auto& f) { f.parts.clear(); }), HasSubstr("no part"));
  EXPECT_THAT(message([](auto& f) { f.eight_bit.bit_depth = 12; }),
              HasSubstr("bit_depth: 12 bits"));
  EXPECT_THAT(message([](auto& f) { f.ignore = f.seed; }), HasSubstr("os/seed.json: "));
  EXPECT_THAT(message([](auto& f) { f.truth = "gone.json"; }),
              HasSubstr("gone.json: no such file"));
  EXPECT_THAT(folder.message([&] { (void)makeSession(stations / "dataset.json", {"x"}); }),
              HasSubstr("dataset.json: cases: there is no case 'x'"));
}

TEST(SessionMaker, ADatasetAndItsFilesMakeTheSameRun) {
  const Session session = makeSession(kDataset);
  ASSERT_EQ(session.cases.size(), 2u);
  // The digests of the shipped cases before parts had names, frames and states.
  EXPECT_EQ(inputsDigest(*session.cases[0]),
            "4e00d12e9b2e345ef840c3ba016df34a73b1de8386f343fba095c52f99a33618");
  EXPECT_EQ(inputsDigest(*session.cases[1]),
            "2f2504644b1536f88ea047a97a78a2bba37f5d36a46fc31504ab216ca1e7c1aa");
  for (const auto& session_case : session.cases) {
    CaseFiles files = filesOf(exampleFolder() / session_case->station);
    files.camera_from_end_effector = session_case->camera_from_end_effector;
    const MadeCase new_case = makeCase(files);
    EXPECT_THAT(new_case.notes, IsEmpty());
    EXPECT_EQ(inputsDigest(new_case.made), inputsDigest(*session_case)) << session_case->id;
    EXPECT_TRUE(session_case->requirement);
    EXPECT_TRUE(session_case->feature_size_m);
    EXPECT_TRUE(session_case->camera_from_station_truth == new_case.made.camera_from_station_truth);
  }
  const Session only = makeSession(kDataset, {session.cases[1]->id});
  ASSERT_EQ(only.cases.size(), 1u);
  EXPECT_TRUE(only.cases[0] == session.cases[1]);
}

TEST(SessionMaker, RequirementOfTheDataset_SelectsTheCheckPreset) {
  EXPECT_EQ(makeSession(kDataset).review.preset, "sample_transfer");
  const TemporaryFolder folder;
  copyOfExamples(folder);
  const Session photographs = sessionOfChanged(folder, [](auto& json) {
    json["requirement"] = {{"projection_px", 5.0}};
  });
  EXPECT_EQ(photographs.review.preset, "photographs");
  const Session different = sessionOfChanged(folder, [](auto& json) {
    json["cases"][0]["requirement"] = {
        {"normal_mm", 1.0}, {"lateral_mm", 1.0}, {"rotation_deg", 1.0}};
  });
  EXPECT_EQ(different.review.preset, "sample_transfer");
}

TEST(SessionMaker, SigmasAndTruth_OfTheDataset_AreKept) {
  const TemporaryFolder folder;
  CaseFiles files = filesOf(copyOfExamples(folder) / "os");
  const Session stated = sessionOfChanged(folder, [](auto& json) {
    for (auto& station : json["stations"]) {
      station["mesh_scale_sigma"] = 0.001;
      station["symmetries"]["continuous"] = {{{"axis", {0, 0, 2}}, {"point_m", {0.1, 0, 0}}}};
    }
    for (auto& camera : json["cameras"])
      camera["calibration_sigma"] = {{"focal_relative", 0.003}, {"principal_point_px", 2.0}};
  });
  for (const auto& session_case : stated.cases) {
    EXPECT_EQ(session_case->mesh_scale_sigma, 0.001);
    EXPECT_EQ(symmetriesText(session_case->symmetries), "z at 0.1 0 0");
    EXPECT_EQ(session_case->calibration_sigma, (StatedCalibration{0.003, 2.0}));
  }
  files.mesh_scale_sigma = 0.002;
  const Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  files.truth = folder / "truth.json";
  writePose(*files.truth, Pose(), {}, covariance);
  const SessionCase result = makeCase(files).made;
  EXPECT_EQ(result.mesh_scale_sigma, 0.002);
  EXPECT_EQ(result.truth_covariance, covariance);
}

/// The example's camera as vectors in a frame of the rover, with a covariance.
CahvorFile vectorsWithCovariance(const Camera& camera) {
  Camera linear = camera;
  linear.model = CameraModel::kCahv;
  linear.distortion = {};
  EXPECT_EQ(prepareCamera(linear), Status::kOk);
  Random random(7);
  const Eigen::VectorXd sigma = Eigen::VectorXd::LinSpaced(12, 1e-4, 1e-3);
  CahvorFile file{cahvFromCamera(linear, randomPose(random)), 1024, 1024, {}, {}};
  file.covariance = sigma * sigma.transpose();
  file.covariance.diagonal() *= 2.0;
  return file;
}

TEST(SessionMaker, CovarianceOfACamerasVectors_IsPartOfTheSessionAndOfItsFile) {
  const TemporaryFolder folder;
  CaseFiles files = filesOf(copyOfExamples(folder) / "os");
  const CahvorFile vectors = vectorsWithCovariance(makeCase(files).made.camera);
  files.camera = folder / "os.cahv";
  writeCahvorFile(files.camera, vectors);
  const SessionCase session_case = makeCase(files).made;
  ASSERT_TRUE(session_case.camera_covariance);
  const InputSigmas sigmas(session_case);
  EXPECT_TRUE(sigmas.calibration_derived);
  EXPECT_THAT(calibrationText(sigmas), HasSubstr("by the camera's covariance"));
  const Session session = withCase({}, session_case);
  (void)writeSessionFile(folder / "a.boresight.json", session);
  EXPECT_TRUE(readSessionFile(folder / "a.boresight.json").session == session);
  SessionCase without = session_case;
  without.camera_covariance.reset();
  EXPECT_FALSE(without == session_case);
  EXPECT_EQ(inputsDigest(without), inputsDigest(session_case)) << "no run depends on it";
}

TEST(InputSigmas, AreStatedForAllCasesOfTheMeshAndOfTheCamera) {
  Session session = makeSession(kDataset);
  SessionCase other = *session.cases[0];
  other.id = "same mesh";
  other.camera.fx += 1.0;
  session = withCase(session, other);
  other = *session.cases[1];
  other.id = "same camera";
  other.camera = session.cases[0]->camera;
  session = withCase(session, other);
  const Session stated =
      withInputSigmas(session, session.cases[0]->id, 1e-3, StatedCalibration{2e-4, 0.5});
  EXPECT_EQ(stated.cases[0]->mesh_scale_sigma, 1e-3);
  EXPECT_EQ(stated.findCase("same mesh")->mesh_scale_sigma, 1e-3);
  EXPECT_FALSE(stated.findCase("same mesh")->calibration_sigma);
  EXPECT_FALSE(stated.findCase("same camera")->mesh_scale_sigma);
  EXPECT_TRUE(stated.findCase("same camera")->calibration_sigma);
  EXPECT_TRUE(withInputSigmas(stated, session.cases[0]->id, {}, {}) == session);
  EXPECT_EQ(inputsDigest(*stated.cases[0]), inputsDigest(*session.cases[0]))
      << "no run depends on them";
}

TEST(SessionMaker, TheSessionThatShipsIsMadeOfTheDatasetThatShips) {
  const auto file = exampleFolder().parent_path() / "example.boresight.json";
  const Session shipped = readSessionFile(file).session;
  EXPECT_TRUE(shipped == makeSession(kDataset));
  EXPECT_THAT(checkInputs(shipped), IsEmpty());
}

TEST(SessionMaker, DigestsTellInputsApartThatMatter) {
  const SessionCase session_case = firstExample();
  const std::string digest = inputsDigest(session_case);
  const auto changed = [&](void (*change)(SessionCase&)) {
    SessionCase other = session_case;
    change(other);
    return inputsDigest(other) != digest;
  };
  EXPECT_FALSE(changed([](auto& c) { c.id = "other"; }));
  EXPECT_FALSE(changed([](auto& c) { c.tags = {"new"}; }));
  EXPECT_FALSE(changed([](auto& c) { c.camera_from_station_truth.reset(); }));
  EXPECT_FALSE(changed([](auto& c) { c.image.source.file = "/moved"; }));
  EXPECT_FALSE(changed([](auto& c) { c.landmarks = "/landmarks.json"; }));
  EXPECT_TRUE(changed([](auto& c) { c.image.pixels_sha256[0] ^= 1; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].sha256[0] ^= 1; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.mesh_unit = "mm"; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.frame_from_mesh.translation_m.x() = 1; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.normal_threshold_rad *= 2; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.state.role = PartRole::kOccludes; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.state.present = false; }));
  EXPECT_FALSE(changed([](auto& c) { c.parts[0].source.name = "station"; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.albedo = 0.42; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts.push_back(c.parts[0]); }));
  EXPECT_TRUE(changed([](auto& c) { c.camera.fx += 1e-9; }));
  EXPECT_TRUE(changed([](auto& c) { c.camera_from_station_seed.translation_m.z() += 1e-9; }));
  EXPECT_TRUE(changed([](auto& c) { c.uncertainty.rotation_deg.x() = 1.0; }));
  EXPECT_TRUE(changed([](auto& c) { c.uncertainty.pivot = UncertaintyPivot::kStation; }));
  EXPECT_TRUE(changed([](auto& c) { c.ignore = InputFile{"/m", std::string(64, 'a')}; }));
  EXPECT_TRUE(changed([](auto& c) { c.ignore_strokes.emplace_back(); }));
  EXPECT_TRUE(changed([](auto& c) { c.has_seed = false; }));
}

/// A part of a named frame, joined to the camera by a transform.
SessionCase withGripper(SessionCase session_case, double ahead_m) {
  FrameTransform transform;
  transform.target = kCameraFrame;
  transform.source = kEndEffectorFrame;
  transform.target_from_source.translation_m.z() = ahead_m;
  transform.comment = "by hand";
  transform.file = "frames.json";
  transform.file_sha256 = std::string(64, 'a');
  session_case.frames = {transform};
  MeshInput gripper = session_case.parts[0];
  gripper.source.frame = kEndEffectorFrame;
  gripper.source.state.role = PartRole::kOccludes;
  session_case.parts.push_back(gripper);
  return session_case;
}

TEST(SessionMaker, Digest_FollowsThePlaceOfAPartInANamedFrame) {
  const SessionCase plain = firstExample();
  SessionCase near = withGripper(plain, 0.25);
  const SessionCase far = withGripper(plain, 0.5);
  EXPECT_NE(inputsDigest(near), inputsDigest(far));
  // The same place, given in the camera frame.
  SessionCase by_hand = near;
  by_hand.frames.clear();
  by_hand.parts[1].source.frame = kCameraFrame;
  by_hand.parts[1].source.frame_from_mesh.translation_m.z() = 0.25;
  EXPECT_EQ(inputsDigest(by_hand), inputsDigest(near));
  // A part that the core is not given is no input.
  for (const PartState& state :
       {PartState{PartRole::kIgnored, true}, PartState{PartRole::kOccludes, false}}) {
    near.parts[1].source.state = state;
    EXPECT_EQ(inputsDigest(near), inputsDigest(plain));
  }
}

TEST(SessionMaker, GripperOfANamedFrame_IsLoadedInTheCameraFrame) {
  SessionCase session_case = withGripper(firstExample(), 0.25);
  // The seed's chain does not matter: the part moves with the camera.
  const auto loaded = loadCase(session_case);
  const MeshView view = loaded->scene.view();
  ASSERT_EQ(validateMesh(view), Status::kOk);
  ASSERT_EQ(view.parts.size(), 2u);
  EXPECT_TRUE(view.parts[1].fixed_to_camera);
  const std::size_t first = firstVertexInCamera(view);
  ASSERT_EQ(2 * first, view.vertices_in_station_m.size());
  for (std::size_t i = 0; i < first; ++i)
    EXPECT_NEAR(view.vertices_in_station_m[first + i].z(),
                view.vertices_in_station_m[i].z() + 0.25F, 1e-6F);
  session_case.frames.clear();
  const TemporaryFolder folder;
  EXPECT_THAT(folder.message([&] { (void)loadCase(session_case); }),
              HasSubstr("frame: END_EFFECTOR is joined to neither CAMERA nor STATION"));
  // A reload sees that only the transform has changed.
  const auto reloaded = reloadCase(*loaded, withGripper(firstExample(), 0.5));
  EXPECT_NEAR(reloaded->scene.vertices_in_station_m[first].z(),
              view.vertices_in_station_m[0].z() + 0.5F, 1e-6F);
}

TEST(SessionMaker, StatesOfADataset_ReachTheCases) {
  const TemporaryFolder folder;
  copyOfExamples(folder);
  const Session session = sessionOfChanged(folder, [](auto& json) {
    for (auto& station : json["stations"]) {
      const nlohmann::json part = {{"mesh", station["mesh"]}, {"mesh_unit", station["mesh_unit"]}};
      nlohmann::json lid = part;
      lid.update({{"name", "lid"}, {"role", "occludes"}, {"present", false}});
      station.erase("mesh");
      station.erase("mesh_unit");
      station["parts"] = {part, lid};
    }
    json["cases"][1]["state"] = {{"lid", "on"}};
  });
  EXPECT_FALSE(session.cases[0]->parts[1].source.state.present);
  EXPECT_EQ(session.cases[1]->parts[1].source.state, (PartState{PartRole::kOccludes, true}));
  EXPECT_EQ(session.cases[0]->parts[1].sha256.size(), 64u) << "also of a part that is off";
  writeSessionFile(folder / "s.json", session);
  EXPECT_TRUE(readSessionFile(folder / "s.json").session == session);
}

TEST(WithPartState, ChangesOnePartAndLeavesAMatchedOne) {
  const Session session = withCase({}, withGripper(firstExample(), 0.25));
  const std::string id = session.cases[0]->id;
  const Session off = withPartState(session, id, 1, PartState{PartRole::kOccludes, false});
  EXPECT_FALSE(off.cases[0]->parts[1].source.state.present);
  EXPECT_EQ(off.cases[0]->parts[0], session.cases[0]->parts[0]);
  EXPECT_TRUE(withPartState(off, id, 1, {PartRole::kOccludes, true}) == session);
  const TemporaryFolder folder;
  const auto message = [&](std::size_t part, const PartState& state) {
    return folder.message([&] { (void)withPartState(session, id, part, state); });
  };
  EXPECT_THAT(message(0, {PartRole::kMatched, false}), HasSubstr("is the only matched part"));
  EXPECT_THAT(message(0, {PartRole::kIgnored, true}), HasSubstr("is the only matched part"));
  EXPECT_THAT(message(1, {PartRole::kMatched, true}), HasSubstr("fixed to the camera"));
  EXPECT_THAT(message(2, {}), HasSubstr("there is no part 2"));
  EXPECT_THAT(folder.message([&] { (void)withPartState(session, "moon", 0, {}); }),
              HasSubstr("there is no case 'moon'"));
}

TEST(SessionMaker, CaseWithoutSeed_IsReadBackAndNotRun) {
  const TemporaryFolder folder;
  CaseFiles files = filesOf(exampleFolder() / "os");
  files.seed.clear();
  const MadeCase made = makeCase(files);
  EXPECT_FALSE(made.made.has_seed);
  EXPECT_THAT(made.notes, IsEmpty()) << "nothing is said of an uncertainty of nothing";
  const Session session = withCase({}, made.made);
  writeSessionFile(folder / "s.json", session);
  EXPECT_EQ(folder.read("s.json").find("\"seed\""), std::string::npos);
  EXPECT_TRUE(readSessionFile(folder / "s.json").session == session);
  const auto loaded = loadCase(made.made);
  EXPECT_THAT(folder.message([&] { requireRunnable(*loaded); }), HasSubstr("annotate the case"));
  for (const RedFlag& flag : inputSheet(*loaded).flags)
    EXPECT_THAT(flag.text, Not(HasSubstr("seed")));
}

}  // namespace
}  // namespace boresight::test
