// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/run_rows.h"

#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

template <class Row>
Column<Row> text(const char* name, std::string Row::*field, const char* type = "TEXT NOT NULL") {
  return {
      name, type, [field](const Row& row) { return SqlValue(row.*field); },
      [field](Row& row, const SqlValue& value, const fs::path&) { row.*field = textOf(value); }};
}

template <class Row, class Integer>
Column<Row> integer(const char* name, Integer Row::*field) {
  return {name, "INTEGER NOT NULL",
          [field](const Row& row) { return SqlValue(static_cast<std::int64_t>(row.*field)); },
          [field](Row& row, const SqlValue& value, const fs::path&) {
            row.*field = static_cast<Integer>(integerOf(value));
          }};
}

/// A number that is not finite has no value: NULL, read back as 0.
template <class Row>
Column<Row> real(const char* name, double Row::*field, const char* type = "REAL") {
  return {name, type,
          [field](const Row& row) {
            return std::isfinite(row.*field) ? SqlValue(row.*field) : SqlValue();
          },
          [field](Row& row, const SqlValue& value, const fs::path&) {
            row.*field = realOf(value).value_or(0.0);
          }};
}

/// A number that may be unknown: NULL.
template <class Row>
Column<Row> known(const char* name, std::optional<double> Row::*field) {
  return {
      name, "REAL", [field](const Row& row) { return sqlReal(row.*field); },
      [field](Row& row, const SqlValue& value, const fs::path&) { row.*field = realOf(value); }};
}

/// The numbers of "[[...], ...]", 4x4; nothing where the text is anything else.
std::optional<Eigen::Matrix4d> plainMatrix(const std::string& text) {
  const auto rows = nlohmann::json::parse(text, nullptr, false);
  if (!rows.is_array() || rows.size() != 4) return std::nullopt;
  Eigen::Matrix4d matrix;
  for (int i = 0; const auto& row : rows) {
    if (!row.is_array() || row.size() != 4) return std::nullopt;
    for (int j = 0; const auto& cell : row) {
      if (!cell.is_number()) return std::nullopt;
      matrix(i, j++) = cell.template get<double>();
    }
    ++i;
  }
  return matrix;
}

/// A pose as this program writes it; nothing for all others, which readTransform judges. A
/// JsonReader notes the place of each number: with many rows that takes most of the time.
std::optional<Pose> plainPose(const std::string& text) {
  constexpr double kNear_m = 1000.0;
  const auto matrix = plainMatrix(text);
  if (!matrix || matrix->row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) return std::nullopt;
  const Eigen::Vector3d translation_m = matrix->topRightCorner<3, 1>();
  Pose pose;
  double deviation = 0.0;
  if (translation_m.cwiseAbs().maxCoeff() > kNear_m ||
      poseFromMatrix(matrix->topLeftCorner<3, 3>(), translation_m, pose, deviation) != Status::kOk)
    return std::nullopt;
  return pose;
}

/// InputError with the place and the reason.
Pose readPoseText(const std::string& text, const fs::path& file) {
  if (const auto pose = plainPose(text)) return *pose;
  const JsonDocument document(file, text);
  return readTransform(document.root());
}

template <class Row>
Column<Row> pose(const char* name, Pose Row::*field) {
  return {name, "TEXT NOT NULL",
          [field](const Row& row) { return SqlValue(toJson(row.*field).dump()); },
          [field](Row& row, const SqlValue& value, const fs::path& file) {
            row.*field = readPoseText(textOf(value), file);
          }};
}

template <class Row>
void addSeconds(std::vector<Column<Row>>& columns) {
  for (const auto& [name, part] : kStages)
    columns.push_back({std::string("s_") + name, "REAL",
                       [part = part](const Row& row) { return SqlValue(row.seconds.*part); },
                       [part = part](Row& row, const SqlValue& value, const fs::path&) {
                         row.seconds.*part = realOf(value).value_or(0.0);
                       }});
  columns.push_back(
      {"s_total", "REAL", [](const Row& row) { return SqlValue(row.seconds.total()); }});
}

/// A number of an optional struct; NULL when the struct is empty.
template <class Row, class Struct, class Number>
Column<Row> partOf(std::string name, std::optional<Struct> Row::*field, Number Struct::*part) {
  return {std::move(name), "REAL",
          [field, part](const Row& row) {
            return row.*field ? sqlReal((*(row.*field)).*part) : SqlValue();
          },
          [field, part](Row& row, const SqlValue& value, const fs::path&) {
            const std::optional<double> real = realOf(value);
            if (!real) return;
            if (!(row.*field)) (row.*field).emplace();
            (*(row.*field)).*part = *real;
          }};
}

/// An error has values in the columns of all of its own parts, or in none; those of the model may
/// be missing.
template <class Row>
void addError(std::vector<Column<Row>>& columns, const std::string& prefix,
              std::optional<PoseError> Row::*field,
              std::span<const std::pair<const char*, std::optional<double> PoseError::*>> model) {
  for (const auto& [name, part] : kErrorParts)
    columns.push_back(partOf(prefix + name, field, part));
  for (const auto& [name, part] : model) columns.push_back(partOf(prefix + name, field, part));
}

SqlValue requirementText(const RunResult& run) {
  return run.requirement ? SqlValue(toJson(*run.requirement).dump()) : SqlValue();
}

void readRequirementText(RunResult& run, const SqlValue& value, const fs::path& file) {
  if (textOf(value).empty()) return;
  const JsonDocument document(file, textOf(value));
  run.requirement = readRequirement(document.root());
}

template <class Row>
Column<Row> flag(const char* name, bool Row::*field) {
  return {name, "INTEGER NOT NULL", [field](const Row& row) { return sqlFlag(row.*field); },
          [field](Row& row, const SqlValue& value, const fs::path&) {
            row.*field = integerOf(value) != 0;
          }};
}

/// A rotation as it is, [w, x, y, z]: a matrix would not give the same bits back.
SqlValue quaternionText(const RunResult& run) {
  const Eigen::Quaterniond& q = run.camera_from_station_seed.rotation;
  return nlohmann::json({q.w(), q.x(), q.y(), q.z()}).dump();
}

void readQuaternionText(RunResult& run, const SqlValue& value, const fs::path& file) {
  if (textOf(value).empty()) return;
  const JsonDocument document(file, textOf(value));
  const std::vector<JsonReader> parts = document.root().elements(4);
  run.camera_from_station_seed.rotation = Eigen::Quaterniond(parts[0].number(), parts[1].number(),
                                                             parts[2].number(), parts[3].number());
}

std::vector<Column<RunResult>> makeRunColumns() {
  using Run = RunResult;
  std::vector<Column<Run>> columns = {
      integer("dataset_index", &Run::dataset_index),
      text("case_id", &Run::case_id),
      integer("reseed", &Run::reseed),
      text("station", &Run::station),
      text("method", &Run::method),
      text("status", &Run::status),
      text("message", &Run::message),
      flag("completed", &Run::completed),
      {"success", "INTEGER", [](const Run& run) { return sqlFlag(run.success); },
       [](Run& run, const SqlValue& value, const fs::path&) {
         if (realOf(value)) run.success = integerOf(value) != 0;
       }},
      flag("false_positive", &Run::false_positive),
      flag("gross_false_positive", &Run::gross_false_positive),
      integer("iterations", &Run::iterations),
      integer("matches", &Run::matches),
      integer("inliers", &Run::inliers),
      real("edge_support", &Run::edge_support),
      known("probability", &Run::probability),
      known("evidence_nats", &Run::evidence_nats),
      known("weakest_quadrant_nats", &Run::weakest_quadrant_nats),
      known("region_nats", &Run::region_nats),
      known("evidence_share", &Run::evidence_share),
      known("expected_nats", &Run::expected_nats),
      integer("compared_poses", &Run::compared_poses),
      text("compared", &Run::compared),
      known("score_gap", &Run::score_gap),
      integer("competing_poses", &Run::competing_poses),
      known("least_margin_nats", &Run::least_margin_nats)};
  for (const auto& [name, part] : kImageQualityParts)
    columns.push_back(partOf(name, &Run::image_quality, part));
  addError(columns, "", &Run::error, kModelErrorParts);
  addError(columns, "seed_", &Run::seed_error, kModelErrorParts);
  columns.push_back({"requirement", "TEXT", requirementText, readRequirementText});
  addSeconds(columns);
  columns.push_back(pose("camera_from_station", &Run::camera_from_station));
  columns.push_back(pose("camera_from_station_seed", &Run::camera_from_station_seed));
  columns.push_back({"seed_quaternion", "TEXT NOT NULL", quaternionText, readQuaternionText});
  columns.push_back(text("digest", &Run::digest));
  columns.push_back(text("inputs_sha256", &Run::inputs_sha256));
  return columns;
}

std::vector<Column<RunStep>> makeStepColumns() {
  using Step = RunStep;
  std::vector<Column<Step>> columns = {integer("step", &Step::index),
                                       integer("attempt", &Step::attempt),
                                       text("kind", &Step::kind),
                                       integer("level", &Step::level),
                                       text("status", &Step::status),
                                       real("threshold_px", &Step::threshold_px),
                                       integer("templates", &Step::templates),
                                       integer("matches", &Step::matches),
                                       integer("support", &Step::support),
                                       real("rms_px", &Step::rms_px),
                                       real("best_score", &Step::best_score),
                                       real("mean_score", &Step::mean_score),
                                       real("correction_mm", &Step::correction_mm),
                                       real("correction_mrad", &Step::correction_mrad),
                                       real("correction_px", &Step::correction_px)};
  addSeconds(columns);
  columns.push_back(pose("camera_from_station", &Step::camera_from_station));
  addError(columns, "", &Step::error, std::span(kModelErrorParts).first(1));  // projection_px
  return columns;
}

/// One of a vector's coordinates.
template <class Vector>
Column<MatchDetails> coordinate(const char* name, Vector MatchDetails::*field, int axis) {
  return {name, "REAL", [field, axis](const MatchDetails& match) {
            const double value = (match.*field)[axis];
            return std::isfinite(value) ? SqlValue(value) : SqlValue();
          }};
}

std::vector<Column<MatchDetails>> makeMatchColumns() {
  using Match = MatchDetails;
  return {integer("template", &Match::index),
          coordinate("station_x_m", &Match::point_in_station_m, 0),
          coordinate("station_y_m", &Match::point_in_station_m, 1),
          coordinate("station_z_m", &Match::point_in_station_m, 2),
          real("depth_m", &Match::depth_m),
          coordinate("predicted_x_px", &Match::predicted_px, 0),
          coordinate("predicted_y_px", &Match::predicted_px, 1),
          coordinate("found_x_px", &Match::found_px, 0),
          coordinate("found_y_px", &Match::found_px, 1),
          flag("searched", &Match::searched),
          flag("at_border", &Match::at_border),
          real("score", &Match::score),
          real("second_score", &Match::second_score),
          flag("inlier", &Match::inlier),
          real("residual_px", &Match::residual_px)};
}

constexpr std::int64_t kVersionWithoutInputs = 5;

template <class Row>
RowTable<Row> withoutLast(RowTable<Row> table) {
  table.columns.pop_back();
  return table;
}

}  // namespace

const RowTable<MethodFacts>& methodTable() {
  using Method = MethodFacts;
  static const RowTable<Method> kTable = {
      {text("method", &Method::method, "TEXT PRIMARY KEY"), text("profile", &Method::profile),
       text("options", &Method::options), text("options_sha256", &Method::options_sha256),
       real("reseed_scale", &Method::reseed_scale, "REAL NOT NULL"),
       text("mesh_of", &Method::mesh_of), text("mirror", &Method::mirror),
       text("note", &Method::note)}};
  return kTable;
}

const RowTable<BatchRun>& batchRunTable() {
  static const RowTable<BatchRun> kTable = {
      {text("began", &BatchRun::began), text("ended", &BatchRun::ended),
       text("version", &BatchRun::version), text("machine", &BatchRun::machine),
       text("processor", &BatchRun::processor), text("system", &BatchRun::system),
       text("command", &BatchRun::command), text("folder", &BatchRun::folder),
       integer("jobs", &BatchRun::jobs), integer("threads", &BatchRun::threads),
       text("kernels", &BatchRun::kernels), text("shard", &BatchRun::shard),
       integer("reseeds", &BatchRun::reseeds), integer("runs", &BatchRun::runs),
       real("seconds", &BatchRun::seconds, "REAL NOT NULL")}};
  return kTable;
}

const RowTable<RunResult>& runTable() {
  static const RowTable<RunResult> kTable = {makeRunColumns()};
  return kTable;
}

const RowTable<RunStep>& stepTable() {
  static const RowTable<RunStep> kTable = {makeStepColumns()};
  return kTable;
}

const RowTable<RunResult>& runTableOf(std::int64_t version) {
  static const RowTable<RunResult> kOlder = withoutLast(runTable());
  return version == kVersionWithoutInputs ? kOlder : runTable();
}

const RowTable<RunStep>& stepTableOf(std::int64_t version) {
  static const RowTable<RunStep> kOlder = withoutLast(stepTable());
  return version == kVersionWithoutInputs ? kOlder : stepTable();
}

const RowTable<MatchDetails>& matchTable() {
  static const RowTable<MatchDetails> kTable = {makeMatchColumns()};
  return kTable;
}

}  // namespace boresight::sessions
