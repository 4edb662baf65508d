// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/validated_pose_file.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>
#include <regex>
#include <set>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/checks/checks.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_dependencies.h"
#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/trace/trace_file.h"
#include "tests/support/annotated_example.h"
#include "tests/support/comma_locale.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using sessions::HandedPose;
using sessions::Session;
using sessions::VerifyReport;
using Edit = std::function<void(ordered_json&)>;

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
    const std::vector<sessions::Check> checks =
        checkPose(subject_, limits, convergenceTest(subject_, convergence_seeds));
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

  /// Expects this refusal when the session is handed over after an edit of its decision.
  void expectRefused(const std::string& why, const std::function<void(sessions::Decision&)>& edit) {
    Session edited = session_;
    edit(edited.decisions.back());
    const fs::path file = folder_ / "refused.json";
    EXPECT_THAT(folder_.message([&] { writeValidatedPose(file, edited, id_); }), HasSubstr(why));
    EXPECT_FALSE(fs::exists(file));
  }

  static sessions::JudgedCheck& checkOf(sessions::Decision& decision, const std::string& id) {
    return *std::find_if(decision.checks.begin(), decision.checks.end(),
                         [&id](const auto& judged) { return judged.check.id == id; });
  }

  static ordered_json& decisionOf(ordered_json& json) { return json["session"]["decisions"][0]; }

  /// The check in a document: in its session and in its own list.
  static void eachCheck(ordered_json& json, const std::string& id, const Edit& edit) {
    for (ordered_json* list : {&json["checks"], &decisionOf(json)["checks"]})
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

  /// With a checksum of its own, as an attacker would write it.
  static void rewrite(ordered_json& json, const fs::path& file) {
    json["checksum"] = sessions::checksumOf(ordered_json::parse(sessions::prettyJson(json)));
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

  /// Expects what is wrong with the file after an edit of what is in it now.
  static auto forging(const fs::path& file) {
    return [good = read(file), file](bool run_again, const testing::Matcher<std::string>& wrongs,
                                     const Edit& forge) {
      ordered_json json = good;
      forge(json);
      rewrite(json, file);
      EXPECT_THAT(wrongsOf(sessions::verifyPose(file, run_again)), wrongs);
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

Matrix6d matrixOf(const ordered_json& json) {
  Matrix6d matrix;
  for (std::size_t i = 0; i < 36; ++i)
    matrix(static_cast<int>(i / 6), static_cast<int>(i % 6)) = json[i / 6][i % 6].get<double>();
  return matrix;
}

/// The covariance is the sum of named terms, and the file says by which sigmas.
TEST_F(ValidatedPose, HoldsWhatAReviewerAsksForAndVerifies) {
  sessions::SessionCase session_case = *session_.findCase(id_);
  session_case.mesh_scale_sigma = 0.001;
  session_ = withCase(session_, session_case);
  const fs::path file = writeValidated();
  const ordered_json json = read(file);
  EXPECT_EQ(json["state"], "validated");
  EXPECT_EQ(json["review_status"], "validated by Ada");
  EXPECT_THAT(json["checks"].dump(), HasSubstr("\"waiver_reason\":\"the shadow of the arm\""));
  EXPECT_EQ(json["sha256"]["image_pixels"], session_case.image.pixels_sha256);
  EXPECT_EQ(json["run"]["digest"], subject_.run->digest);
  EXPECT_GT(json["run"]["matches"].size(), 20u);
  EXPECT_EQ(json["chain"].back()["from"], "run " + subject_.run->digest);
  EXPECT_TRUE(json["end_effector"].contains("end_effector_seed_from_end_effector_estimated"));
  const Pose& camera_from_station = subject_.camera_from_station;
  const double distance_m = camera_from_station.translation_m.z();
  const ordered_json& pose = json["pose"];
  EXPECT_EQ(pose["camera_from_station"][0][3], camera_from_station.translation_m.x());
  EXPECT_EQ(pose["station_from_camera"][2][3], camera_from_station.inverse().translation_m.z());
  const Matrix6d picture = matrixOf(pose["covariance_terms"]["picture"]);
  const Matrix6d mesh_scale = matrixOf(pose["covariance_terms"]["mesh_scale"]);
  const Matrix6d calibration = matrixOf(pose["covariance_terms"]["calibration"]);
  EXPECT_EQ(matrixOf(pose["covariance"]), picture + mesh_scale + calibration);
  EXPECT_EQ(picture, subject_.covariance.picture);
  EXPECT_NEAR(std::sqrt(mesh_scale(5, 5)), 0.001 * distance_m, 0.0001 * distance_m);
  EXPECT_GT(calibration(5, 5), picture(5, 5)) << "the picture is not what limits it";
  EXPECT_EQ(pose["input_sigmas"]["mesh_scale_sigma"], 0.001);
  EXPECT_EQ(pose["input_sigmas"]["mesh_scale_is"], "stated");
  EXPECT_EQ(pose["input_sigmas"]["calibration_is"], "assumed");
  EXPECT_EQ(pose["one_sigma"]["of"], "end effector");
  EXPECT_EQ(verified(file).review_status, "validated by Ada");
}

TEST_F(ValidatedPose, UnvalidatedPose_OfAnnotationsOrARun_IsLabelledAndVerifies) {
  fs::path file = write();
  EXPECT_EQ(read(file)["pose"]["source"], "annotation");
  EXPECT_EQ(read(file)["annotations"]["points"].size(), 8u);
  verified(file);
  run();
  file = write();
  EXPECT_EQ(read(file)["state"], "NOT VALIDATED");
  EXPECT_EQ(read(file)["review_status"], "NOT VALIDATED: converged");
  EXPECT_EQ(verified(file).review_status, "NOT VALIDATED: converged");
}

TEST_F(ValidatedPose, ValidationThatNoLongerHolds_IsStatedAndVerifiesAsNotProved) {
  run();
  validate();
  session_ = withAnnotations(session_, id_, {});
  const std::string dropped = "it no longer holds: the annotations have changed";
  const fs::path file = write();
  const VerifyReport report = verified(file);
  EXPECT_FALSE(report.validated);
  EXPECT_THAT(report.review_status, HasSubstr("the validation by Ada no longer holds"));
  EXPECT_THAT(report.not_proved, Contains("decision: " + dropped));

  const auto expectForged = forging(file);
  expectForged(false, HasSubstr("decision: " + dropped),
               [](ordered_json& json) { json["review_status"] = "validated by Ada"; });
}

TEST_F(ValidatedPose, RejectedRunNextToAnnotations_IsHandedOverAsRejectedAndVerifies) {
  session_.options = {{"loop.max_iterations", std::int64_t{1}}, {"search.enabled", false}};
  const auto trace = runCase(session_, id_, sessions::RecordLevel::kFull);
  ASSERT_FALSE(trace.converged());
  session_ = withRun(session_, storeRun(session_, id_, trace, folder_ / "s.boresight.json"));
  session_ = rejected(session_, id_, trace.digest, {}, {"Ann", "it ended too early"});
  const fs::path file = write();
  EXPECT_EQ(read(file)["pose"]["source"], "annotation");
  EXPECT_EQ(read(file)["review_status"], "NOT VALIDATED: rejected by Ann");
  EXPECT_EQ(verified(file).review_status, "NOT VALIDATED: rejected by Ann");
}

/// Calls `act` with each leaf of the document.
void eachLeaf(ordered_json& json, const Edit& act) {
  if (json.is_structured()) {
    for (auto& element : json) eachLeaf(element, act);
  } else {
    act(json);
  }
}

void alter(ordered_json& leaf) {
  const std::string text = leaf.is_string() ? leaf.get<std::string>() : "";
  if (sessions::isSha256Text(text))
    leaf = text.substr(1) + (text.back() == '0' ? "1" : "0");
  else if (leaf.is_string())
    leaf = text + "x";
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

TEST_F(ValidatedPose, ForgedPoseWithNewChecksum_IsDetected) {
  const auto expectForged = forging(writeValidated());
  const auto shift = [](ordered_json& x_m) { x_m = x_m.get<double>() + 1e-4; };
  const auto shiftPose = [&](ordered_json& json) {
    shift(json["pose"]["camera_from_station"][0][3]);
  };
  expectForged(true, "", [](ordered_json&) {});
  expectForged(false, HasSubstr("contents: "), shiftPose);
  expectForged(true, HasSubstr("pose: the pose differs"), [&](ordered_json& json) {
    shift(decisionOf(json)["pose"]["camera_from_station"]["translation_m"][0]);
    shiftPose(json);
  });
  expectForged(false, HasSubstr("contents: "),
               [](ordered_json& json) { json["state"] = "approved"; });
  expectForged(false, HasSubstr("decision: the check"), [](ordered_json& json) {
    for (ordered_json& check : decisionOf(json)["checks"]) check.erase("waiver_reason");
  });
  expectForged(false, HasSubstr("both validated and approved"), [](ordered_json& json) {
    decisionOf(json)["approval"] = {
        {"by", "ADA"}, {"comment", ""}, {"time", "2026-01-31T23:59:59Z"}};
  });
  expectForged(false, HasSubstr("no longer holds"), [](ordered_json& json) {
    json["session"]["cases"][0]["seed"]["translation_m"][0] = 0.5;
  });
}

TEST_F(ValidatedPose, AFailedCheckStatedAsPassedIsFoundWhenItIsMadeAgain) {
  const fs::path file = writeValidated();
  const auto expectForged = forging(file);
  const auto pass = [](ordered_json& json) {
    for (const char* id : {"inlier_count", "edge_coverage"}) eachCheck(json, id, statePassed);
  };
  expectForged(true,
               AllOf(HasSubstr("checks: check 'Inliers' is stated as passed, 9000 (at least 9000) "
                               "and measured as failed"),
                     HasSubstr("'Predicted edges that are seen' is stated as passed")),
               pass);
  expectForged(true, HasSubstr("checks are stated, but"), [](ordered_json& json) {
    for (ordered_json* document : {&json, &decisionOf(json)}) (*document)["checks"].erase(0);
  });
  expectForged(false, "", pass);  // without a run nothing is measured
  EXPECT_THAT(sessions::verifyPose(file, false).not_proved,
              Contains(HasSubstr("covariance and checks: not measured")));
}

/// The version that verifies may word a check in another way than the one that decided.
TEST_F(ValidatedPose, CheckWithOtherWords_IsTheSameCheck) {
  run();
  validate();
  for (sessions::JudgedCheck& judged : session_.decisions.back().checks) {
    judged.check.title += " (as it was called)";
    judged.check.sentence = "It was worded in another way.";
  }
  std::ranges::reverse(session_.decisions.back().checks);
  EXPECT_THAT(verified(write()).not_proved,
              Contains(AllOf(StartsWith("wording: "), HasSubstr("Inliers"))));
}

TEST_F(ValidatedPose, Report_StatesWhetherAPersonValidatedThePose) {
  run();
  EXPECT_FALSE(verified(write()).validated);
  validate();
  session_.review.second_person = true;
  EXPECT_FALSE(verified(write()).validated) << "a second person must approve";
  session_ = approved(session_, id_, lastRunDigest(session_, id_), {"Bob", "yes"});
  const fs::path file = write();
  EXPECT_TRUE(verified(file).validated);
  EXPECT_THAT(verified(file).not_proved, Contains(StartsWith("written: by Boresight ")));
}

TEST_F(ValidatedPose, SignersWithoutADecision_AreNoProof) {
  const fs::path file = write();
  const fs::path signers = folder_.write("signers", std::string_view());
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, false, false, {std::nullopt, signers})),
              HasSubstr("key: there is no decision"));
}

TEST_F(ValidatedPose, ChecksumOf1_0_HasItsFormerName) {
  const fs::path file = writeValidated();
  ordered_json json = read(file);
  json.erase("checksum");
  json["signature"] = sessions::checksumOf(json, sessions::kFormerChecksumMember);
  sessions::writeJsonFile(file, json);
  EXPECT_TRUE(sessions::verifyPose(file, false).good());
  json["signature"]["digest"] = std::string(64, '0');
  sessions::writeJsonFile(file, json);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, false)), StartsWith("checksum: "));
}

TEST_F(ValidatedPose, TextPaddedBehindItsEnd_Verifies) {
  const fs::path file = writeValidated();
  std::ofstream(file, std::ios::app | std::ios::binary) << "\x1a\r\n";
  EXPECT_TRUE(sessions::verifyPose(file, false).good());
}

/// Everything that follows from the covariance is made to follow.
TEST_F(ValidatedPose, ASmallerCovarianceIsFoundWhenItIsMeasuredAgain) {
  const fs::path file = writeValidated();
  Session edited = session_;
  sessions::Decision& decision = edited.decisions.back();
  decision.pose->covariance.picture *= 1e-4;
  HandedPose pose;
  pose.case_id = id_;
  pose.camera_from_station = decision.pose->camera_from_station;
  pose.covariance = decision.pose->covariance;
  pose.run_digest = decision.digest;
  pose.validated = true;
  pose.review_status = "validated by Ada";
  pose.checks = decision.checks;
  ordered_json json = validatedPoseJson(edited, pose, subject_.run, file);
  rewrite(json, file);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)),
              StartsWith("covariance: the covariance differs"));
}

TEST_F(ValidatedPose, WhoWhenAndWhyAreListedAsNotProved) {
  const fs::path file = writeValidated();
  ordered_json json = read(file);
  json["review_status"] = "validated by Flight Director";
  for (ordered_json* decision : {&json["decision"], &decisionOf(json)}) {
    (*decision)["by"] = "Flight Director";
    (*decision)["time"] = "2020-01-01T00:00:00Z";
  }
  rewrite(json, file);
  EXPECT_THAT(verified(file).not_proved,
              AllOf(Contains(HasSubstr("who: Flight Director")),
                    Contains(HasSubstr("when: 2020-01-01T00:00:00Z")),
                    Contains(HasSubstr("'Inliers' was waived: the shadow of the arm"))));
}

TEST_F(ValidatedPose, TheConvergenceTestIsProvedOnlyWhenItsSeedsAreRunAgain) {
  run();
  validate(1);
  const fs::path file = write();
  EXPECT_EQ(read(file)["session"]["decisions"][0]["convergence_seeds"], 1);
  const auto not_proved = Contains(HasSubstr("convergence test"));
  EXPECT_THAT(verified(file).not_proved, not_proved);
  EXPECT_THAT(verified(file, true).not_proved, Not(not_proved));
  ordered_json json = read(file);
  eachCheck(json, "convergence_competing", [](ordered_json& check) { check["figure"] = 0.125; });
  rewrite(json, file);
  EXPECT_THAT(verified(file).not_proved, not_proved);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true, true)),
              HasSubstr("'Best competing pose' is stated as"));
  expectRefused("'Best competing pose' is stated as", [](sessions::Decision& decision) {
    checkOf(decision, "convergence_competing").check.figure = 0.125;
  });
}

TEST_F(ValidatedPose, ASessionEditedByHandIsNotSigned) {
  run();
  validate();
  expectRefused("check 'Inliers' is stated as passed, 9100 (at least 9000) and measured as failed",
                [](sessions::Decision& decision) {
                  sessions::JudgedCheck& judged = checkOf(decision, "inlier_count");
                  judged.waiver_reason.clear();
                  judged.check.state = sessions::CheckState::kPassed;
                  judged.check.figure = 9100.0;
                });
  expectRefused("the covariance differs",
                [](sessions::Decision& decision) { decision.pose->covariance.picture *= 1e-4; });
  expectRefused("the pose differs", [](sessions::Decision& decision) {
    decision.pose->camera_from_station.translation_m.z() = 0.5;
  });
  expectRefused("0 checks are stated",
                [](sessions::Decision& decision) { decision.checks.clear(); });
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
  folder_.write(trace.string(), bytes);
  EXPECT_THAT(folder_.message([this] { write(); }), HasSubstr("the file was altered or damaged"));
  EXPECT_THAT(sessions::handedPoses(session_, {}).notes, SizeIs(1));
  fs::remove(trace);
  EXPECT_THAT(folder_.message([this] { write(); }), HasSubstr("no such file"));
}

TEST_F(ValidatedPose, WithoutItsRunItDoesNotVerify) {
  const auto expectForged = forging(writeValidated());
  for (const bool run_again : {true, false}) {
    expectForged(run_again, HasSubstr("the member run, with options and matches, is missing"),
                 [](ordered_json& json) { json.erase("run"); });
    expectForged(run_again, HasSubstr("does not have the run of the pose"),
                 [](ordered_json& json) { json["session"]["runs"] = ordered_json::array(); });
  }
}

TEST_F(ValidatedPose, OfAnnotationsIsMeasuredLikeThatOfARun) {
  validate(0, sessions::PoseSource::kAnnotation);
  verified(write());
  expectRefused("the pose differs", [](sessions::Decision& decision) {
    decision.pose->camera_from_station.translation_m.z() += 1e-6;
  });
  expectRefused("the covariance differs",
                [](sessions::Decision& decision) { decision.pose->covariance.mesh_scale *= 0.99; });
}

TEST_F(ValidatedPose, OfThreePoints_IsTheSameWhereverThePoseIsNudged) {
  Random random = randomFor("Nudged");
  const auto three = annotationsOf(spreadCorners(osExample(), 3), 0.1, random);
  session_ = withAnnotations(session_, id_, three);
  validate(0, sessions::PoseSource::kAnnotation);
  bool depends = false;
  for (int nudge = 0; nudge < 9; ++nudge) {
    sessions::SessionCase session_case = *session_.findCase(id_);
    Pose working = session_case.camera_from_station_seed;
    const Eigen::Vector3d turn = randomVector(random, 1.5);
    working.rotation = working.rotation * rotationExp(turn);
    session_case.camera_from_station_working = working;
    const Session nudged = withCase(session_, session_case);
    const auto subject =
        reviewSubject(nudged, sessions::loadCase(session_case), sessions::PoseSource::kAnnotation);
    EXPECT_EQ(subject.camera_from_station, subject_.camera_from_station) << turn;
    EXPECT_NO_THROW((void)handedPose(nudged, id_)) << turn;
    const auto solved = solveCaseAnnotations(caseAnnotations(nudged, id_), working, {});
    const auto from_working = solved.camera_from_station();
    depends |= from_working &&
               perturbationBetween(subject_.camera_from_station, *from_working).norm() > 0.01;
  }
  EXPECT_TRUE(depends) << "three points have several poses";
}

TEST_F(ValidatedPose, InALocaleWithDecimalComma_HasTheSameChecksAndVerifies) {
  const fs::path file = writeValidated();
  const ordered_json checks = read(file)["checks"];
  const CommaLocale locale;
  if (!locale.active()) GTEST_SKIP() << "localedef cannot build de_DE.UTF-8 here";
  verified(file);
  validate();
  EXPECT_EQ(read(write())["checks"], checks);
}

TEST_F(ValidatedPose, OptionsThatHaveChangedSinceAreThoseOfItsRun) {
  run();
  validate();
  LocalizerOptions options = sessionOptions(session_, "session");
  options.pnp.seed += 1;
  session_ = withOptions(session_, "default", options);
  verified(write());
}

/// A case with all that a decision depends on: a rig whose other camera ran and was annotated,
/// frames, mask with strokes, sigmas, truth, requirement, onboard record, two persons.
class WholeCase : public ValidatedPose {
 protected:
  void SetUp() override {
    ValidatedPose::SetUp();
    fs::copy(exampleFolder() / "../frames/arm.json", folder_ / "arm.json");
    fs::copy(exampleFolder() / "../../../tests/sessions/formats/1.0/run.whsr", folder_ / "a.whsr");
    sessions::SessionCase left = *session_.findCase(id_);
    const std::vector<std::uint8_t> nothing(
        static_cast<std::size_t>(left.image.width) * left.image.height, 0);
    sessions::writePng(folder_ / "mask.png", nothing, left.image.width, left.image.height, 1);
    left.ignore = inputOf("mask.png");
    left.ignore_strokes.push_back({.radius_px = 2.0, .points = {{3.0, 4.0}}, .name = "screw"});
    left.onboard_record = inputOf("a.whsr");
    left.rig = sessions::Rig{"rig", Pose()};
    left.symmetries = sessions::symmetriesIn("z at 0.01 0.02 0.03; z 180");
    left.mesh_scale_sigma = 0.0004;
    left.calibration_sigma = sessions::StatedCalibration{0.0003, 0.4};
    left.requirement = sessions::Requirement{0.5, 0.5, 0.3, {}};
    left.feature_size_m = 0.01;
    left.tags = {"low sun"};
    left.truth_covariance = Matrix6d(1e-10 * Matrix6d::Identity());
    left.camera_from_station_working = left.camera_from_station_seed;
    session_ = withCase(session_, left);
    sessions::StatedInputs stated;
    stated.frames = sessions::readFrameTransforms(folder_ / "arm.json");
    session_ = withStated(session_, id_, stated);
    sessions::SessionCase right = *session_.findCase(id_);
    right.id = "right";
    right.rig->camera_from_rig.translation_m.x() = 1e-5;
    session_ = withCase(session_, right);
    session_ = withAnnotations(session_, "right", *session_.annotations.at(id_));
    static const auto trace = runCase(session_, id_, sessions::RecordLevel::kFull);
    ASSERT_TRUE(trace.converged());
    for (const std::string& id : {std::string("right"), id_})
      session_ = withRun(session_, storeRun(session_, id, trace, folder_ / "s.boresight.json"));
    validate();
    session_.review.second_person = true;
    session_ = approved(session_, id_, lastRunDigest(session_, id_), {"Bob", "yes"});
    file_ = write();
  }

  sessions::InputFile inputOf(const char* name) const {
    return {folder_ / name, sessions::inputSha256(folder_ / name)};
  }

  bool verifies(const fs::path& file, bool run_again) const {
    try {
      const VerifyReport report = sessions::verifyPose(file, run_again);
      return report.good() && report.validated;
    } catch (const sessions::InputError&) {
      return false;
    }
  }

  fs::path file_;
};

/// Calls `act` with the pointer of each leaf; of a list that is longer than two, with those of its
/// first and last element.
void eachPlace(const ordered_json& json, const ordered_json::json_pointer& place,
               const std::function<void(const ordered_json::json_pointer&)>& act) {
  if (!json.is_structured()) return act(place);
  for (const auto& item : json.items()) {
    if (json.is_object())
      eachPlace(item.value(), place / item.key(), act);
    else if (const std::size_t index = std::stoul(item.key());
             index == 0 || index + 1 == json.size())
      eachPlace(item.value(), place / index, act);
  }
}

/// Data that may change without notice, and why.
const std::vector<std::pair<std::string, const char*>>& freePlaces() {
  static const std::vector<std::pair<std::string, const char*>> kFree = {
      {"/written/.*", "by whom and when a file was written is listed as not proved"},
      {"/session/cases/[0-9]+/tags/.*", "a note"},
      {"/session/cases/[0-9]+/working/.*", "no pose depends on the nudged pose"},
      {"/session/cases/[0-9]+/(parts|ignore_strokes)/[0-9]+/name", "a note"},
      {"/session/cases/[0-9]+/rig/id", "a name that only joins the cameras"},
      {"/session/cases/[0-9]+/frames/[0-9]+/path", "where a file is; its bytes count"},
      {"/session/runs/[0-9]+/(file|version|time)", "the run is repeated: its trace is not needed"},
      {"/session/review/second_person", "both persons are named"},
      {"/session/cases/1/(station|truth|truth_covariance|truth_source|requirement|onboard_record|"
       "camera_from_end_effector|symmetries|frames|feature_size_m)(/.*)?",
       "of the other camera only its pose counts"},
  };
  return kFree;
}

bool isFree(const std::string& place) {
  return std::ranges::any_of(freePlaces(), [&place](const auto& free) {
    return std::regex_match(place, std::regex(free.first));
  });
}

/// One change at a time, with a checksum that fits. Where the digests alone do not show it, the run
/// is repeated.
TEST_F(WholeCase, EveryLeafOfTheDocument_IsCoveredOrNamedAsFree) {
  ASSERT_TRUE(verifies(file_, true)) << wrongsOf(sessions::verifyPose(file_, true));
  ordered_json json = read(file_);
  const fs::path changed = folder_ / "changed.json";
  const std::set<std::string> kOfRun = {"/run/digest", "/run/options/pnp.seed",
                                        "/run/matches/0/pixel/0"};
  int places = 0;
  std::vector<std::string> uncovered;
  eachPlace(read(file_), ordered_json::json_pointer(), [&](const auto& place) {
    const std::string name = place.to_string();
    const bool of_run = name.starts_with("/run/");  // only the repeated run shows it
    if (name.starts_with("/checksum") || (of_run && !kOfRun.contains(name))) return;
    ++places;
    const ordered_json before = json[place];
    alter(json[place]);
    rewrite(json, changed);
    if (verifies(changed, false) && !isFree(name) && verifies(changed, true))
      uncovered.push_back(name);
    json[place] = before;
  });
  EXPECT_THAT(uncovered, IsEmpty());
  EXPECT_GT(places, 400);
}

TEST_F(WholeCase, EveryByteRangeOfEveryFile_IsCovered) {
  std::set<fs::path> files;
  for (const auto& session_case : session_.cases)
    sessions::forEachFile(*session_case, [&files](const std::string&, const fs::path& file,
                                                  const std::string&) { files.insert(file); });
  EXPECT_EQ(files.size(), 5u) << "image, mesh, mask, record, frames";
  for (const fs::path& file : files) {
    const std::vector<std::uint8_t> good = sessions::readFileBytes(file, 1 << 28);
    for (const std::size_t at : {std::size_t{0}, good.size() / 3, good.size() - 1}) {
      std::vector<std::uint8_t> bytes = good;
      bytes[at] ^= 1;
      folder_.write(file.string(), bytes);
      EXPECT_FALSE(verifies(file_, false)) << file << " " << at;
    }
    folder_.write(file.string(), std::span(good).first(good.size() / 2));
    EXPECT_FALSE(verifies(file_, false)) << file << " cut";
    folder_.write(file.string(), good);
  }
  EXPECT_TRUE(verifies(file_, false));
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
  const std::string name = "\"" + by_ + "\"", key = publicKey("key");
  for (const auto& [signers, why] :
       {std::pair<std::string, const char*>("\"$(whoami); B.\" " + key, "another name"),
        {"", "no key is listed"},
        {name + " namespaces=\"file\" " + key, "listed for another namespace"},
        {name + " valid-before=\"20200101\" " + key, "expired"}})
    expectNotSigned(folder_.write("others", signers), why);
  EXPECT_THROW((void)verify(folder_.path() / "none"), sessions::InputError);
  sign(newKey("other"));
  expectNotSigned(signers_, "another key");
  sign(key_, "file");
  expectNotSigned(signers_, "another namespace");
  sign(key_);
  const std::string signature = folder_.read(file_.string() + ".sig");
  folder_.write(file_.string() + ".sig", signature.substr(0, signature.size() / 2));
  expectNotSigned(signers_, "half a signature");
  sign(key_);
  std::ofstream(file_, std::ios::app) << "\n";  // the JSON is the same, the signed bytes are not
  expectNotSigned(signers_, "edited after signing");
}

TEST_F(ValidatedPose, MissingOrChangedInputs_AreNamedAndMovedOnesFoundByTheirHash) {
  const fs::path file = writeValidated();
  const fs::path image = session_.findCase(id_)->image.source.file;
  const TemporaryFolder elsewhere;
  const auto verify = [&] { return sessions::verifyPose(file, true, false, {elsewhere.path()}); };
  const std::string moved = "images/renamed" + image.extension().string();
  std::string bytes = folder_.read(image.string());
  elsewhere.write(moved, bytes);
  fs::remove(image);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: ")) << "missing";
  EXPECT_TRUE(verify().good()) << wrongsOf(verify());
  elsewhere.write(moved, "123");
  EXPECT_THAT(wrongsOf(verify()), HasSubstr("image: ")) << "found by its hash alone";
  bytes.push_back(0);
  folder_.write(image.string(), bytes);
  EXPECT_THAT(wrongsOf(sessions::verifyPose(file, true)), HasSubstr("image: ")) << "changed";
}

TEST_F(ValidatedPose, AStaleRunIsNotHandedOver) {
  run();
  sessions::SessionCase session_case = *session_.findCase(id_);
  session_case.camera_from_station_seed.translation_m.x() += 1e-3;
  session_ = withCase(session_, session_case);
  EXPECT_THROW(handedPose(session_, id_), sessions::InputError);
  const sessions::HandedPoses all = sessions::handedPoses(session_, {});
  EXPECT_TRUE(all.poses.empty());
  EXPECT_THAT(all.notes, ElementsAre(HasSubstr("run it again")));
}

TEST_F(ValidatedPose, AnythingElseIsRefusedInASentence) {
  for (const char* text : {"", "[]", "{", "{\"format\": \"boresight-session\", \"version\": 1}",
                           "{\"format\": \"boresight-validated-pose\", \"version\": 2}"}) {
    const fs::path file = folder_.write("other.json", std::string_view(text));
    EXPECT_THROW(sessions::verifyPose(file, false), sessions::InputError) << text;
  }
}

}  // namespace
}  // namespace boresight::test
