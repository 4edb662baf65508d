// SPDX-License-Identifier: Apache-2.0
// Measures the checks of right and deliberately wrong poses, and judges limits by them.
//
//   check_calibration measure DATASET OUT.jsonl [EVERY [KIND ...]]
//     runs what OUT does not have yet; what is made wrong only of every n-th case, and only
//     variants whose names start with a KIND
//   check_calibration recheck DATASET OUT.jsonl NEW.jsonl
//     measures the edges of the poses again
//   check_calibration convergence DATASET OUT.jsonl NEW.jsonl SEEDS
//     adds the convergence test to what passes
//   check_calibration judge OUT.jsonl ...
//     by the limits as they are now
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/checks/checks.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check_limits.h"
#include "sessions/decision/decision.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/run/runner.h"
#include "sessions/session/session_maker.h"
#include "tests/benchmarks/check_cases.h"

namespace boresight::test {
namespace {

using nlohmann::ordered_json;
using sessions::CheckLimits;
using sessions::Session;
using sessions::SessionCase;

/// Limits by the check that they hold for; the others' come from the requirement or are fixed.
const std::map<std::string, double CheckLimits::*> kLimitsByCheck = {
    {"corrections_shrink", &CheckLimits::last_correction_percent},
    {"inlier_count", &CheckLimits::inlier_count},
    {"inlier_ratio", &CheckLimits::inlier_ratio_percent},
    {"inlier_spread", &CheckLimits::inlier_spread_percent},
    {"inlier_depth", &CheckLimits::inlier_depth_percent},
    {"matches_at_border", &CheckLimits::border_percent},
    {"peak_margin", &CheckLimits::peak_margin_percent},
    {"edge_coverage", &CheckLimits::coverage_percent},
    {"edge_clutter", &CheckLimits::clutter_percent},
    {"edge_evidence", &CheckLimits::evidence_percent},
    {"convergence_returned", &CheckLimits::convergence_percent},
    {"convergence_competing", &CheckLimits::competing_percent},
    {"edge_fall_off", &CheckLimits::fall_off_percent},
    {"camera_focal", &CheckLimits::focal_percent},
    {"camera_centre", &CheckLimits::centre_px}};

std::vector<ordered_json> linesOf(const std::string& file) {
  std::vector<ordered_json> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(ordered_json::parse(line));
  return lines;
}

bool fails(const ordered_json& check, const CheckLimits& limits) {
  if (check["state"] == "not_applicable") return false;
  const auto known = kLimitsByCheck.find(check["id"].get<std::string>());
  if (known == kLimitsByCheck.end() || !check.contains("figure")) return check["state"] == "failed";
  const double figure = check["figure"];
  const double limit = limits.*(known->second);
  return check["side"] == "at_least" ? figure < limit : figure > limit;
}

const CheckLimits& limitsOf(const ordered_json& line) {
  const bool synthetic = line["set"] == "synthetic";
  return sessions::findCheckPreset(synthetic ? "sample_transfer" : "photographs")->limits;
}

/// FNV-1a over the case's id.
int halfOf(const std::string& case_id) {
  std::uint32_t hash = 2166136261U;
  for (const char letter : case_id) hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
  return static_cast<int>((hash >> 7) & 1U);
}

/// As an operator would have it, with nothing made wrong.
bool isUnaltered(const std::string& variant) {
  return variant == "right" || variant.starts_with("reseed");
}

/// What only another camera or a better calibration tells is counted by itself; so is what is right
/// though something was made wrong: seeds out of range, half of the station hidden.
std::string groupOf(const ordered_json& line) {
  const std::string variant = line["variant"];
  if (variant.starts_with("focal") || variant.starts_with("centre"))
    return line.value("right_in_image", false) ? ", wrong camera, right in the image"
                                               : ", wrong camera";
  return line["right"] && !isUnaltered(variant) ? ", altered" : "";
}

struct Tally {
  int right = 0;
  int refused = 0;
  int wrong = 0;
  int passed = 0;
};

class Judgement {
 public:
  void add(const ordered_json& line) {
    const std::string set = line["set"];
    ++runs_[set + "  " + line["variant"].get<std::string>()][line["status"] == "converged" ? 1 : 0];
    if (!line.contains("checks")) return;
    const CheckLimits& limits = limitsOf(line);
    std::string failed;
    for (const ordered_json& check : line["checks"]) {
      if (!fails(check, limits)) continue;
      failed += " " + check["id"].get<std::string>();
      ++by_check_[set + "  " + check["id"].get<std::string>()][line["right"] ? 1 : 0];
    }
    const bool refuses_camera = failed.find(" camera_") != std::string::npos;
    ++by_camera_[set + "  " + line["variant"].get<std::string>()][refuses_camera ? 1 : 0];
    count(line, set, failed);
  }

  int print() const {
    std::printf("%-34s %9s %9s\n", "runs", "converged", "not");
    for (const auto& [name, counts] : runs_)
      std::printf("%-34s %9d %9d\n", name.c_str(), counts[1], counts[0]);
    std::printf("\n%-34s %9s %9s\n", "failed check", "right", "wrong");
    for (const auto& [name, counts] : by_check_)
      std::printf("%-34s %9d %9d\n", name.c_str(), counts[1], counts[0]);
    std::printf("\n%-34s %9s %9s\n", "camera checks", "failed", "passed");
    for (const auto& [name, counts] : by_camera_)
      std::printf("%-34s %9d %9d\n", name.c_str(), counts[1], counts[0]);
    std::printf("\n%s", exceptions_.c_str());
    std::printf("\n%-34s %6s %8s %6s %7s\n", "half", "right", "refused", "wrong", "passed");
    int passed = 0;
    for (const auto& [name, tally] : tallies_) {
      std::printf("%-34s %6d %8d %6d %7d\n", name.c_str(), tally.right, tally.refused, tally.wrong,
                  tally.passed);
      if (name.find("right in the image") == std::string::npos) passed += tally.passed;
    }
    return passed > 0 ? 1 : 0;
  }

 private:
  void count(const ordered_json& line, const std::string& set, const std::string& failed) {
    const std::string id = line["case"];
    const int half = halfOf(id);
    Tally& tally = tallies_[set + groupOf(line) + (half == 0 ? ", set on" : ", held back")];
    const bool right = line["right"];
    // A wrong mesh or camera that leads to a right pose may be refused as well as not.
    const std::string variant = line["variant"];
    const bool doubtful =
        !(isUnaltered(variant) || variant.starts_with("seed") || variant.starts_with("hidden"));
    if (right && doubtful) return;
    ++(right ? tally.right : tally.wrong);
    if (right == failed.empty()) return;
    ++(right ? tally.refused : tally.passed);
    exceptions_ += (right ? "right, refused: " : "WRONG, PASSED:  ") + id + ", " +
                   line["variant"].get<std::string>() + (half == 0 ? ", set" : ", held") +
                   (right ? ":" + failed : " " + line["error"].dump()) + "\n";
  }

  std::map<std::string, std::array<int, 2>> runs_;
  std::map<std::string, std::array<int, 2>> by_check_;
  std::map<std::string, std::array<int, 2>> by_camera_;
  std::map<std::string, Tally> tallies_;
  std::string exceptions_;
};

/// Whether none of a line's checks fails by the presets' limits as they are now.
bool passes(const ordered_json& line) {
  return line.contains("checks") &&
         std::none_of(line["checks"].begin(), line["checks"].end(),
                      [&line](const auto& check) { return fails(check, limitsOf(line)); });
}

/// Judges measured checks by the presets' limits as they are now and prints, for either half of the
/// cases (by a hash of the case's id), how many wrong poses pass and how many right ones are
/// refused, which these are, and by which checks. 1 when a wrong one passes.
int judge(const std::vector<std::string>& files) {
  Judgement judgement;
  for (const std::string& file : files)
    for (const ordered_json& line : linesOf(file)) judgement.add(line);
  return judgement.print();
}

const SessionCase& lender(const Session& session, const SessionCase& session_case) {
  const SessionCase* first = nullptr;
  bool passed = false;
  for (const auto& other : session.cases) {
    passed = passed || other->id == session_case.id;
    if (other->station == session_case.station) continue;
    if (first == nullptr) first = &*other;
    if (passed) return *other;
  }
  return *first;
}

/// Whether a requirement that is one in the image alone is met there: by the mean distance of the
/// station's vertices, each pose through the camera that it was found with. Nothing of the camera's
/// error shows in it.
bool meetsInImage(const CheckedVariant& variant, const Pose& camera_from_station) {
  const sessions::Requirement& required = *variant.loaded->source.requirement;
  if (variant.wrong_mesh || !required.projection_px || required.normal_mm) return false;
  double sum_px = 0.0;
  double count = 0.0;
  for (const auto& vertex : sessions::matchedVertices(variant.loaded->scene.view())) {
    const Eigen::Vector3d point_m = vertex.cast<double>();
    Eigen::Vector2d true_px;
    Eigen::Vector2d found_px;
    if (!project(variant.true_camera, variant.camera_from_station_true * point_m, true_px) ||
        !project(variant.loaded->source.camera, camera_from_station * point_m, found_px))
      continue;
    sum_px += (found_px - true_px).norm();
    count += 1.0;
  }
  return count > 0.0 && sum_px / count <= *required.projection_px;
}

sessions::ReviewSubject subjectOf(const CheckedVariant& variant, const Pose& camera_from_station) {
  sessions::ReviewSubject subject;
  subject.loaded = variant.loaded;
  subject.requirement = *variant.loaded->source.requirement;
  subject.camera_from_station = camera_from_station;
  return subject;
}

ordered_json checksJson(const sessions::ReviewSubject& subject, int convergence_seeds = 0) {
  ordered_json json = ordered_json::array();
  const auto convergence = convergenceTest(subject, convergence_seeds);
  for (const sessions::Check& check : checkPose(subject, sessions::CheckLimits(), convergence))
    json.push_back(sessions::toJson(sessions::JudgedCheck{check, ""}));
  return json;
}

ordered_json measured(const CheckedVariant& variant) {
  ordered_json json;
  try {
    sessions::LocalizationTrace trace = runCase(*variant.loaded, variant.options);
    json["status"] = boresight::localizationStatusText(trace.status);
    if (!trace.converged()) return json;
    const SessionCase& session_case = variant.loaded->source;
    sessions::PoseError error =
        sessions::poseError(variant.camera_from_station_true, trace.camera_from_station,
                            session_case.camera_from_end_effector);
    if (session_case.requirement->projection_px)
      error.projection_px = sessions::projectionError(
          variant.true_camera, variant.camera_from_station_true, trace.camera_from_station,
          sessions::matchedVertices(variant.loaded->scene.view()));
    json["error"] = sessions::toJson(error);
    json["right"] =
        !variant.wrong_mesh && sessions::meetsRequirement(error, *session_case.requirement);
    json["right_in_image"] = meetsInImage(variant, trace.camera_from_station);
    json["pose"] = sessions::exactPoseJson(trace.camera_from_station);
    sessions::ReviewSubject subject = subjectOf(variant, trace.camera_from_station);
    subject.covariance = poseCovariance(session_case, variant.loaded->scene.view(),
                                        trace.camera_from_station, trace.covariance);
    subject.run = std::move(trace);
    json["checks"] = checksJson(subject);
  } catch (const sessions::FileError& error) {
    json["status"] = "refused";
  }
  return json;
}

std::string keyOf(const ordered_json& json) {
  return json["case"].get<std::string>() + "|" + json["variant"].get<std::string>();
}

int measure(const std::string& dataset, const std::string& out, std::size_t every,
            const std::vector<std::string>& kinds) {
  const Session session = sessions::makeSession(dataset);
  std::set<std::string> done;
  for (const ordered_json& line : linesOf(out)) done.insert(keyOf(line));
  std::ofstream stream(out, std::ios::app);
  for (std::size_t i = 0; i < session.cases.size(); ++i) {
    const SessionCase& session_case = *session.cases[i];
    for (const std::string& name : variantNames(isPhotograph(session_case))) {
      const bool asked =
          kinds.empty() || std::ranges::any_of(kinds, [&name](const std::string& kind) {
            return name.starts_with(kind);
          });
      if (!isUnaltered(name) && (i % every != 0 || !asked)) continue;
      ordered_json json = {
          {"case", session_case.id}, {"station", session_case.station}, {"variant", name}};
      json["set"] = isPhotograph(session_case) ? "photographs" : "synthetic";
      if (done.contains(keyOf(json))) continue;
      json.update(
          measured(makeVariant(session, session_case, lender(session, session_case), name)));
      stream << json.dump() << std::endl;
      std::cerr << keyOf(json) << " " << json["status"] << std::endl;
    }
  }
  return 0;
}

bool isOfEdges(const std::string& id) {
  return id.starts_with("edge_") || id.starts_with("camera_");
}

bool isOfConvergence(const std::string& id) { return id.starts_with("convergence_"); }

/// Measures the checks that `which` selects again, on lines that `when` selects; keeps the others.
int measureAnew(const std::string& dataset, const std::string& from, const std::string& to,
                bool (*when)(const ordered_json&), bool (*which)(const std::string&),
                int convergence_seeds) {
  const Session session = sessions::makeSession(dataset);
  const std::size_t done = linesOf(to).size();
  std::ofstream stream(to, std::ios::app);
  std::size_t number = 0;
  for (ordered_json line : linesOf(from)) {
    if (number++ < done) continue;
    const SessionCase* session_case = session.findCase(line["case"].get<std::string>());
    if (session_case != nullptr && line.contains("pose") && when(line)) {
      const CheckedVariant variant =
          makeVariant(session, *session_case, lender(session, *session_case),
                      line["variant"].get<std::string>());
      const auto pose_json = nlohmann::json::parse(line["pose"].dump());
      const Pose pose = sessions::readExactPose(sessions::JsonReader(from, pose_json, "pose"));
      line["right_in_image"] = meetsInImage(variant, pose);
      ordered_json kept = ordered_json::array();
      for (const ordered_json& check : line["checks"])
        if (!which(check["id"].get<std::string>())) kept.push_back(check);
      for (const ordered_json& check : checksJson(subjectOf(variant, pose), convergence_seeds))
        if (which(check["id"].get<std::string>())) kept.push_back(check);
      line["checks"] = kept;
    }
    stream << line.dump() << std::endl;
  }
  return 0;
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() >= 3 && arguments[0] == "measure")
      return boresight::test::measure(
          arguments[1], arguments[2], arguments.size() > 3 ? std::stoul(arguments[3]) : 1,
          {arguments.begin() + std::min<std::ptrdiff_t>(4, std::ssize(arguments)),
           arguments.end()});
    if (arguments.size() == 4 && arguments[0] == "recheck")
      return boresight::test::measureAnew(
          arguments[1], arguments[2], arguments[3],
          [](const nlohmann::ordered_json&) { return true; }, boresight::test::isOfEdges, 0);
    if (arguments.size() == 5 && arguments[0] == "convergence")
      return boresight::test::measureAnew(arguments[1], arguments[2], arguments[3],
                                          boresight::test::passes, boresight::test::isOfConvergence,
                                          std::stoi(arguments[4]));
    if (arguments.size() >= 2 && arguments[0] == "judge")
      return boresight::test::judge({arguments.begin() + 1, arguments.end()});
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
  }
  std::cerr
      << "check_calibration measure DATASET OUT [EVERY [KIND ...]] | recheck DATASET FROM TO | "
         "convergence DATASET "
         "FROM TO SEEDS | judge OUT ..."
      << std::endl;
  return 2;
}
