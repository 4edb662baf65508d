// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/error_strips.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "sessions/tables/station_runs.h"

namespace boresight::sessions {
namespace {

constexpr double kStripMargin = 12.0;
constexpr double kStripTitleHeight = 18.0;
constexpr double kStripPanelHeight = 170.0;
constexpr double kStripFootHeight = 24.0;
constexpr double kAxisWidth = 30.0;
constexpr double kMark = 0.8;
constexpr std::size_t kMostMarks = 400;
constexpr double kUnit = 0.01;  ///< mm or mrad: the scale is linear below
constexpr double kTicks[] = {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0};

constexpr PdfColor kGreen = {0.00, 0.62, 0.45};
constexpr PdfColor kRed = {0.80, 0.15, 0.10};

/// Errors of the seeds, each once.
std::vector<double> seedErrors(const StationRuns& row, double PoseError::*part) {
  std::set<std::pair<std::string, std::int32_t>> seen;
  std::vector<double> errors;
  for (const RunResult* run : row.all)
    if (run->seed_error && seen.insert({run->case_id, run->reseed}).second)
      errors.push_back((*run->seed_error).*part);
  return errors;
}

std::vector<double> evenlyByRank(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  std::sort(values.begin(), values.end());
  if (values.size() <= kMostMarks) return values;
  std::vector<double> shown;
  for (std::size_t i = 0; i < kMostMarks; ++i)
    shown.push_back(values[i * (values.size() - 1) / (kMostMarks - 1)]);
  return shown;
}

/// A panel's area and scale.
struct Panel {
  PdfBox area;
  double low = 0.0;
  double high = 1.0;  ///< in decades
  std::size_t strips = 1;

  double pageY(double value) const {
    const double share = (signedDecades(value, kUnit) - low) / (high - low);
    return area.bottom() - area.height * std::clamp(share, 0.0, 1.0);
  }
  double width() const { return area.width / static_cast<double>(strips); }
  double left(std::size_t strip) const { return area.x + width() * static_cast<double>(strip); }
};

void drawMarks(PdfCanvas& canvas, const Panel& panel, std::size_t strip,
               const std::vector<double>& values, const PdfColor& color, bool crosses) {
  constexpr double kGolden = 0.61803398875;  // spreads marks evenly without chance
  const std::vector<double> shown = evenlyByRank(values);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double spread = std::fmod(kGolden * static_cast<double>(i), 1.0);
    const double x = panel.left(strip) + panel.width() * (0.15 + 0.7 * spread);
    const double y = panel.pageY(shown[i]);
    crosses ? canvas.cross(x, y, kMark, color) : canvas.circle(x, y, kMark, color, true);
  }
}

void drawScale(PdfCanvas& canvas, const Panel& panel, const ErrorAxis& axis,
               const std::optional<double>& limit) {
  const auto within = [&](double value) {
    const double at = signedDecades(value, kUnit);
    return at >= panel.low && at <= panel.high;
  };
  drawTickY(canvas, panel.area, panel.pageY(0.0), 0.0);
  for (const double value : kTicks)
    for (const double sign : {-1.0, 1.0})
      if ((sign > 0.0 || axis.is_signed) && within(sign * value))
        drawTickY(canvas, panel.area, panel.pageY(sign * value), sign * value);
  canvas.frame(panel.area, kFaintInk);
  if (!limit) return;
  for (const double sign : {-1.0, 1.0}) {
    if ((sign < 0.0 && !axis.is_signed) || !within(sign * *limit)) continue;
    const double y = panel.pageY(sign * *limit);
    canvas.polyline({{panel.area.x, y}, {panel.area.right(), y}}, kInk, 0.8, {1.2, 1.6});
  }
}

void drawName(PdfCanvas& canvas, const Panel& panel, std::size_t strip, const std::string& name) {
  canvas.text(panel.left(strip), panel.area.bottom() + 1.5, panel.width(), name,
              {5.5, false, false, kFaintInk, 2, PdfTextStyle::Align::kCentre});
}

void drawPanel(PdfCanvas& canvas, const PdfBox& box, const StationRuns& row,
               const ErrorAxis& axis) {
  const std::vector<double> seeds = seedErrors(row, axis.part);
  std::vector<ErrorStrip> strips;
  double most = std::abs(sharedLimit(row.all, axis.limit).value_or(kUnit));
  for (const RunGroup& group : row.methods) {
    strips.push_back(errorStrip(group.runs, axis.part));
    for (const std::vector<double>* values :
         {&std::as_const(strips.back().completed), &std::as_const(strips.back().failed), &seeds})
      for (const double value : *values)
        if (std::isfinite(value)) most = std::max(most, std::abs(value));
  }
  Panel panel;
  panel.area = {box.x + kAxisWidth, box.y + 12.0, box.width - kAxisWidth, box.height - 32.0};
  panel.high = 1.05 * signedDecades(most, kUnit);
  panel.low = axis.is_signed ? -panel.high : 0.0;
  panel.strips = 1 + strips.size();
  canvas.text(box.x, box.y, box.width, row.title + ": " + axis.label, {7.5, true, false, kInk, 1});
  drawScale(canvas, panel, axis, sharedLimit(row.all, axis.limit));
  drawMarks(canvas, panel, 0, seeds, kPdfBlue, false);
  drawName(canvas, panel, 0, "input");
  for (std::size_t i = 0; i < strips.size(); ++i) {
    drawMarks(canvas, panel, i + 1, strips[i].failed, kRed, true);
    drawMarks(canvas, panel, i + 1, strips[i].completed, kGreen, false);
    drawName(canvas, panel, i + 1, row.methods[i].method);
  }
}

}  // namespace

ErrorStrip errorStrip(std::span<const RunResult* const> runs, double PoseError::*part) {
  ErrorStrip strip;
  for (const RunResult* run : runs) {
    if (const PoseError* error = run->completedError())
      strip.completed.push_back(error->*part);
    else if (!run->completed && run->seed_error)
      strip.failed.push_back((*run->seed_error).*part);
  }
  return strip;
}

double signedDecades(double value, double unit) {
  return std::copysign(std::log10(1.0 + std::abs(value) / unit), value);
}

Figure errorStripsFigure(std::span<const RunResult> runs, CanvasFormat format) {
  const std::vector<StationRuns> rows = stationRuns(runs);
  const std::string title = "Distribution of errors: seeds, completed runs, failed runs";
  PdfCanvas canvas(title, format, PdfCanvas::kWidth,
                   2.0 * kStripMargin + kStripTitleHeight + kStripFootHeight +
                       kStripPanelHeight * static_cast<double>(rows.size()));
  const double width = PdfCanvas::kWidth - 2.0 * kStripMargin;
  canvas.text(kStripMargin, kStripMargin, width, title, {10.0, true, false, kInk, 1});
  const double panel_width = width / static_cast<double>(std::size(kErrorAxes));
  double y = kStripMargin + kStripTitleHeight;
  for (const StationRuns& row : rows) {
    for (std::size_t i = 0; i < std::size(kErrorAxes); ++i)
      drawPanel(canvas,
                {kStripMargin + panel_width * static_cast<double>(i), y, panel_width - 6.0,
                 kStripPanelHeight},
                row, kErrorAxes[i]);
    y += kStripPanelHeight;
  }
  canvas.text(kStripMargin, y, width,
              "Blue: errors of the seeds. Green: completed runs. Red crosses: failed runs, which "
              "keep their seeds' errors. Dotted: requirement. The scale is linear below 0.01.",
              {7.0, false, false, kInk, 2});
  return {kStripsFigure, canvas.finish()};
}

}  // namespace boresight::sessions
