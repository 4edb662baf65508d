// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/validated_pose_file.h"

#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_writer.h"
#include "sessions/review/decide.h"
#include "sessions/review/pose_uncertainty.h"
#include "sessions/review/standing.h"
#include "sessions/review/verify_pose.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/support/marked_example.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using sessions::HandedPose;
using sessions::Session;
using sessions::VerifyReport;
using testing::HasSubstr;

/// The example's OS station, run and marked, in a folder of its own with its files.
class ValidatedPose : public testing::Test {
 protected:
  void SetUp() override {
    fs::copy(exampleFolder(), folder_ / "stations", fs::copy_options::recursive);
    const Session both = sessions::makeSession(folder_ / "stations" / "dataset.json");
    id_ = caseOfStation(both, "os");
    session_ = withoutCase(both, caseOfStation(both, "bc"));
    Random random = randomFor("ValidatedPose");
    session_ =
        withAnnotation(session_, id_, marksOf(spreadCorners(ExampleCase("os"), 8), 0.1, random));
    sessions::SessionCase one = *session_.findCase(id_);
    one.camera_from_end_effector = randomPose(random);
    session_ = withCase(session_, one);
  }

  void run() {
    const auto trace = runCase(session_, id_, sessions::RecordLevel::kFull);
    ASSERT_TRUE(trace.converged());
    session_ = withRun(session_, storeRun(session_, id_, trace, folder_ / "s.boresight.json"));
    subject_.loaded = sessions::loadCase(*session_.findCase(id_));
    subject_.camera_from_station = trace.camera_from_station;
    subject_.covariance = poseCovariance(*session_.findCase(id_), subject_.loaded->scene.view(),
                                         trace.camera_from_station, trace.covariance);
    subject_.run = sessions::snapshotOf(sessions::LocalizationTrace(trace));
  }

  void validate() {
    session_ = validated(session_, subject_,
                         {JudgedCase::check("converged", sessions::CheckState::kPassed),
                          JudgedCase::check("coverage", sessions::CheckState::kFailed)},
                         {{"coverage", "the shadow of the arm"}}, {"Ada", "right"});
  }

  fs::path write() {
    const fs::path file = folder_ / "validated_pose.json";
    writeValidatedPose(file, session_, handedPose(session_, id_));
    return file;
  }

  static ordered_json read(const fs::path& file) {
    std::ifstream stream(file);
    return ordered_json::parse(stream);
  }

  /// Signed anew, as somebody who means harm would.
  static void resign(ordered_json& json, const fs::path& file) {
    json["signature"] = sessions::signatureOf(ordered_json::parse(sessions::prettyJson(json)));
    sessions::writeJsonFile(file, json);
  }

  static std::string wrongsOf(const VerifyReport& report) {
    std::string text;
    for (const auto& finding : report.findings)
      if (!finding.good) text += finding.what + ": " + finding.text + "\n";
    return text;
  }

  TemporaryFolder folder_;
  Session session_;
  std::string id_;
  sessions::ReviewSubject subject_;
};

TEST_F(ValidatedPose, HoldsWhatAReviewerAsksForAndVerifies) {
  run();
  validate();
  const fs::path file = write();
  const ordered_json json = read(file);
  EXPECT_EQ(json["state"], "validated");
  EXPECT_EQ(json["standing"], "validated by Ada");
  EXPECT_EQ(json["checks"][1]["override_reason"], "the shadow of the arm");
  EXPECT_EQ(json["sha256"]["image_pixels"], session_.findCase(id_)->image.pixels_sha256);
  EXPECT_EQ(json["run"]["digest"], subject_.run->digest);
  EXPECT_GT(json["run"]["matches"].size(), 20u);
  EXPECT_EQ(json["chain"].back()["from"], "run " + subject_.run->digest);
  const Pose& camera_from_station = subject_.camera_from_station;
  EXPECT_EQ(json["pose"]["camera_from_station"][0][3], camera_from_station.translation_m.x());
  EXPECT_EQ(json["pose"]["station_from_camera"][2][3],
            camera_from_station.inverse().translation_m.z());
  EXPECT_TRUE(json["end_effector"].contains("end_effector_seed_from_end_effector_estimated"));

  const VerifyReport report = sessions::verifyPose(file, true);
  EXPECT_TRUE(report.good()) << wrongsOf(report);
  EXPECT_EQ(report.standing, "validated by Ada");
}

Matrix6d matrixOf(const ordered_json& json) {
  Matrix6d matrix;
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 6; ++column)
      matrix(static_cast<int>(row), static_cast<int>(column)) = json[row][column].get<double>();
  return matrix;
}

TEST_F(ValidatedPose, ItsCovarianceIsTheSumOfNamedTermsAndSaysByWhichSigmas) {
  sessions::SessionCase one = *session_.findCase(id_);
  one.mesh_scale_sigma = 0.001;
  session_ = withCase(session_, one);
  run();
  validate();
  const ordered_json pose = read(write())["pose"];
  const ordered_json& terms = pose["covariance_terms"];
  const Matrix6d picture = matrixOf(terms["picture"]);
  const Matrix6d mesh_scale = matrixOf(terms["mesh_scale"]);
  const Matrix6d calibration = matrixOf(terms["calibration"]);
  EXPECT_EQ(matrixOf(pose["covariance"]), picture + mesh_scale + calibration);
  EXPECT_EQ(picture, subject_.covariance.picture);
  const double distance_m = subject_.camera_from_station.translation_m.z();
  EXPECT_NEAR(std::sqrt(mesh_scale(5, 5)), 0.001 * distance_m, 0.0001 * distance_m);
  EXPECT_GT(calibration(5, 5), picture(5, 5)) << "the picture is not what limits it";
  EXPECT_EQ(pose["input_sigmas"]["mesh_scale_sigma"], 0.001);
  EXPECT_EQ(pose["input_sigmas"]["mesh_scale_is"], "stated");
  EXPECT_EQ(pose["input_sigmas"]["calibration_is"], "assumed");
  EXPECT_EQ(pose["one_sigma"]["of"], "end effector");
}

TEST_F(ValidatedPose, WhatNobodyValidatedSaysSoAndStillVerifies) {
  run();
  const fs::path file = write();
  EXPECT_EQ(read(file)["state"], "NOT VALIDATED");
  EXPECT_EQ(read(file)["standing"], "NOT VALIDATED: converged");
  const VerifyReport report = sessions::verifyPose(file, true);
  EXPECT_TRUE(report.good()) << wrongsOf(report);
  EXPECT_EQ(report.standing, "NOT VALIDATED: converged");
}

TEST_F(ValidatedPose, OfMarksIsSolvedAgain) {
  const fs::path file = write();
  EXPECT_EQ(read(file)["pose"]["source"], "annotation");
  EXPECT_EQ(read(file)["marks"]["points"].size(), 8u);
  const VerifyReport report = sessions::verifyPose(file, true);
  EXPECT_TRUE(report.good()) << wrongsOf(report);
}

/// Calls `act` with each leaf of the document.
void eachLeaf(ordered_json& json, const std::function<void(ordered_json&)>& act) {
  if (json.is_structured()) {
    for (auto& element : json) eachLeaf(element, act);
  } else {
    act(json);
  }
}

void alter(ordered_json& leaf) {
  if (leaf.is_string())
    leaf = leaf.get<std::string>() + "x";
  else if (leaf.is_number_float())
    leaf = std::nextafter(leaf.get<double>(), 1e9);
  else if (leaf.is_number())
    leaf = leaf.get<std::int64_t>() + 1;
  else if (leaf.is_boolean())
    leaf = !leaf.get<bool>();
  else
    leaf = "x";
}

TEST_F(ValidatedPose, NoLeafCanBeAlteredUnseen) {
  run();
  validate();
  const fs::path file = write();
  ordered_json json = read(file);
  int leaves = 0;
  eachLeaf(json, [&leaves](ordered_json&) { ++leaves; });
  int place = 0;
  const int step = std::max(1, leaves / 120);
  eachLeaf(json, [&](ordered_json& leaf) {
    if (++place % step != 0) return;
    const ordered_json before = leaf;
    alter(leaf);
    sessions::writeJsonFile(file, json);
    try {
      EXPECT_FALSE(sessions::verifyPose(file, false).good()) << place << ": " << before;
    } catch (const sessions::InputError&) {  // told as well
    }
    leaf = before;
  });
  EXPECT_GT(place, 300);
}

TEST_F(ValidatedPose, AForgedPoseIsFoundEvenWhenItIsSignedAnew) {
  run();
  validate();
  const fs::path file = write();
  const ordered_json good = read(file);
  const auto forged = [&](const std::function<void(ordered_json&)>& forge, bool run_again) {
    ordered_json json = good;
    forge(json);
    resign(json, file);
    return wrongsOf(sessions::verifyPose(file, run_again));
  };
  EXPECT_EQ(forged([](ordered_json&) {}, true), "");
  const auto shift = [](ordered_json& json) {
    json["pose"]["camera_from_station"][0][3] =
        json["pose"]["camera_from_station"][0][3].get<double>() + 1e-4;
  };
  EXPECT_THAT(forged(shift, false), HasSubstr("contents: "));
  const auto shiftEverywhere = [&](ordered_json& json) {
    ordered_json& pose = json["session"]["decisions"][0]["pose"]["camera_from_station"];
    pose["translation_m"][0] = pose["translation_m"][0].get<double>() + 1e-4;
    shift(json);
  };
  EXPECT_THAT(forged(shiftEverywhere, true), HasSubstr("pose: another pose comes out"));
  EXPECT_THAT(forged([](ordered_json& json) { json["state"] = "approved"; }, false),
              HasSubstr("contents: "));
  EXPECT_THAT(forged(
                  [](ordered_json& json) {
                    json["session"]["decisions"][0]["checks"][1].erase("override_reason");
                  },
                  false),
              HasSubstr("decision: the check"));
  EXPECT_THAT(forged(
                  [](ordered_json& json) {
                    json["session"]["decisions"][0]["approval"] = {
                        {"by", "ADA"}, {"comment", ""}, {"time", "2026-01-31T23:59:59Z"}};
                  },
                  false),
              HasSubstr("same person"));
  EXPECT_THAT(
      forged(
          [](ordered_json& json) { json["session"]["cases"][0]["seed"]["translation_m"][0] = 0.5; },
          false),
      HasSubstr("no longer holds"));
}

TEST_F(ValidatedPose, AnInputThatIsMissingOrChangedIsNamed) {
  run();
  validate();
  const fs::path file = write();
  const fs::path image = session_.findCase(id_)->image.source.file;
  auto bytes = sessions::readFileBytes(image, 1 << 26);
  bytes.push_back(0);
  sessions::writeFileAtomically(image, std::span<const std::uint8_t>(bytes));
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: "));
  fs::remove(image);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: "));
}

TEST_F(ValidatedPose, AStaleRunIsNotHandedOver) {
  run();
  sessions::SessionCase one = *session_.findCase(id_);
  one.camera_from_station_seed.translation_m.x() += 1e-3;
  session_ = withCase(session_, one);
  EXPECT_THROW(handedPose(session_, id_), sessions::InputError);
  const sessions::HandedPoses all = sessions::handedPoses(session_, {});
  EXPECT_TRUE(all.poses.empty());
  ASSERT_EQ(all.notes.size(), 1u);
  EXPECT_THAT(all.notes[0], HasSubstr("run it again"));
}

TEST_F(ValidatedPose, AnythingElseIsRefusedInASentence) {
  const fs::path file = folder_ / "other.json";
  for (const char* text : {"", "[]", "{", "{\"format\": \"boresight-session\", \"version\": 1}",
                           "{\"format\": \"boresight-validated-pose\", \"version\": 2}"}) {
    sessions::writeFileAtomically(file, std::string_view(text));
    EXPECT_THROW(sessions::verifyPose(file, false), sessions::InputError) << text;
  }
}

}  // namespace
}  // namespace boresight::test
