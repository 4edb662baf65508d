// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/result_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "sessions/report/pdf_canvas.h"
#include "sessions/tables/results_set.h"
#include "sessions/tables/station_runs.h"

namespace boresight::sessions {
namespace {

constexpr double kPanelHeight = 150.0;
constexpr double kFigureMargin = 12.0;
constexpr double kFigureTitleHeight = 18.0;
constexpr int kSeedBins = 8;
constexpr int kToleranceSteps = 41;

using Members = std::vector<const RunResult*>;

/// Distinguishes methods by colour (Okabe and Ito 2008) and by dashes.
class Styles {
 public:
  explicit Styles(std::span<const RunResult> runs) {
    std::set<std::string, decltype(&methodBefore)> names(&methodBefore);
    for (const RunResult& run : runs) names.insert(run.method);
    std::size_t next = 0;
    for (const std::string& name : names)
      styles_[name] = name == "whs" ? PdfSeries{name, {}, kPdfBlue} : styleOf(name, next++);
  }
  PdfSeries of(const std::string& method) const { return styles_.at(method); }
  std::vector<PdfSeries> list() const {
    std::vector<PdfSeries> made;
    for (const auto& [name, style] : styles_) made.push_back(style);
    std::sort(made.begin(), made.end(),
              [](const auto& a, const auto& b) { return methodBefore(b.name, a.name); });
    return made;
  }

 private:
  static PdfSeries styleOf(const std::string& name, std::size_t index) {
    static const PdfColor kColors[] = {{0.84, 0.37, 0.00}, {0.00, 0.62, 0.45}, {0.80, 0.47, 0.65},
                                       {0.34, 0.71, 0.91}, {0.90, 0.62, 0.00}, {0.35, 0.35, 0.40}};
    static const std::vector<double> kDashes[] = {{5.0, 2.0}, {1.2, 1.6}, {6.0, 1.5, 1.2, 1.5},
                                                  {3.0, 3.0}, {8.0, 2.0}, {2.0, 1.0}};
    PdfSeries style{name, {}, kColors[index % std::size(kColors)]};
    style.dashes = kDashes[index % std::size(kDashes)];
    style.crosses = index % 2 == 0;
    return style;
  }
  std::map<std::string, PdfSeries> styles_;
};

/// Panels side by side, row by row, with one list of methods at the foot.
std::vector<std::uint8_t> drawPanels(const std::string& title, CanvasFormat format, int columns,
                                     const std::vector<PdfPlot>& plots, const Styles& styles) {
  const std::vector<PdfSeries> names = styles.list();
  const std::size_t rows =
      (plots.size() + static_cast<std::size_t>(columns) - 1) / static_cast<std::size_t>(columns);
  const double top = kFigureMargin + kFigureTitleHeight;
  const double foot = top + static_cast<double>(rows) * kPanelHeight;
  PdfCanvas canvas(title, format, PdfCanvas::kWidth,
                   foot + kFigureMargin + 11.0 * static_cast<double>(names.size()) + 6.0);
  canvas.text(kFigureMargin, kFigureMargin, PdfCanvas::kWidth - 2.0 * kFigureMargin, title,
              {10.0, true, false, kInk, 1});
  const double width = (PdfCanvas::kWidth - 2.0 * kFigureMargin) / columns;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const int row = static_cast<int>(i) / columns;
    const int column = static_cast<int>(i) % columns;
    drawPlot(
        canvas,
        {kFigureMargin + column * width, top + row * kPanelHeight, width - 8.0, kPanelHeight - 6.0},
        plots[i]);
  }
  drawSeriesNames(canvas, kFigureMargin + 34.0, foot, 300.0, names);
  return canvas.finish();
}

PdfPlot emptyPlot(const StationRuns& station, const std::string& x_label,
                  const std::string& y_label) {
  PdfPlot plot{station.title, x_label, y_label, {}};
  plot.with_names = false;
  return plot;
}

/// From nothing at `from` on; a method of which nothing completed stays there.
PdfSeries staircase(PdfSeries style, const CurvePoints& points, double from, double until) {
  style.marks = false;
  style.points = {{from, 0.0}};
  if (!points.empty()) style.points.push_back({points.front()[0], 0.0});
  style.points.insert(style.points.end(), points.begin(), points.end());
  style.points.push_back({until, style.points.back()[1]});
  return style;
}

PdfPlot errorPlot(const StationRuns& station, const ErrorAxis& axis, const Styles& styles) {
  constexpr double kLow = 1e-3;
  constexpr double kHigh = 1e3;
  PdfPlot plot = emptyPlot(station, axis.label + std::string(axis.is_signed ? " (absolute)" : ""),
                           "% of runs at or below");
  plot.log_x = true;
  plot.x_range = {kLow, kHigh};
  plot.y_range = {0.0, 104.0};
  for (const RunGroup& group : station.methods) {
    std::vector<double> values;
    for (const RunResult* run : group.runs)
      if (const PoseError* error = run->completedError())
        values.push_back(std::max(kLow, std::abs(error->*axis.part)));
    plot.series.push_back(
        staircase(styles.of(group.method), shareBelow(values, group.runs.size()), kLow, kHigh));
  }
  if (const auto limit = sharedLimit(station.all, axis.limit))
    plot.guides.push_back({*limit, "requirement"});
  return plot;
}

PdfPlot tolerancePlot(const StationRuns& station, const Styles& styles) {
  static const std::vector<double> kFactors = geometricSteps(0.05, 20.0, kToleranceSteps);
  PdfPlot plot = emptyPlot(station, "multiple of the requirement", "% of runs within");
  plot.log_x = true;
  plot.x_range = {kFactors.front(), kFactors.back()};
  plot.y_range = {0.0, 104.0};
  plot.guides.push_back({1.0, "requirement"});
  for (const RunGroup& group : station.methods) {
    plot.series.push_back(styles.of(group.method));
    plot.series.back().marks = false;
    plot.series.back().points = successAgainstTolerance(group.runs, kFactors);
  }
  return plot;
}

PdfPlot seedPlot(const StationRuns& station, SeedMeasure measure, const Styles& styles) {
  PdfPlot plot =
      emptyPlot(station,
                measure == SeedMeasure::kDistance_mm ? "seed off, mm (normal and lateral)"
                                                     : "seed off, mrad (whole angle)",
                "% successful");
  plot.y_range = {0.0, 104.0};
  for (const RunGroup& group : station.methods) {
    plot.series.push_back(styles.of(group.method));
    plot.series.back().points = successAgainstSeed(group.runs, measure, kSeedBins);
  }
  return plot;
}

/// One coordinate of all points.
std::vector<double> coordinates(const CurvePoints& points, std::size_t index) {
  std::vector<double> values;
  for (const auto& point : points) values.push_back(point[index]);
  return values;
}

/// Every run faintly small, and where the middle of both lies.
void addTimes(const Members& members, const PdfSeries& style, PdfPlot& plot) {
  PdfSeries each = style;
  each.line = false;
  each.mark_radius = 0.7;
  each.points = timeAgainstError(members);
  const std::vector<double> seconds = coordinates(each.points, 0);
  const std::vector<double> errors = coordinates(each.points, 1);
  plot.series.push_back(std::move(each));
  PdfSeries middle = style;
  middle.line = false;
  middle.mark_radius = 4.0;
  if (const auto time = median(seconds))
    middle.points.push_back({*time, median(errors).value_or(0.0)});
  plot.series.push_back(std::move(middle));
}

/// Whole powers of ten around all values above zero; 0.1 to 10 without any.
std::array<double, 2> decades(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const double value : values) {
    if (!(value > 0.0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(high > 0.0)) return {0.1, 10.0};
  const double first = std::floor(std::log10(low));
  const double last = std::max(first + 1.0, std::ceil(std::log10(high)));
  return {std::pow(10.0, first), std::pow(10.0, last)};
}

/// All panels have the same axes.
void takeSharedAxes(const std::vector<StationRuns>& stations, PdfPlot& plot) {
  CurvePoints points;
  for (const StationRuns& station : stations)
    std::ranges::move(timeAgainstError(station.all), std::back_inserter(points));
  plot.log_x = plot.log_y = true;
  plot.x_range = decades(coordinates(points, 0));
  plot.y_range = decades(coordinates(points, 1));
}

}  // namespace

CurvePoints shareBelow(std::vector<double> values, std::size_t of) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  std::sort(values.begin(), values.end());
  CurvePoints points;
  const auto percent = [of](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(of, 1));
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!points.empty()) points.push_back({values[i], percent(i)});
    points.push_back({values[i], percent(i + 1)});
  }
  return points;
}

CurvePoints successAgainstTolerance(std::span<const RunResult* const> runs,
                                    std::span<const double> factors) {
  CurvePoints points;
  for (const double factor : factors)
    if (const auto percent = percentWithin(runs, factor)) points.push_back({factor, *percent});
  return points;
}

std::optional<double> seedMeasure(const RunResult& run, SeedMeasure measure) {
  if (!run.seed_error) return std::nullopt;
  if (measure == SeedMeasure::kAngle_mrad) return run.seed_error->geodesic_mrad;
  return std::hypot(run.seed_error->normal_mm, run.seed_error->lateral_mm);
}

CurvePoints successAgainstSeed(std::span<const RunResult* const> runs, SeedMeasure measure,
                               int bins) {
  std::vector<std::pair<double, bool>> seeds;
  for (const RunResult* run : runs)
    if (const auto far = seedMeasure(*run, measure); far && run->success)
      seeds.emplace_back(*far, *run->success);
  std::sort(seeds.begin(), seeds.end());
  CurvePoints points;
  const std::size_t groups = std::min(static_cast<std::size_t>(std::max(bins, 1)), seeds.size());
  for (std::size_t group = 0; group < groups; ++group) {
    const std::size_t begin = group * seeds.size() / groups;
    const std::size_t end = (group + 1) * seeds.size() / groups;
    double sum = 0.0;
    int successful = 0;
    for (std::size_t i = begin; i < end; ++i) {
      sum += seeds[i].first;
      successful += seeds[i].second ? 1 : 0;
    }
    const auto count = static_cast<double>(end - begin);
    points.push_back({sum / count, 100.0 * successful / count});
  }
  return points;
}

CurvePoints timeAgainstError(std::span<const RunResult* const> runs) {
  CurvePoints points;
  for (const RunResult* run : runs)
    if (const PoseError* error = run->completedError())
      points.push_back({run->seconds.total(), error->lateral_mm});
  return points;
}

std::vector<double> geometricSteps(double low, double high, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i)
    steps.push_back(low * std::pow(high / low, count > 1 ? i / (count - 1.0) : 0.0));
  return steps;
}

std::vector<Figure> resultFigures(std::span<const RunResult> runs, CanvasFormat format) {
  const std::vector<StationRuns> stations = stationRuns(runs);
  const Styles styles(runs);
  std::vector<PdfPlot> errors, tolerances, seeds, times;
  for (const StationRuns& station : stations) {
    for (const ErrorAxis& axis : kErrorAxes) errors.push_back(errorPlot(station, axis, styles));
    tolerances.push_back(tolerancePlot(station, styles));
    for (const SeedMeasure measure : {SeedMeasure::kDistance_mm, SeedMeasure::kAngle_mrad})
      seeds.push_back(seedPlot(station, measure, styles));
    times.push_back(emptyPlot(station, "seconds per run", "lateral error, mm"));
    takeSharedAxes(stations, times.back());
    for (const RunGroup& group : station.methods)
      addTimes(group.runs, styles.of(group.method), times.back());
  }
  const auto figure = [&](const char* name, const char* title, int columns,
                          const std::vector<PdfPlot>& plots) {
    return Figure{name, drawPanels(title, format, columns, plots, styles)};
  };
  return {
      figure(kErrorFigure,
             "Distribution of errors: percent of all runs that completed with at most this "
             "error",
             3, errors),
      figure(kToleranceFigure, "Success against tolerance", 2, tolerances),
      figure(kSeedFigure, "Success against the seed's error (each mark: an eighth of the runs)", 2,
             seeds),
      figure(kTimeFigure, "Time against accuracy: each completed run, and the medians", 2, times)};
}

const char* extensionOf(CanvasFormat format) {
  constexpr const char* kExtensions[] = {".pdf", ".svg", ".png"};
  return kExtensions[static_cast<std::size_t>(format)];
}

}  // namespace boresight::sessions
