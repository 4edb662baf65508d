// SPDX-License-Identifier: Apache-2.0
// From an image as a mission sends it, its camera model in the label and the station's seed in
// another frame, to a pose that is handed over.
#include <gtest/gtest.h>

#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_document.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/downlink_image.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using nlohmann::json;
using sessions::FrameName;

const FrameName kRover{"ROVER_FRAME", {194, 835, 1}};
const FrameName kSite{"SITE_FRAME", {194}};

Pose roverFromCamera() {
  return {Eigen::Quaterniond(0.3, 0.7, -0.5, 0.4).normalized(), {0.6, -0.04, -0.23}};
}
Pose siteFromRover() {
  return {Eigen::Quaterniond(0.96, -0.07, -0.04, 0.25).normalized(), {-84.1, -26.1, 3.6}};
}

class Downlink : public ::testing::Test {
 protected:
  Downlink() {
    const ExampleCase& example = osExample();
    static const auto image = downlinkImage(example, roverFromCamera(), kRover);
    image_ = folder_.write("1F483288473.IMG", image);
    truth_ = example.truth.camera_from_station;
    seed_ = writeSeed("seed.json", example.seed, kSite);
    transform_ = folder_ / "site_from_rover.json";
    writeTransform(siteFromRover());
  }

  void writeTransform(const Pose& site_from_rover) const {
    sessions::writeJsonFile(transform_, {{"format", "boresight-transform"},
                                         {"version", 1},
                                         {"target", sessions::toJson(kSite)},
                                         {"source", sessions::toJson(kRover)},
                                         {"target_from_source", sessions::toJson(site_from_rover)},
                                         {"comment", "by hand, sol 12"}});
  }

  /// The seed as the station's place in the site or in the rover's frame.
  std::string writeSeed(const std::string& name, const sessions::PoseFile& seed,
                        const FrameName& frame) const {
    Pose pose = roverFromCamera() * seed.camera_from_station;
    if (frame == kSite) pose = siteFromRover() * pose;
    nlohmann::ordered_json written = {{"format", "boresight-pose"}, {"version", 1}};
    written["reference_from_station"] = sessions::toJson(pose);
    written["reference_frame"] = sessions::toJson(frame);
    written["uncertainty"] = sessions::toJson(*seed.uncertainty);
    return folder_.write(name, written.dump()).string();
  }

  Arguments newArguments(bool with_transform) const {
    const std::string mesh = exampleFolder() / "os" / "model.ply";
    const Arguments arguments = {"new",   "--image", image_,    "--mesh", mesh,    "--mesh-unit",
                                 "m",     "--seed",  seed_,     "--id",   "sol12", "--feature-size",
                                 "0.018", "--set",   kNoSearch, "--out",  session_};
    return with_transform ? with(arguments, {"--frames", transform_}) : arguments;
  }

  /// `whs localize` of the image by its own label, with a seed and more.
  ProgramRun localize(const std::string& seed, std::map<std::string, std::string> more = {}) const {
    more.insert({{"--image", image_}, {"--camera", ""}, {"--seed", seed}, {"--out", result_}});
    return runWhs(localizeArguments(more), 0);
  }

  TemporaryFolder folder_;
  const std::string result_ = folder_ / "result.json";
  std::filesystem::path image_, transform_;
  std::string seed_;
  std::string session_ = folder_ / "s.boresight.json";
  Pose truth_;
};

/// The station's origin and axes in whatever frame, as far off as is required.
void expectNear(const Pose& found, const Pose& expected) {
  EXPECT_LT(perturbationBetween(expected, found).head<3>().norm(), 0.25 * 3.14159265 / 180.0);
  EXPECT_LT((found.translation_m - expected.translation_m).norm(), 4e-4);
}

TEST_F(Downlink, IsLocalizedJudgedHandedOverAndVerified) {
  runWhs(newArguments(true), 0);
  runWhs({"run", session_}, 0);
  // Three sigma across the view axis are 0.42 mm at the camera, 0.4 mm are required.
  const ProgramRun decided =
      runWhs({"decide", session_, "--case", "sol12", "--validate", "--by", "Ada", "--comment",
              "right", "--waive", "covariance_lateral=0.02 mm over", "--convergence-test", "0"});
  EXPECT_EQ(decided.exit_code, 0) << decided.out << decided.err
                                  << runWhs({"check", session_, "--convergence-test", "0"}).out;
  const std::string file = folder_ / "pose.json";
  runWhs({"export", session_, "--case", "sol12", "--pose", file}, 0);
  runWhs({"verify", file}, 0);

  EXPECT_THAT(runWhs({"info", file}, 0).out,
              AllOf(HasSubstr("case sol12: validated by Ada"),
                    HasSubstr("in SITE_FRAME (194)\nreference_from_station\n")));

  const json pose = jsonOf(file);
  expectNear(poseOf(pose["pose"]["camera_from_station"]), truth_);
  const json& site = pose["frames"]["SITE_FRAME (194)"];
  EXPECT_EQ(site["joined_by"], "site_from_rover.json: by hand, sol 12");
  expectNear(poseOf(pose["frames"]["ROVER_FRAME (194, 835, 1)"]["reference_from_station"]),
             roverFromCamera() * truth_);
  expectNear(poseOf(site["reference_from_station"]), siteFromRover() * roverFromCamera() * truth_);
  EXPECT_THAT(pose["image_label"].dump(), HasSubstr(R"(["PRODUCT_ID","1F483288473"])"));
  EXPECT_THAT(pose["chain"].dump(), HasSubstr("site_from_rover.json, sha256 "));

  // COLMAP has no such camera: it gets another, with its error.
  const std::string colmap = folder_ / "colmap";
  EXPECT_THAT(runWhs({"export", session_, "--poses", "handed-over", "--colmap", colmap}, 0).err,
              HasSubstr("its cahvor camera is written as brown_conrady, worst error "));
  EXPECT_THAT(folder_.read("colmap/images.txt"), HasSubstr("worst error "));
  EXPECT_THAT(folder_.read("colmap/cameras.txt"), HasSubstr("OPENCV"));
}

TEST_F(Downlink, WhatIsMissing_IsAskedFor) {
  EXPECT_THAT(refusal(newArguments(false)),
              HasSubstr("the pose is given in SITE_FRAME (194), but the camera model in "
                        "ROVER_FRAME (194, 835, 1)"));
  EXPECT_FALSE(std::filesystem::exists(session_));
  EXPECT_THAT(runWhs(localizeArguments({{"--camera", ""}}), 3).err,
              HasSubstr("the image has no label with a camera model"));
  const std::string bare =
      folder_.write("bare.vic", vicarImage(16, 12, std::vector<std::uint16_t>(192), ""));
  EXPECT_THAT(runWhs(localizeArguments({{"--image", bare}, {"--camera", ""}}), 3).err,
              HasSubstr("give a camera.json or a .cahvor file with --camera"));
}

TEST_F(Downlink, IsLocalizedByItsOwnLabelInTheFrameThatItsSeedIsGivenIn) {
  const std::string record = folder_ / "run.whsr";
  const std::string seed = writeSeed("rover.json", osExample().seed, kRover);
  ProgramRun run = localize(seed, {{"--record", record}});
  json result = jsonOf(result_);
  expectNear(poseOf(result["camera_from_station"]), truth_);
  expectNear(poseOf(result["frames"]["ROVER_FRAME (194, 835, 1)"]["reference_from_station"]),
             roverFromCamera() * truth_);
  EXPECT_THAT(run.out, HasSubstr("\nreference_from_station in ROVER_FRAME (194, 835, 1)\n"));

  const std::string described =
      runWhs({"info", image_.string(), seed_, transform_.string(), record}, 0).out;
  for (const char* text : {"PRODUCT_ID: 1F483288473", "vectors in ROVER_FRAME (194, 835, 1)",
                           "reference_from_station in SITE_FRAME (194)",
                           "\nreference_from_station\n", "  uncertainty ", "\ntarget_from_source\n",
                           "from ROVER_FRAME (194, 835, 1) to SITE_FRAME (194): by hand",
                           "image 1024 x 1024 px", "converged, digest "})
    EXPECT_THAT(described, HasSubstr(text));
  EXPECT_THAT(described, Not(HasSubstr("missing: ")));
  EXPECT_THAT(runWhs({"info", seed_, transform_.string()}, 0).out,
              Not(HasSubstr("camera_from_station")))
      << "each matrix has the name of what it is";

  run = localize(seed_, {{"--frames", transform_}});
  expectNear(poseOf(jsonOf(result_)["frames"]["SITE_FRAME (194)"]["reference_from_station"]),
             siteFromRover() * roverFromCamera() * truth_);
  EXPECT_THAT(run.out, HasSubstr("\nreference_from_station in SITE_FRAME (194)\n"));
}

TEST_F(Downlink, ATransformThatTheLabelContradictsIsReported) {
  // The label states where the rover is in the site; the transform that is given later lies 10 mm
  // next to it.
  const Eigen::Quaterniond& turn = siteFromRover().rotation;
  folder_.write(
      "1F483288473.IMG",
      downlinkImage(osExample(), roverFromCamera(), kRover,
                    "PROPERTY='ROVER_COORDINATE_SYSTEM'  COORDINATE_SYSTEM_NAME='ROVER_FRAME'  "
                    "COORDINATE_SYSTEM_INDEX=(194,835,1)  "
                    "REFERENCE_COORD_SYSTEM_NAME='SITE_FRAME'  REFERENCE_COORD_SYSTEM_INDEX=194  "
                    "ORIGIN_OFFSET_VECTOR=" +
                        vicarVector(siteFromRover().translation_m) +
                        "  ORIGIN_ROTATION_QUATERNION=(" + vicarNumber(turn.w()) + "," +
                        vicarNumber(turn.x()) + "," + vicarNumber(turn.y()) + "," +
                        vicarNumber(turn.z()) + ")  "));
  EXPECT_EQ(localize(seed_, {{"--frames", transform_}}).err, "");
  EXPECT_FALSE(jsonOf(result_).contains("warnings"));

  Pose moved = siteFromRover();
  moved.translation_m.z() += 0.01;
  writeTransform(moved);
  const std::string warning =
      "site_from_rover.json and the image's label differ about where ROVER_FRAME (194, 835, 1) is "
      "in SITE_FRAME (194): by 10.0 mm and 0.00 deg";
  EXPECT_EQ(localize(seed_, {{"--frames", transform_}}).err, "whs: " + warning + "\n");
  EXPECT_EQ(jsonOf(result_)["warnings"], json::array({warning}));
  EXPECT_EQ(runWhs(newArguments(true), 0).err, "whs: case sol12: " + warning + "\n");
}

TEST_F(Downlink, OfADataSetIsEvaluated) {
  json dataset = {{"format", "boresight-dataset"}, {"version", 1}};
  dataset["requirement"] = {{"normal_mm", 0.4}, {"lateral_mm", 0.4}, {"rotation_deg", 0.25}};
  dataset["transforms"] = {"site_from_rover.json"};
  dataset["stations"]["os"] = {{"mesh", (exampleFolder() / "os" / "model.ply").string()},
                               {"mesh_unit", "m"},
                               {"feature_size_m", 0.018}};
  json value = {{"id", "sol12"}, {"station", "os"}, {"image", "1F483288473.IMG"}};
  value["seed"] = jsonOf(seed_);
  value["truth"]["camera_from_station"] = json::parse(sessions::toJson(truth_).dump());
  dataset["cases"] = json::array({value});
  const std::string file = folder_.write("dataset.json", dataset.dump());
  runWhs({"evaluate", "--dataset", file, "--out", folder_ / "r.sqlite", "--jsonl",
          folder_ / "r.jsonl", "--set", kNoSearch},
         0);
  EXPECT_EQ(jsonOf(folder_ / "r.jsonl")["success"], true) << folder_.read("r.jsonl");
}

TEST_F(Downlink, ItsCameraIsWrittenAndFitted) {
  const std::string text = folder_ / "left.cahvor";
  runWhs({"camera", image_.string(), "--out", text}, 0);
  const sessions::CameraFile again = sessions::readCameraFile(text);
  Eigen::Vector2d expected, found;
  const Eigen::Vector3d point_m(0.05, -0.03, 0.4);
  ASSERT_TRUE(project(labelCamera(), point_m, expected));
  ASSERT_TRUE(project(
      again.camera, again.reference->camera_from_reference * (roverFromCamera() * point_m), found));
  EXPECT_LT((expected - found).norm(), 1e-6);
  const std::string fitted = folder_ / "brown.json";
  EXPECT_THAT(runWhs({"camera", image_.string(), "--as", "brown_conrady", "--out", fitted}, 0).out,
              HasSubstr("worst error "));
  ASSERT_TRUE(project(sessions::readCamera(fitted), point_m, found));
  EXPECT_LT((expected - found).norm(), jsonOf(fitted)["fitted_from"]["worst_error_px"]);
  sessions::CahvorFile with_covariance = sessions::readCahvorFile(text);
  with_covariance.covariance = 1e-8 * Eigen::MatrixXd::Identity(18, 18);
  const std::string other_ending = folder_ / "left.cahvore";
  sessions::writeCahvorFile(other_ending, with_covariance);
  runWhs({"camera", other_ending, "--out", folder_ / "left.json"}, 0);
  EXPECT_TRUE(jsonOf(folder_ / "left.json").contains("covariance"));
  EXPECT_THAT(runWhs({"camera", text, "--out", other_ending}).err,
              HasSubstr("the vectors belong to a cahvor model"));
  nlohmann::json stated = jsonOf(folder_ / "left.json");
  stated.erase("covariance");
  stated["calibration_sigma"] = {{"focal_relative", 0.001}, {"principal_point_px", 0.25}};
  folder_.write("left.json", stated.dump());
  runWhs({"camera", folder_ / "left.json", "--out", text}, 0);
  const auto kept = sessions::readCameraFile(std::filesystem::path(text)).calibration_sigma;
  ASSERT_TRUE(kept);
  EXPECT_NEAR(kept->focal_relative.value(), 0.001, 1e-12);
  EXPECT_NEAR(kept->principal_point_px.value(), 0.25, 1e-12);
  stated["calibration_sigma"].erase("principal_point_px");
  folder_.write("left.json", stated.dump());
  EXPECT_THAT(runWhs({"camera", folder_ / "left.json", "--out", text}, 0).err,
              HasSubstr("one member of calibration_sigma alone; it is left out"));
  stated["calibration_sigma"] = {{"focal_relative", 0.0}, {"principal_point_px", 0.0}};
  folder_.write("left.json", stated.dump());
  EXPECT_THAT(runWhs({"camera", folder_ / "left.json", "--out", text}, 0).err,
              HasSubstr("a calibration_sigma of 0; it is left out"));
  runWhs({"camera", image_.string()}, 2);
  runWhs({"camera", text, "--as", "pinhole", "--out", text}, 2);
}

// Records, traces and sessions compared.

/// A session whose one case was run, and the record and trace of the same run elsewhere: copies of
/// what was run once.
struct Runs {
  const TemporaryFolder folder;
  const std::string session = folder / "s.boresight.json";
  const std::string record = folder / "run.whsr";
  const std::string trace = folder / "run.trace";

  Runs() {
    std::filesystem::copy(originals(), folder.path(), std::filesystem::copy_options::recursive);
  }

  static const std::filesystem::path& originals() {
    static const TemporaryFolder files;
    static const bool run = [] {
      runWhs({"run", newSession(files)}, 0);
      runWhs(
          localizeArguments({{"--record", files / "run.whsr"}, {"--trace", files / "run.trace"}}),
          0);
      return true;
    }();
    EXPECT_TRUE(run);
    return files.path();
  }

  void edit(void (*change)(sessions::SessionCase&, const Runs&)) const {
    auto document = sessions::SessionDocument::open(session);
    sessions::SessionCase session_case = *document.session().findCase(kOsCase);
    change(session_case, *this);
    document.apply(sessions::withCase(document.session(), session_case), "Change");
    document.save();
  }
};

TEST(WhsCompare, TakesRecordsTracesAndRunsOfSessions) {
  const Runs runs;
  const auto exitOf = [](const Arguments& arguments) {
    const ProgramRun run = runWhs(with({"compare"}, arguments));
    EXPECT_EQ(run.exit_code == 0, run.out.starts_with("equal to the bit")) << run.out;
    return run.exit_code;
  };
  EXPECT_EQ(exitOf({runs.record, runs.trace}), 0);
  EXPECT_EQ(exitOf({runs.trace, runs.record}), 0);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", kOsCase}), 0);
  EXPECT_EQ(exitOf({runs.session, runs.trace, "--case", kOsCase}), 0);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", kOsCase, "--rerun"}), 0);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", kOsCase, "--run", "0000000"}), 3);
  EXPECT_EQ(exitOf({runs.session, "--case", kOsCase}), 3) << "no record is attached";
  runs.edit([](sessions::SessionCase& session_case, const Runs& result) {
    session_case.onboard_record = {result.record, sessions::inputSha256(result.record)};
  });
  EXPECT_EQ(exitOf({runs.session, "--case", kOsCase}), 0);
  EXPECT_EQ(exitOf({runs.session}), 2);
  EXPECT_EQ(exitOf({runs.record}), 2);
  EXPECT_EQ(exitOf({runs.session, runs.session, "--case", kOsCase}), 2);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", "none"}), 3);
  const std::string record = runs.folder.read("run.whsr");
  runWhs({"compare", runs.record, runs.folder.write("cut.whsr", record.substr(0, 4000))}, 5);
  EXPECT_THAT(runWhs({"compare", runs.record, runs.folder.write("no.whsr", "no record")}, 3).err,
              HasSubstr("no.whsr"));
}

TEST(WhsNew, AttachesAnOnboardRecordToItsOneCase) {
  const Runs runs;
  const std::string text = runs.folder / "made.boresight.json";
  const Arguments arguments = {"new", "--dataset", exampleDataset(), "--out", text};
  runWhs(with(arguments, {"--record", runs.record}), 2);
  runWhs(with(arguments, {"--case", kOsCase, "--record", runs.trace}), 3);
  runWhs(with(arguments, {"--case", kOsCase, "--record", runs.record}), 0);
  runWhs({"compare", text, "--case", kOsCase, "--rerun"}, 0);
}

TEST(WhsCompare, DoesNotTakeARunOfOtherInputsForTheCases) {
  const Runs runs;
  runs.edit([](sessions::SessionCase& session_case, const Runs&) {
    session_case.camera_from_station_seed.translation_m.x() += 1e-4;
  });
  EXPECT_THAT(runWhs({"compare", runs.record, runs.session, "--case", kOsCase}, 3).err,
              HasSubstr("have changed since the run"));
  EXPECT_THAT(runWhs({"compare", runs.record, runs.session, "--case", kOsCase, "--rerun"}, 6).out,
              HasSubstr("first difference: seed"));
}

TEST(WhsCompare, RunsTheCaseByTheRecordsOptions) {
  const Runs runs;
  runWhs(localizeArguments({{"--record", runs.record}, {"--set", "pnp.seed=7"}}), 0);
  EXPECT_THAT(runWhs({"compare", runs.record, runs.session, "--case", kOsCase}, 6).out,
              HasSubstr("first difference: options: the option pnp.seed"));
  runWhs({"compare", runs.record, runs.session, "--case", kOsCase, "--rerun"}, 0);
}

}  // namespace
}  // namespace boresight::test
