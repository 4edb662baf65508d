// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/trends.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/math.h"
#include "sessions/checks/checks.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_run.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr double kNormalQuartile = 0.6745;  ///< MAD of a normal distribution of sigma 1

std::string timeOf(const SessionCase& session_case) {
  for (const LabelItem& item : session_case.image.label)
    if (item.name == "START_TIME") return item.value;
  return "";
}

/// The case with an end effector: the camera's centre where none is known.
SessionCase withEndEffector(SessionCase session_case) {
  if (!session_case.camera_from_end_effector) session_case.camera_from_end_effector = Pose();
  return session_case;
}

TrendPoint pointOf(const std::filesystem::path& file, const Session& session,
                   const SessionCase& session_case, const LocalizationTrace& run) {
  TrendPoint point;
  point.session = file;
  point.case_id = session_case.id;
  point.station = session_case.station;
  point.time = timeOf(session_case);
  const auto loaded = loadCase(session_case);
  const Matrix6d covariance =
      poseCovariance(session_case, loaded->scene.view(), run.camera_from_station, run.covariance)
          .total();
  // Without turns by symmetries, which no command corrects.
  const PoseComparer comparer(*loaded);
  const Pose pose =
      comparer.equivalent(run.camera_from_station, session_case.camera_from_station_seed);
  const Correction correction =
      correctionsOf(withEndEffector(session_case), pose, comparer.determined(covariance, pose))
          .front();
  const Vector6d sigma = sigmasOf(correction.covariance);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<Eigen::Index>(axis);
    point.figures[axis] = 1e3 * correction.translation_m[index];
    point.figures[3 + axis] = 1e3 * correction.rotation_rad[index];
    point.sigmas[axis] = 1e3 * sigma[3 + index];
    point.sigmas[3 + axis] = 1e3 * sigma[index];
  }
  if (!run.iterations.empty()) point.figures[6] = run.iterations.back()->rms_px();
  const ReviewStatus status = reviewStatusOf(session, session_case.id);
  point.review = reviewStatusText(status);
  if (status.decision != nullptr)
    point.checks_failed = static_cast<int>(std::count_if(
        status.decision->checks.begin(), status.decision->checks.end(),
        [](const JudgedCheck& judged) { return judged.check.state == CheckState::kFailed; }));
  return point;
}

std::map<std::string, std::vector<std::size_t>> byStation(std::span<const TrendPoint> points) {
  std::map<std::string, std::vector<std::size_t>> stations;
  for (std::size_t i = 0; i < points.size(); ++i) stations[points[i].station].push_back(i);
  return stations;
}

void flagFigure(std::size_t figure, const std::vector<std::size_t>& members,
                std::vector<TrendPoint>& points) {
  std::vector<double> values;
  for (const std::size_t i : members) values.push_back(points[i].figures[figure]);
  const double median = medianOf(values);
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - median));
  const double spread = medianOf(deviations);
  for (const std::size_t i : members) {
    const double scale = std::max(spread, kNormalQuartile * points[i].sigmas[figure]);
    points[i].outlier[figure] =
        kNormalQuartile * std::abs(points[i].figures[figure] - median) > kOutlierScores * scale;
  }
}

std::string failedText(const TrendPoint& point) {
  return point.checks_failed ? std::to_string(*point.checks_failed) : "";
}

std::string flagsText(const TrendPoint& point) {
  std::string text;
  for (std::size_t figure = 0; figure < kTrendFigures; ++figure)
    if (point.outlier[figure]) text += (text.empty() ? "" : " ") + std::string(kTrendNames[figure]);
  return text;
}

/// The points of a figure, and the outliers among them.
void addSeries(std::span<const TrendPoint> points, const std::vector<std::size_t>& members,
               std::size_t figure, PdfPlot& plot) {
  static const std::array<PdfColor, 3> kColors = {kPdfBlue, kPdfOrange, kInk};
  PdfSeries series;
  PdfSeries outliers;
  series.name = kTrendNames[figure];
  series.color = kColors[figure % 3];
  outliers.color = series.color;
  outliers.crosses = true;
  outliers.line = false;
  outliers.mark_radius = 4.0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const TrendPoint& point = points[members[i]];
    const std::array<double, 2> place = {static_cast<double>(i + 1), point.figures[figure]};
    series.points.push_back(place);
    if (point.outlier[figure]) outliers.points.push_back(place);
  }
  plot.series.push_back(std::move(series));
  if (!outliers.points.empty()) plot.series.push_back(std::move(outliers));
}

void drawStation(PdfCanvas& canvas, std::span<const TrendPoint> points, const std::string& station,
                 const std::vector<std::size_t>& members) {
  constexpr double kPageMargin = 40.0;
  constexpr double kPlotHeight = 200.0;
  canvas.text(kPageMargin, kPageMargin, PdfCanvas::kWidth - 2 * kPageMargin,
              "Station " + station + ": " + std::to_string(members.size()) + " runs",
              {.size = 13.0, .bold = true});
  double top = kPageMargin + 30.0;
  for (const auto& [title, first, count, unit] :
       {std::tuple("Correction to command", 0, 3, "mm"), std::tuple("", 3, 3, "mrad"),
        std::tuple("Residual of the last iteration", 6, 1, "px")}) {
    PdfPlot plot;
    plot.title = title;
    plot.x_label = "run";
    plot.y_label = unit;
    plot.whole_x = true;
    for (int figure = first; figure < first + count; ++figure)
      addSeries(points, members, static_cast<std::size_t>(figure), plot);
    drawPlot(canvas, {kPageMargin, top, PdfCanvas::kWidth - 2 * kPageMargin, kPlotHeight}, plot);
    top += kPlotHeight + 20.0;
  }
}

}  // namespace

bool TrendPoint::flagged() const {
  return std::find(outlier.begin(), outlier.end(), true) != outlier.end();
}

std::vector<TrendPoint> trendOf(const Session& session, const std::filesystem::path& file,
                                std::vector<std::string>& remarks, const std::stop_token& stop) {
  std::vector<TrendPoint> points;
  for (const auto& session_case : session.cases) {
    if (stop.stop_requested()) break;
    const RunRecord* record = session.lastRunOf(session_case->id);
    if (record == nullptr) {
      remarks.push_back(file.string() + ": case " + session_case->id + " has no run");
      continue;
    }
    if (inputsChangedSince(*record, session) || endEffectorChangedSince(*record, session)) {
      remarks.push_back(file.string() + ": case " + session_case->id +
                        " is left out: its inputs have changed since its run; run it again");
      continue;
    }
    const LocalizationTrace run = loadSnapshot(*record);
    if (!run.converged()) {
      remarks.push_back(file.string() + ": case " + session_case->id + " did not converge");
      continue;
    }
    points.push_back(pointOf(file, session, *session_case, run));
  }
  return points;
}

void flagOutliers(std::vector<TrendPoint>& points) {
  for (const auto& [station, members] : byStation(points)) {
    if (members.size() < kFewestForOutliers) continue;
    for (std::size_t figure = 0; figure < kTrendFigures; ++figure)
      flagFigure(figure, members, points);
  }
}

std::string trendTable(std::span<const TrendPoint> points) {
  TextTable table({"case", "station", "x mm", "y mm", "z mm", "rx mrad", "ry mrad", "rz mrad", "px",
                   "failed checks", "review", "stands out"});
  for (const TrendPoint& point : points) {
    std::vector<std::string> row = {point.case_id, point.station};
    for (const double figure : point.figures) row.push_back(fixedText(figure, 3));
    const std::string failed = failedText(point);
    row.insert(row.end(), {failed.empty() ? "-" : failed, point.review, flagsText(point)});
    table.add(row);
  }
  return table.text();
}

std::string trendCsv(std::span<const TrendPoint> points) {
  std::string text = "session,case,station,time";
  for (const char* name : kTrendNames) text += std::string(",") + name + ",sigma_of_" + name;
  text += ",checks_failed,review,stands_out\n";
  for (const TrendPoint& point : points) {
    text += csvField(point.session.string()) + "," + csvField(point.case_id) + "," +
            csvField(point.station) + "," + csvField(point.time);
    for (std::size_t figure = 0; figure < kTrendFigures; ++figure)
      text += "," + fixedText(point.figures[figure], 6) + "," + fixedText(point.sigmas[figure], 6);
    text += "," + failedText(point) + "," + csvField(point.review) + "," +
            csvField(flagsText(point)) + "\n";
  }
  return text;
}

std::vector<std::uint8_t> trendPdf(std::span<const TrendPoint> points) {
  PdfCanvas canvas("Trends");
  bool first = true;
  for (const auto& [station, members] : byStation(points)) {
    if (!first) canvas.nextPage();
    first = false;
    drawStation(canvas, points, station, members);
  }
  return canvas.finish();
}

}  // namespace boresight::sessions
