// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/validated_pose_file.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sessions/checks/checks.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace_file.h"
#include "tests/support/annotated_example.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using sessions::HandedPose;
using sessions::Session;
using sessions::VerifyReport;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// As another program would: this one does not replace what it has read.
void overwrite(const fs::path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// The example's OS station, run without a search and annotated, in a folder of its own with its
/// files.
class ValidatedPose : public testing::Test {
 protected:
  void SetUp() override {
    fs::copy(exampleFolder(), folder_ / "stations", fs::copy_options::recursive);
    const Session both = sessions::makeSession(folder_ / "stations" / "dataset.json");
    id_ = caseOfStation(both, "os");
    session_ = withoutCase(both, caseOfStation(both, "bc"));
    session_.options = {{"search.enabled", false}};
    static const std::vector<SeenCorner> corners = spreadCorners(osExample(), 8);
    Random random = randomFor("ValidatedPose");
    session_ = withAnnotations(session_, id_, annotationsOf(corners, 0.1, random));
    sessions::SessionCase session_case = *session_.findCase(id_);
    session_case.camera_from_end_effector = randomPose(random);
    session_ = withCase(session_, session_case);
  }

  /// Whatever folder its files are in, the run is the same.
  void run() {
    static const auto trace = runCase(session_, id_, sessions::RecordLevel::kFull);
    ASSERT_TRUE(trace.converged());
    session_ = withRun(session_, storeRun(session_, id_, trace, folder_ / "s.boresight.json"));
  }

  /// By limits that one check fails, which is passed over.
  void validate(int convergence_seeds = 0,
                sessions::PoseSource source = sessions::PoseSource::kRun) {
    sessions::CheckLimits limits = sessions::checkLimits(session_.review.preset, {});
    limits.inlier_count = 9000.0;
    limits.coverage_percent = 100.0;
    session_.review = withLimits(session_.review, limits);
    subject_ = reviewSubject(session_, sessions::loadCase(*session_.findCase(id_)), source);
    std::optional<sessions::ConvergenceResult> convergence;
    if (convergence_seeds > 0) convergence = convergenceTest(subject_, convergence_seeds);
    const std::vector<sessions::Check> checks = checkPose(subject_, limits, convergence);
    sessions::CheckWaivers waivers;
    for (const sessions::Check& check : checks)
      if (check.state == sessions::CheckState::kFailed) waivers[check.id] = "the shadow of the arm";
    session_ = validated(session_, subject_, checks, waivers, {"Ada", "right"}, convergence_seeds);
  }

  fs::path write() {
    const fs::path file = folder_ / "validated_pose.json";
    writeValidatedPose(file, session_, id_);
    return file;
  }

  /// What is said when the session is handed over after this edit of its decision.
  std::string refusal(const std::function<void(sessions::Decision&)>& edit) {
    Session edited = session_;
    edit(edited.decisions.back());
    const fs::path file = folder_ / "refused.json";
    const std::string text = folder_.message([&] { writeValidatedPose(file, edited, id_); });
    EXPECT_FALSE(fs::exists(file));
    return text;
  }

  static sessions::JudgedCheck& checkOf(sessions::Decision& decision, const std::string& id) {
    return *std::find_if(decision.checks.begin(), decision.checks.end(),
                         [&id](const auto& judged) { return judged.check.id == id; });
  }

  /// The same in a document: in its session and in its own list.
  static void eachCheck(ordered_json& json, const std::string& id,
                        const std::function<void(ordered_json&)>& edit) {
    for (ordered_json* list : {&json["checks"], &json["session"]["decisions"][0]["checks"]})
      for (ordered_json& check : *list)
        if (check["id"] == id) edit(check);
  }

  static void statePassed(ordered_json& check) {
    check["state"] = "passed";
    check["figure"] = check["limit"];
    check.erase("waiver_reason");
  }

  static ordered_json read(const fs::path& file) {
    std::ifstream stream(file);
    return ordered_json::parse(stream);
  }

  /// Signed again, as an attacker would.
  static void resign(ordered_json& json, const fs::path& file) {
    json["signature"] = sessions::signatureOf(ordered_json::parse(sessions::prettyJson(json)));
    sessions::writeJsonFile(file, json);
  }

  fs::path writeValidated() {
    run();
    validate();
    return write();
  }

  /// A file that verifies.
  static VerifyReport verified(const fs::path& file, bool convergence_again = false) {
    VerifyReport report = sessions::verifyPose(file, true, convergence_again);
    EXPECT_TRUE(report.good()) << wrongsOf(report);
    return report;
  }

  /// What is wrong with the file after an edit of what is in it now.
  static auto forging(const fs::path& file) {
    return
        [good = read(file), file](const std::function<void(ordered_json&)>& forge, bool run_again) {
          ordered_json json = good;
          forge(json);
          resign(json, file);
          return wrongsOf(sessions::verifyPose(file, run_again));
        };
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
  const fs::path file = writeValidated();
  const ordered_json json = read(file);
  EXPECT_EQ(json["state"], "validated");
  EXPECT_EQ(json["review_status"], "validated by Ada");
  EXPECT_THAT(json["checks"].dump(), HasSubstr("\"waiver_reason\":\"the shadow of the arm\""));
  EXPECT_EQ(json["sha256"]["image_pixels"], session_.findCase(id_)->image.pixels_sha256);
  EXPECT_EQ(json["run"]["digest"], subject_.run->digest);
  EXPECT_GT(json["run"]["matches"].size(), 20u);
  EXPECT_EQ(json["chain"].back()["from"], "run " + subject_.run->digest);
  const Pose& camera_from_station = subject_.camera_from_station;
  EXPECT_EQ(json["pose"]["camera_from_station"][0][3], camera_from_station.translation_m.x());
  EXPECT_EQ(json["pose"]["station_from_camera"][2][3],
            camera_from_station.inverse().translation_m.z());
  EXPECT_TRUE(json["end_effector"].contains("end_effector_seed_from_end_effector_estimated"));

  const VerifyReport report = verified(file);
  EXPECT_EQ(report.review_status, "validated by Ada");
}

Matrix6d matrixOf(const ordered_json& json) {
  Matrix6d matrix;
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 6; ++column)
      matrix(static_cast<int>(row), static_cast<int>(column)) = json[row][column].get<double>();
  return matrix;
}

TEST_F(ValidatedPose, ItsCovarianceIsTheSumOfNamedTermsAndSaysByWhichSigmas) {
  sessions::SessionCase session_case = *session_.findCase(id_);
  session_case.mesh_scale_sigma = 0.001;
  session_ = withCase(session_, session_case);
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

TEST_F(ValidatedPose, UnvalidatedPose_IsLabelledAndVerifies) {
  run();
  const fs::path file = write();
  EXPECT_EQ(read(file)["state"], "NOT VALIDATED");
  EXPECT_EQ(read(file)["review_status"], "NOT VALIDATED: converged");
  const VerifyReport report = verified(file);
  EXPECT_EQ(report.review_status, "NOT VALIDATED: converged");
}

TEST_F(ValidatedPose, OfAnnotationsIsSolvedAgain) {
  const fs::path file = write();
  EXPECT_EQ(read(file)["pose"]["source"], "annotation");
  EXPECT_EQ(read(file)["annotations"]["points"].size(), 8u);
  verified(file);
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

TEST_F(ValidatedPose, AlteredMember_IsAlwaysDetected) {
  const fs::path file = writeValidated();
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

TEST_F(ValidatedPose, ForgedPoseWithNewSignature_IsDetected) {
  const fs::path file = writeValidated();
  const auto forged = forging(file);
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
  EXPECT_THAT(forged(shiftEverywhere, true), HasSubstr("pose: the pose differs"));
  EXPECT_THAT(forged([](ordered_json& json) { json["state"] = "approved"; }, false),
              HasSubstr("contents: "));
  EXPECT_THAT(forged(
                  [](ordered_json& json) {
                    for (ordered_json& check : json["session"]["decisions"][0]["checks"])
                      check.erase("waiver_reason");
                  },
                  false),
              HasSubstr("decision: the check"));
  EXPECT_THAT(forged(
                  [](ordered_json& json) {
                    json["session"]["decisions"][0]["approval"] = {
                        {"by", "ADA"}, {"comment", ""}, {"time", "2026-01-31T23:59:59Z"}};
                  },
                  false),
              HasSubstr("both validated and approved"));
  EXPECT_THAT(
      forged(
          [](ordered_json& json) { json["session"]["cases"][0]["seed"]["translation_m"][0] = 0.5; },
          false),
      HasSubstr("no longer holds"));
}

TEST_F(ValidatedPose, AFailedCheckStatedAsPassedIsFoundWhenItIsMadeAgain) {
  const fs::path file = writeValidated();
  const auto forged = forging(file);
  const auto pass = [](ordered_json& json) {
    for (const char* id : {"inlier_count", "edge_coverage"}) eachCheck(json, id, statePassed);
  };
  EXPECT_THAT(forged(pass, true),
              AllOf(HasSubstr("checks: check 'Inliers' is stated as passed, 9000 (at least 9000) "
                              "and measured as failed"),
                    HasSubstr("'Predicted edges that are seen' is stated as passed")));
  const auto tell = [](ordered_json& json) {
    eachCheck(json, "edge_clutter", [](ordered_json& check) { check["sentence"] = "Perfect."; });
  };
  EXPECT_THAT(forged(tell, true), HasSubstr("with another text"));
  const auto leaveOut = [](ordered_json& json) {
    for (ordered_json* list : {&json["checks"], &json["session"]["decisions"][0]["checks"]})
      list->erase(0);
  };
  EXPECT_THAT(forged(leaveOut, true), HasSubstr("checks are stated, but"));
  EXPECT_EQ(forged(pass, false), "") << "without a run nothing is measured";
  EXPECT_THAT(sessions::verifyPose(file, false).not_proved,
              Contains(HasSubstr("covariance and checks: not measured")));
}

TEST_F(ValidatedPose, ASmallerCovarianceIsFoundWhenItIsMeasuredAgain) {
  const fs::path file = writeValidated();
  ordered_json json = read(file);
  sessions::Decision decision = session_.decisions.back();
  decision.pose->covariance.picture *= 1e-4;
  // Everything that follows from the covariance is made to follow.
  Session edited = session_;
  edited.decisions.back() = decision;
  HandedPose pose;
  pose.case_id = id_;
  pose.camera_from_station = decision.pose->camera_from_station;
  pose.covariance = decision.pose->covariance;
  pose.run_digest = decision.digest;
  pose.validated = true;
  pose.review_status = "validated by Ada";
  pose.checks = decision.checks;
  resign(json = validatedPoseJson(edited, pose, subject_.run, file), file);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)),
              testing::StartsWith("covariance: the covariance differs"));
}

TEST_F(ValidatedPose, WhoWhenAndWhyAreListedAsNotProved) {
  const fs::path file = writeValidated();
  ordered_json json = read(file);
  json["review_status"] = "validated by Flight Director";
  for (ordered_json* decision : {&json["decision"], &json["session"]["decisions"][0]}) {
    (*decision)["by"] = "Flight Director";
    (*decision)["time"] = "2020-01-01T00:00:00Z";
  }
  resign(json, file);
  const VerifyReport report = verified(file);
  EXPECT_THAT(report.not_proved,
              AllOf(Contains(HasSubstr("who: Flight Director")),
                    Contains(HasSubstr("when: 2020-01-01T00:00:00Z")),
                    Contains(HasSubstr("'Inliers' was waived: the shadow of the arm"))));
}

TEST_F(ValidatedPose, TheConvergenceTestIsProvedOnlyWhenItsSeedsAreRunAgain) {
  run();
  validate(1);
  const fs::path file = write();
  EXPECT_EQ(read(file)["session"]["decisions"][0]["convergence_seeds"], 1);
  VerifyReport report = verified(file);
  EXPECT_THAT(report.not_proved, Contains(HasSubstr("convergence test")));
  report = verified(file, true);
  EXPECT_THAT(report.not_proved, Not(Contains(HasSubstr("convergence test"))));

  ordered_json json = read(file);
  eachCheck(json, "convergence_competing", [](ordered_json& check) {
    check["sentence"] = "No other pose and no mirror image of the station is likely.";
  });
  resign(json, file);
  report = verified(file);
  EXPECT_THAT(report.not_proved, Contains(HasSubstr("convergence test")));
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true, true)),
              HasSubstr("'Best competing pose' is stated as"));
  EXPECT_THAT(refusal([](sessions::Decision& decision) {
                checkOf(decision, "convergence_competing").check.sentence = "None.";
              }),
              HasSubstr("'Best competing pose' is stated as"));
}

TEST_F(ValidatedPose, ASessionEditedByHandIsNotSigned) {
  run();
  validate();
  EXPECT_THAT(refusal([](sessions::Decision& decision) {
                sessions::JudgedCheck& judged = checkOf(decision, "inlier_count");
                judged.waiver_reason.clear();
                judged.check.state = sessions::CheckState::kPassed;
                judged.check.figure = 9100.0;
              }),
              HasSubstr("check 'Inliers' is stated as passed, 9100 (at least 9000) and measured as "
                        "failed"));
  EXPECT_THAT(
      refusal([](sessions::Decision& decision) { decision.pose->covariance.picture *= 1e-4; }),
      HasSubstr("the covariance differs"));
  EXPECT_THAT(refusal([](sessions::Decision& decision) {
                decision.pose->camera_from_station.translation_m.z() = 0.5;
              }),
              HasSubstr("the pose differs"));
  EXPECT_THAT(refusal([](sessions::Decision& decision) { decision.checks.clear(); }),
              HasSubstr("0 checks are stated"));
}

TEST_F(ValidatedPose, ATraceWithAnotherCovarianceIsNotSigned) {
  run();
  sessions::LocalizationTrace trace = loadRun(session_.runs.back());
  trace.covariance *= 1e-4;
  saveTrace(session_.runs.back().file, trace);
  validate();
  EXPECT_THAT(folder_.message([this] { write(); }), HasSubstr("the covariance differs"));
}

TEST_F(ValidatedPose, ADamagedOrLostTraceIsNotHandedOver) {
  run();
  validate();
  const fs::path trace = session_.runs.back().file;
  std::vector<std::uint8_t> bytes = sessions::readFileBytes(trace, 1 << 28);
  bytes[bytes.size() / 2] ^= 1;
  overwrite(trace, bytes);
  EXPECT_THAT(folder_.message([this] { write(); }), HasSubstr("the file was altered or damaged"));
  EXPECT_THAT(sessions::handedPoses(session_, {}).notes, testing::SizeIs(1));
  fs::remove(trace);
  EXPECT_THAT(folder_.message([this] { write(); }), HasSubstr("no such file"));
}

TEST_F(ValidatedPose, WithoutItsRunItDoesNotVerify) {
  const auto forged = forging(writeValidated());
  for (const bool run_again : {true, false}) {
    EXPECT_THAT(forged([](ordered_json& json) { json.erase("run"); }, run_again),
                HasSubstr("the member run, with options and matches, is missing"));
    EXPECT_THAT(forged([](ordered_json& json) { json["session"]["runs"] = ordered_json::array(); },
                       run_again),
                HasSubstr("does not have the run of the pose"));
  }
}

TEST_F(ValidatedPose, OfAnnotationsIsMeasuredLikeThatOfARun) {
  validate(0, sessions::PoseSource::kAnnotation);
  const fs::path file = write();
  verified(file);
  EXPECT_THAT(refusal([](sessions::Decision& decision) {
                decision.pose->camera_from_station.translation_m.z() += 1e-6;
              }),
              HasSubstr("the pose differs"));
  EXPECT_THAT(
      refusal([](sessions::Decision& decision) { decision.pose->covariance.mesh_scale *= 0.99; }),
      HasSubstr("the covariance differs"));
}

TEST_F(ValidatedPose, OptionsThatHaveChangedSinceAreThoseOfItsRun) {
  run();
  validate();
  LocalizerOptions options = sessionOptions(session_, "session");
  options.pnp.seed += 1;
  session_ = withOptions(session_, "default", options);
  verified(write());
}

TEST_F(ValidatedPose, AnInputThatIsMissingOrChangedIsNamed) {
  const fs::path file = writeValidated();
  const fs::path image = session_.findCase(id_)->image.source.file;
  auto bytes = sessions::readFileBytes(image, 1 << 26);
  bytes.push_back(0);
  overwrite(image, bytes);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: "));
  fs::remove(image);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: "));
}

/// Keys are made for the test. A name has blanks, and characters of a shell.
class SignedPose : public ValidatedPose {
 protected:
  void SetUp() override {
    ValidatedPose::SetUp();
    if (std::system("command -v ssh-keygen >/dev/null") != 0) GTEST_SKIP() << "no ssh-keygen";
    file_ = writeValidated();
    by_ = session_.decisionOn(id_)->by;
    key_ = newKey("key");
    signers_ = folder_.write("signers", "\"" + by_ + "\" " + publicKey("key"));
  }
  std::string newKey(const std::string& name) {
    const std::string key = (folder_.path() / name).string();
    EXPECT_EQ(std::system(("ssh-keygen -q -t ed25519 -N '' -C x -f " + key).c_str()), 0);
    return key;
  }
  std::string publicKey(const std::string& name) const { return folder_.read(name + ".pub"); }
  void sign(const std::string& key, const std::string& space = "boresight") {
    fs::remove(file_.string() + ".sig");
    const std::string command =
        "ssh-keygen -q -Y sign -n " + space + " -f " + key + " " + file_.string() + " 2>/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  VerifyReport verify(const fs::path& allowed) const {
    return sessions::verifyPose(file_, false, false, {std::nullopt, allowed});
  }
  void expectNotSigned(const fs::path& allowed, const std::string& why) const {
    EXPECT_THAT(wrongsOf(verify(allowed)), HasSubstr("key: no signature of " + by_)) << why;
  }
  fs::path file_;
  fs::path signers_;
  std::string by_;
  std::string key_;
};

TEST_F(SignedPose, IsSignedOnlyByAListedKeyOfWhoDecided) {
  expectNotSigned(signers_, "no signature");
  sign(key_);
  EXPECT_TRUE(verify(signers_).good()) << wrongsOf(verify(signers_));
  expectNotSigned(folder_.write("others", "\"$(whoami); B.\" " + publicKey("key")), "another name");
  expectNotSigned(folder_.write("empty", ""), "no key is listed");
  expectNotSigned(folder_.write("space", "\"" + by_ + "\" namespaces=\"file\" " + publicKey("key")),
                  "listed for another namespace");
  expectNotSigned(
      folder_.write("expired", "\"" + by_ + "\" valid-before=\"20200101\" " + publicKey("key")),
      "expired");
  EXPECT_THROW((void)verify(folder_.path() / "none"), sessions::InputError);
  const std::string other = newKey("other");
  sign(other);
  expectNotSigned(signers_, "another key");
  sign(key_, "file");
  expectNotSigned(signers_, "another namespace");
  sign(key_);
  const std::string signature = folder_.read(file_.filename().string() + ".sig");
  folder_.write(file_.filename().string() + ".sig", signature.substr(0, signature.size() / 2));
  expectNotSigned(signers_, "half a signature");
  sign(key_);
  std::ofstream(file_, std::ios::app) << "\n";  // the JSON is the same, the signed bytes are not
  expectNotSigned(signers_, "edited after signing");
}

TEST_F(ValidatedPose, MovedAndRenamedFilesAreFoundByTheirHash) {
  const fs::path file = writeValidated();
  const fs::path image = session_.findCase(id_)->image.source.file;
  const test::TemporaryFolder elsewhere;
  fs::create_directories(elsewhere / "images");
  fs::rename(image, elsewhere.path() / "images" / ("renamed" + image.extension().string()));
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: "));
  const VerifyReport report = sessions::verifyPose(file, true, false, {elsewhere.path()});
  EXPECT_TRUE(report.good()) << wrongsOf(report);
  overwrite(elsewhere.path() / "images" / ("renamed" + image.extension().string()), {1, 2, 3});
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true, false, {elsewhere.path()})),
              HasSubstr("image: "));
}

TEST_F(ValidatedPose, AStaleRunIsNotHandedOver) {
  run();
  sessions::SessionCase session_case = *session_.findCase(id_);
  session_case.camera_from_station_seed.translation_m.x() += 1e-3;
  session_ = withCase(session_, session_case);
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
