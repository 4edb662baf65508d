// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "sessions/session/session.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

/// A file system path with blanks and letters of other scripts, absolute.
inline std::filesystem::path randomPath(Random& random, const char* extension) {
  static const char* const kFolders[] = {"/data", "/data/Sol 12/raw", "/data/\xC3\xBC", "/x"};
  return std::filesystem::path(kFolders[random.below(4)]) /
         ("file " + std::to_string(random.below(1000)) + extension);
}

inline std::string randomSha256(Random& random) {
  std::string text;
  for (int i = 0; i < 64; ++i) text += "0123456789abcdef"[random.below(16)];
  return text;
}

/// Uniform in 0 .. count - 1.
inline std::size_t indexBelow(Random& random, std::size_t count) {
  return random.below(static_cast<std::uint32_t>(count));
}

inline bool coin(Random& random) { return random.below(2) == 0; }

inline sessions::InputFile randomInput(Random& random, const char* extension) {
  return {randomPath(random, extension), randomSha256(random)};
}

inline sessions::MaskStroke randomStroke(Random& random) {
  sessions::MaskStroke stroke;
  stroke.kind = static_cast<sessions::StrokeKind>(random.below(3));
  stroke.erase = coin(random);
  if (coin(random)) stroke.name = "gripper \xC3\xBC";
  if (stroke.kind == sessions::StrokeKind::kSaturation) {
    stroke.level = static_cast<int>(random.below(256));
    return stroke;
  }
  if (stroke.kind == sessions::StrokeKind::kBrush) stroke.radius_px = random.uniform(0.0, 40.0);
  for (std::uint32_t i = random.below(5); i > 0; --i)
    stroke.points.emplace_back(random.uniform(-9.0, 900.0), random.uniform(-9.0, 900.0));
  return stroke;
}

inline sessions::FrameName randomFrame(Random& random) {
  sessions::FrameName frame;
  frame.name = coin(random) ? "ROVER_FRAME" : "SITE \"q\"";
  for (std::uint32_t i = random.below(4); i > 0; --i)
    frame.index.push_back(static_cast<std::int64_t>(random.below(2000)));
  return frame;
}

/// What the label of an image and the frames of poses leave in a case.
inline void addRandomFrames(Random& random, sessions::SessionCase& session_case) {
  if (coin(random))
    session_case.image.label = {{"PRODUCT_ID", "1F483\xC3\xBC"}, {"START_TIME", ""}};
  if (coin(random)) return;
  session_case.camera_reference =
      sessions::CameraReference{randomPose(random), randomFrame(random)};
  if (coin(random)) session_case.camera_reference->frame = {};
  if (coin(random)) return;
  session_case.station_frame = randomFrame(random);
  if (coin(random)) return;
  sessions::FrameTransform& join = session_case.frames.emplace_back();
  join.source = *session_case.station_frame;
  do join.target = randomFrame(random);
  while (join.target == join.source);
  join.origin = static_cast<sessions::TransformSource>(random.below(5));
  if (coin(random)) join.covariance = Matrix6d(Vector6d::Constant(1e-6).asDiagonal());
  join.target_from_source = randomPose(random);
  join.comment = "sol 12";
  join.file = coin(random) ? std::filesystem::path("/data/transform.json")
                           : std::filesystem::path("transform.json");
  join.file_sha256 = randomSha256(random);
  if (coin(random)) session_case.truth_frame = session_case.station_frame;
}

inline void addRandomSymmetries(Random& random, sessions::SessionCase& session_case) {
  if (coin(random)) session_case.symmetries.discrete.push_back(randomPose(random));
  if (coin(random))
    session_case.symmetries.continuous.push_back(
        {randomPose(random).rotation * Eigen::Vector3d::UnitX(), randomPose(random).translation_m});
}

/// How well mesh, camera and truth are known.
inline void addRandomSigmas(Random& random, sessions::SessionCase& session_case) {
  if (coin(random)) session_case.mesh_scale_sigma = random.uniform(0.0, 0.1);
  if (coin(random))
    session_case.calibration_sigma =
        sessions::StatedCalibration{random.uniform(0.0, 0.1), random.uniform(0.0, 9.0)};
  if (!coin(random)) return;
  const Vector6d sigma = Vector6d::Constant(random.uniform(1e-4, 1e-2));
  session_case.truth_covariance = sigma * sigma.transpose();
}

inline sessions::SessionCase randomCase(Random& random, const std::string& id) {
  sessions::SessionCase session_case;
  session_case.id = id;
  if (coin(random)) session_case.station = "station \"q\"";
  session_case.image.source = randomInput(random, ".png");
  session_case.image.width = 1 + static_cast<int>(random.below(4000));
  session_case.image.height = 1 + static_cast<int>(random.below(4000));
  session_case.image.pixels_sha256 = randomSha256(random);
  if (coin(random)) session_case.image.color_sha256 = randomSha256(random);
  auto& eight_bit = session_case.image.eight_bit;
  if (coin(random)) eight_bit.bit_depth = 1 + static_cast<int>(random.below(8));
  if (coin(random)) eight_bit.bayer = static_cast<sessions::BayerPattern>(random.below(4));
  if (eight_bit.bit_depth && coin(random))
    for (int i = 0; i < 1 << *eight_bit.bit_depth; ++i)
      eight_bit.table.push_back(static_cast<std::uint8_t>(random.below(256)));
  if (eight_bit.bit_depth && eight_bit.table.empty() && coin(random))
    eight_bit.levels = sessions::GrayLevels{0, (1 << *eight_bit.bit_depth) - 1};
  session_case.camera = randomCamera(random, static_cast<CameraModel>(random.below(3)));
  for (std::uint32_t i = 1u + random.below(3); i > 0; --i) {
    sessions::MeshInput& part = session_case.parts.emplace_back();
    auto& source = part.source;
    source.mesh = randomPath(random, ".ply");
    source.mesh_unit = coin(random) ? "m" : "mm";
    if (coin(random)) source.name = "part \"q\"";
    if (coin(random)) source.frame_from_mesh = randomPose(random);
    source.normal_threshold_rad = random.uniform(0.1, 1.0);
    source.depth_threshold_m = random.uniform(0.001, 0.1);
    if (i > 1) source.state = {static_cast<sessions::PartRole>(random.below(3)), coin(random)};
    if (source.state.role != sessions::PartRole::kMatched && coin(random))
      source.frame = sessions::kCameraFrame;
    if (coin(random)) source.albedo = random.uniform(0.0, 1.0);
    part.sha256 = randomSha256(random);
  }
  if (coin(random)) session_case.feature_size_m = random.uniform(0.001, 0.1);
  session_case.camera_from_station_seed = randomPose(random);
  session_case.uncertainty.translation_m = randomVector(random, 0.05).cwiseAbs();
  session_case.uncertainty.rotation_deg = randomVector(random, 9.0).cwiseAbs();
  if (coin(random)) session_case.uncertainty.pivot = sessions::UncertaintyPivot::kStation;
  if (coin(random)) session_case.camera_from_station_truth = randomPose(random);
  if (coin(random))
    session_case.truth_source =
        sessions::TruthSource{static_cast<sessions::TruthOrigin>(random.below(4)), "truth.json",
                              randomSha256(random), randomSha256(random)};
  addRandomSigmas(random, session_case);
  if (coin(random)) session_case.camera_from_station_working = randomPose(random);
  if (coin(random)) session_case.ignore = randomInput(random, ".png");
  for (std::uint32_t i = random.below(3); i > 0; --i)
    session_case.ignore_strokes.push_back(randomStroke(random));
  if (coin(random)) session_case.onboard_record = randomInput(random, ".whsr");
  if (coin(random)) session_case.rig = sessions::Rig{"rig", randomPose(random)};
  if (coin(random)) session_case.tags = {"low sun", "dusty"};
  if (coin(random)) session_case.requirement.emplace().normal_mm = random.uniform(0.1, 2.0);
  if (session_case.requirement && coin(random))
    session_case.requirement->projection_px = random.uniform(0.1, 2.0);
  if (coin(random)) session_case.camera_from_end_effector = randomPose(random);
  addRandomFrames(random, session_case);
  if (coin(random)) session_case.landmarks = randomPath(random, ".json");
  addRandomSymmetries(random, session_case);
  return session_case;
}

inline sessions::Annotations randomAnnotations(Random& random) {
  sessions::Annotations annotations;
  for (std::uint32_t i = 1u + random.below(6); i > 0; --i) {
    sessions::PointPair& point = annotations.points.emplace_back();
    point.id = "p" + std::to_string(i);
    point.point_in_station_m = randomVector(random, 0.3);
    if (coin(random))
      point.pixel = Eigen::Vector2d(random.uniform(0.0, 2000.0), random.uniform(0.0, 2000.0));
    point.sigma_px = random.uniform(0.1, 3.0);
    point.enabled = coin(random);
    point.locked = coin(random);
    if (coin(random)) point.comment = "at the\nsecond \"screw\" \xE2\x80\x93 unsure";
  }
  if (coin(random)) {
    sessions::LinePair& line = annotations.lines.emplace_back();
    line.id = "l1";
    line.edge = sessions::ModelEdge{randomVector(random, 0.3), randomVector(random, 0.3)};
  }
  return annotations;
}

inline sessions::AnnotationRounds randomRounds(Random& random) {
  sessions::AnnotationRounds rounds;
  for (std::uint32_t i = 1u + random.below(3); i > 0; --i)
    rounds.push_back({"Ada \xC3\x9C", "2026-01-31T23:59:59Z", randomAnnotations(random)});
  return rounds;
}

inline LocalizerOptions randomOptions(Random& random) {
  LocalizerOptions options;
  LocalizerOptions::visitFields(options, [&random](const OptionInfo& info, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    if (random.below(8) != 0) return;
    const double value = random.uniform(info.minimum, std::min(info.maximum, info.minimum + 100.0));
    if constexpr (std::is_same_v<Field, bool>)
      field = !field;
    else if constexpr (!std::is_same_v<Field, double>)
      field = static_cast<Field>(static_cast<std::int64_t>(value));
    else
      field = value;
  });
  return options;
}

/// Options are such as may change on the way of a run.
inline sessions::RerunRecord randomRerun(Random& random) {
  sessions::RunPlan plan(randomOptions(random));
  for (std::int32_t i = 1; i < 4; ++i) {
    LocalizerOptions options = plan.last();
    options.pnp.seed += 1 + random.below(99);
    options.loop.inlier_threshold_px = random.uniform(0.1, 200.0);
    if (i == 1 || coin(random)) plan.changes.push_back({i * 3, options});
  }
  return {plan, coin(random) ? randomSha256(random) : ""};
}

inline sessions::Check randomCheck(Random& random) {
  sessions::Check check;
  check.id = "check_" + std::to_string(random.below(100));
  check.title = "A check";
  check.state = static_cast<sessions::CheckState>(random.below(3));
  check.sentence = "what was found";
  if (coin(random)) check.figure = random.uniform(-1.0, 1.0);
  if (coin(random)) check.limit = random.uniform(-1.0, 1.0);
  if (check.limit && coin(random)) check.side = sessions::LimitSide::kAtLeast;
  if (coin(random)) check.unit = "mm";
  return check;
}

inline sessions::Decision randomDecision(Random& random, const std::string& case_id) {
  sessions::Decision decision{case_id,
                              static_cast<sessions::Verdict>(random.below(3)),
                              "Ada",
                              "looks right",
                              "2026-01-31T23:59:59Z",
                              coin(random) ? randomSha256(random) : ""};
  for (std::uint32_t i = random.below(4); i > 0; --i)
    decision.checks.push_back({randomCheck(random), coin(random) ? "a reason" : ""});
  if (coin(random)) {
    decision.pose.emplace();
    decision.pose->source = static_cast<sessions::PoseSource>(random.below(2));
    decision.pose->camera_from_station = randomPose(random);
    decision.pose->covariance.picture(1, 2) = random.uniform(-1.0, 1.0);
    decision.pose->covariance.mesh_scale(5, 5) = random.uniform(0.0, 1.0);
  }
  if (coin(random)) decision.input_fingerprint["truth"] = randomSha256(random);
  if (coin(random)) decision.approval = {"Bob", "", "2026-01-31T23:59:59Z"};
  return decision;
}

/// A run of a case that converged.
inline sessions::RunRecord randomRun(Random& random, const std::string& case_id) {
  return {case_id, randomSha256(random),   randomPath(random, ".trace"), "converged",
          "0.1.0", "2026-01-31T23:59:59Z", randomSha256(random),         randomSha256(random)};
}

inline sessions::Session randomSession(Random& random) {
  sessions::Session session =
      sessions::withOptions({}, coin(random) ? "default" : "paper", randomOptions(random));
  session.review.second_person = coin(random);
  if (coin(random)) session.review.preset = "photographs";
  for (std::uint32_t i = random.below(5); i > 0; --i) {
    const std::string id = "case " + std::to_string(i);
    session.cases.push_back(randomCase(random, id));
    if (coin(random)) session = withAnnotations(session, id, randomAnnotations(random));
    if (coin(random)) session = withRounds(session, id, randomRounds(random));
    if (coin(random)) session.decisions.push_back(randomDecision(random, id));
    if (coin(random)) session.runs.push_back(randomRun(random, id));
    if (coin(random) && !session.runs.empty())
      session.runs.back().together = sessions::TogetherRecord{
          {{id, "converged"}, {"another \xC3\xBC", "too_few_matches"}}, randomSha256(random)};
    if (coin(random) && !session.runs.empty()) session.runs.back().rerun = randomRerun(random);
    if (coin(random) && !session.runs.empty())
      session.runs.back().end_effector_in_camera_m = randomVector(random, 0.5);
    if (coin(random)) session.view = {id, "", static_cast<std::int32_t>(random.below(9)) - 1};
  }
  session.robust_annotations = coin(random);
  return session;
}

/// Something that a person might do to a session.
inline sessions::Session randomEdit(Random& random, const sessions::Session& session) {
  if (session.cases.empty() || random.below(6) == 0)
    return withCase(session, randomCase(random, "new " + std::to_string(random.below(1000000))));
  const sessions::SessionCase& session_case =
      *session.cases[indexBelow(random, session.cases.size())];
  sessions::Session next = session;
  switch (random.below(7)) {
    case 5:
      return withRounds(session, session_case.id,
                        coin(random) ? randomRounds(random) : sessions::AnnotationRounds());
    case 0:
      return withoutCase(session, session_case.id);
    case 1:
      return withAnnotations(session, session_case.id, randomAnnotations(random));
    case 2:
      return withOptions(session, "default", randomOptions(random));
    case 3:
      next.decisions.push_back(
          {session_case.id, sessions::Verdict::kRejected, "Ada", "no", "2026-01-31T23:59:59Z", ""});
      return next;
    case 4:
      std::swap(next.cases.front(), next.cases.back());
      return next;
    default:
      return withChanged(session, session_case.id, [&random](sessions::SessionCase& moved) {
        moved.camera_from_station_seed = randomPose(random);
      });
  }
}

}  // namespace boresight::test
