// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_maker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sessions/io/pose_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/input_sheet.h"
#include "sessions/session/input_sigmas.h"
#include "sessions/session/session_file.h"
#include "tests/sessions/session/example_session.h"

namespace boresight::test {
namespace {

using sessions::Session;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(SessionMaker, SaysWhichFileIsWrong) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const auto message = [&](const std::function<void(sessions::CaseFiles&)>& spoil) {
    sessions::CaseFiles files = filesOf(stations / "os");
    spoil(files);
    return folder.message([&] { (void)sessions::makeCase(files); });
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
  EXPECT_THAT(
      folder.message([&] { (void)sessions::makeSession(stations / "dataset.json", {"x"}); }),
      HasSubstr("dataset.json: cases: there is no case 'x'"));
}

TEST(SessionMaker, ADatasetAndItsFilesMakeTheSameRun) {
  const Session session = sessions::makeSession(exampleFolder() / "dataset.json");
  ASSERT_EQ(session.cases.size(), 2u);
  for (const auto& session_case : session.cases) {
    sessions::CaseFiles files = filesOf(exampleFolder() / session_case->station);
    files.camera_from_end_effector = session_case->camera_from_end_effector;
    const sessions::MadeCase new_case = sessions::makeCase(files);
    EXPECT_THAT(new_case.notes, IsEmpty());
    EXPECT_EQ(sessions::inputsDigest(new_case.made), sessions::inputsDigest(*session_case))
        << session_case->id;
    EXPECT_TRUE(session_case->requirement);
    EXPECT_TRUE(session_case->feature_size_m);
    EXPECT_TRUE(session_case->camera_from_station_truth == new_case.made.camera_from_station_truth);
  }
  const Session only =
      sessions::makeSession(exampleFolder() / "dataset.json", {session.cases[1]->id});
  ASSERT_EQ(only.cases.size(), 1u);
  EXPECT_TRUE(only.cases[0] == session.cases[1]);
}

TEST(SessionMaker, RequirementOfTheDataset_SelectsTheCheckPreset) {
  const TemporaryFolder folder;
  const std::filesystem::path file = copyOfExamples(folder) / "dataset.json";
  EXPECT_EQ(sessions::makeSession(file).review.preset, "sample_transfer");
  auto json = nlohmann::json::parse(folder.read("stations/dataset.json"));
  json["requirement"] = {{"projection_px", 5.0}};
  folder.write("stations/dataset.json", json.dump());
  EXPECT_EQ(sessions::makeSession(file).review.preset, "photographs");
  json["cases"][0]["requirement"] = {
      {"normal_mm", 1.0}, {"lateral_mm", 1.0}, {"rotation_deg", 1.0}};
  folder.write("stations/dataset.json", json.dump());
  EXPECT_EQ(sessions::makeSession(file).review.preset, "sample_transfer") << "they differ";
}

TEST(SessionMaker, SigmasAndTruth_OfTheDataset_AreKept) {
  const TemporaryFolder folder;
  const std::filesystem::path file = copyOfExamples(folder) / "dataset.json";
  auto json = nlohmann::json::parse(folder.read("stations/dataset.json"));
  for (auto& station : json["stations"]) station["mesh_scale_sigma"] = 0.001;
  for (auto& camera : json["cameras"])
    camera["calibration_sigma"] = {{"focal_relative", 0.003}, {"principal_point_px", 2.0}};
  folder.write("stations/dataset.json", json.dump());
  for (const auto& session_case : sessions::makeSession(file).cases) {
    EXPECT_EQ(session_case->mesh_scale_sigma, 0.001);
    EXPECT_EQ(session_case->calibration_sigma, (sessions::CalibrationSigma{0.003, 2.0}));
  }
  sessions::CaseFiles files = filesOf(file.parent_path() / "os");
  files.mesh_scale_sigma = 0.002;
  Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  files.truth = folder / "truth.json";
  sessions::writePose(*files.truth, Pose(), {}, covariance);
  const sessions::SessionCase result = sessions::makeCase(files).made;
  EXPECT_EQ(result.mesh_scale_sigma, 0.002);
  EXPECT_EQ(result.truth_covariance, covariance);
}

TEST(InputSigmas, AreStatedForAllCasesOfTheMeshAndOfTheCamera) {
  Session session = sessions::makeSession(exampleFolder() / "dataset.json");
  sessions::SessionCase other = *session.cases[0];
  other.id = "same mesh";
  other.camera.fx += 1.0;
  session = withCase(session, other);
  other = *session.cases[1];
  other.id = "same camera";
  other.camera = session.cases[0]->camera;
  session = withCase(session, other);
  const Session stated =
      sessions::withInputSigmas(session, session.cases[0]->id, 1e-3, sessions::CalibrationSigma{});
  EXPECT_EQ(stated.cases[0]->mesh_scale_sigma, 1e-3);
  EXPECT_EQ(stated.findCase("same mesh")->mesh_scale_sigma, 1e-3);
  EXPECT_FALSE(stated.findCase("same mesh")->calibration_sigma);
  EXPECT_FALSE(stated.findCase("same camera")->mesh_scale_sigma);
  EXPECT_TRUE(stated.findCase("same camera")->calibration_sigma);
  EXPECT_TRUE(sessions::withInputSigmas(stated, session.cases[0]->id, {}, {}) == session);
  EXPECT_EQ(sessions::inputsDigest(*stated.cases[0]), sessions::inputsDigest(*session.cases[0]))
      << "no run depends on them";
}

TEST(SessionMaker, TheSessionThatShipsIsMadeOfTheDatasetThatShips) {
  const auto file = exampleFolder().parent_path() / "example.boresight.json";
  const Session shipped = sessions::readSessionFile(file).session;
  EXPECT_TRUE(shipped == sessions::makeSession(exampleFolder() / "dataset.json"));
  EXPECT_THAT(sessions::checkInputs(shipped), IsEmpty());
}

TEST(SessionMaker, DigestsTellInputsApartThatMatter) {
  const sessions::SessionCase session_case =
      *sessions::makeSession(exampleFolder() / "dataset.json").cases[0];
  const std::string digest = sessions::inputsDigest(session_case);
  const auto changed = [&](const std::function<void(sessions::SessionCase&)>& change) {
    sessions::SessionCase other = session_case;
    change(other);
    return sessions::inputsDigest(other) != digest;
  };
  EXPECT_FALSE(changed([](auto& c) { c.id = "other"; }));
  EXPECT_FALSE(changed([](auto& c) { c.tags = {"new"}; }));
  EXPECT_FALSE(changed([](auto& c) { c.camera_from_station_truth.reset(); }));
  EXPECT_FALSE(changed([](auto& c) { c.image.source.file = "/moved"; }));
  EXPECT_TRUE(changed([](auto& c) { c.image.pixels_sha256[0] ^= 1; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].sha256[0] ^= 1; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.mesh_unit = "mm"; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.station_from_mesh.translation_m.x() = 1; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.part.normal_threshold_rad *= 2; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.part.match = false; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts[0].source.albedo = 0.42; }));
  EXPECT_TRUE(changed([](auto& c) { c.parts.push_back(c.parts[0]); }));
  EXPECT_TRUE(changed([](auto& c) { c.camera.fx += 1e-9; }));
  EXPECT_TRUE(changed([](auto& c) { c.camera_from_station_seed.translation_m.z() += 1e-9; }));
  EXPECT_TRUE(changed([](auto& c) { c.uncertainty.rotation_deg.x() = 1.0; }));
  EXPECT_TRUE(changed([](auto& c) { c.uncertainty.pivot = sessions::UncertaintyPivot::kStation; }));
  EXPECT_TRUE(changed([](auto& c) { c.ignore = sessions::InputFile{"/m", std::string(64, 'a')}; }));
  EXPECT_TRUE(changed([](auto& c) { c.ignore_strokes.emplace_back(); }));
  EXPECT_TRUE(changed([](auto& c) { c.has_seed = false; }));
}

TEST(SessionMaker, CaseWithoutSeed_IsReadBackAndNotRun) {
  const TemporaryFolder folder;
  sessions::CaseFiles files = filesOf(exampleFolder() / "os");
  files.seed.clear();
  const sessions::MadeCase made = sessions::makeCase(files);
  EXPECT_FALSE(made.made.has_seed);
  EXPECT_THAT(made.notes, IsEmpty()) << "nothing is said of an uncertainty of nothing";
  const Session session = withCase({}, made.made);
  sessions::writeSessionFile(folder / "s.json", session);
  EXPECT_EQ(folder.read("s.json").find("\"seed\""), std::string::npos);
  EXPECT_TRUE(sessions::readSessionFile(folder / "s.json").session == session);
  const auto loaded = sessions::loadCase(made.made);
  EXPECT_THAT(folder.message([&] { sessions::requireRunnable(*loaded); }),
              HasSubstr("annotate the case"));
  const sessions::InputSheet sheet = sessions::inputSheet(*loaded);
  for (const sessions::RedFlag& flag : sheet.flags)
    EXPECT_EQ(flag.text.find("seed"), std::string::npos) << flag.text;
}

}  // namespace
}  // namespace boresight::test
