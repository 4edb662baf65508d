// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/pdf_canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

constexpr double kLabelSize = 6.5;

/// From values to the page.
struct Axes {
  PdfBox box;  ///< of the area within the axes
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  bool log_y = false;
  bool log_x = false;

  double scaledY(double y) const { return log_y ? std::log10(y) : y; }
  double scaledX(double x) const { return log_x ? std::log10(x) : x; }
  double pageX(double x) const {
    return box.x + box.width * (scaledX(x) - x_low) / (x_high - x_low);
  }
  double pageY(double y) const {
    return box.bottom() - box.height * (scaledY(y) - y_low) / (y_high - y_low);
  }
};

std::string tickText(double value) {
  return formatText("%.6g", std::abs(value) < 1e-12 ? 0.0 : value);
}

bool isDrawn(const PdfPlot& plot, const std::array<double, 2>& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && (!plot.log_y || point[1] > 0.0) &&
         (!plot.log_x || point[0] > 0.0);
}

void widen(double& low, double& high, double share) {
  if (!(low <= high)) {
    low = 0.0;
    high = 1.0;
  }
  if (low == high) {
    low -= 0.5;
    high += 0.5;
  }
  const double room = share * (high - low);
  low -= room;
  high += room;
}

Axes axesOf(const PdfBox& area, const PdfPlot& plot) {
  Axes axes;
  axes.box = area;
  axes.log_y = plot.log_y;
  axes.log_x = plot.log_x;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  axes.x_low = axes.y_low = kFar;
  axes.x_high = axes.y_high = -kFar;
  for (const PdfSeries& series : plot.series) {
    for (const auto& point : series.points) {
      if (!isDrawn(plot, point)) continue;
      axes.x_low = std::min(axes.x_low, axes.scaledX(point[0]));
      axes.x_high = std::max(axes.x_high, axes.scaledX(point[0]));
      axes.y_low = std::min(axes.y_low, axes.scaledY(point[1]));
      axes.y_high = std::max(axes.y_high, axes.scaledY(point[1]));
    }
  }
  if (!plot.log_y) axes.y_low = std::min(axes.y_low, 0.0);
  widen(axes.x_low, axes.x_high, 0.04);
  widen(axes.y_low, axes.y_high, 0.06);
  if (plot.x_range) {
    axes.x_low = axes.scaledX((*plot.x_range)[0]);
    axes.x_high = axes.scaledX((*plot.x_range)[1]);
  }
  if (plot.y_range) {
    axes.y_low = axes.scaledY((*plot.y_range)[0]);
    axes.y_high = axes.scaledY((*plot.y_range)[1]);
  }
  return axes;
}

void drawTickX(PdfCanvas& canvas, const Axes& axes, double value) {
  const double x = axes.pageX(value);
  canvas.line(x, axes.box.y, x, axes.box.bottom(), kPaperGrid, 0.4);
  canvas.text(x - 20.0, axes.box.bottom() + 1.5, 40.0, tickText(value),
              {kLabelSize, false, false, kFaintInk, 1, PdfTextStyle::Align::kCentre});
}

void drawTicks(PdfCanvas& canvas, const Axes& axes, const PdfPlot& plot) {
  for (const double value : roundTicks(axes.x_low, axes.x_high, 7))
    if (!(plot.whole_x || plot.log_x) || value == std::floor(value))
      drawTickX(canvas, axes, plot.log_x ? std::pow(10.0, value) : value);
  for (const double value : roundTicks(axes.y_low, axes.y_high, 5)) {
    if (plot.log_y && value != std::floor(value)) continue;
    const double y = plot.log_y ? std::pow(10.0, value) : value;
    drawTickY(canvas, axes.box, axes.pageY(y), y);
  }
}

void drawMark(PdfCanvas& canvas, double x, double y, const PdfSeries& series) {
  series.crosses ? canvas.cross(x, y, series.mark_radius + 0.1, series.color)
                 : canvas.circle(x, y, series.mark_radius, series.color, true);
}

void drawSeries(PdfCanvas& canvas, const Axes& axes, const PdfPlot& plot, const PdfSeries& series) {
  std::vector<std::array<double, 2>> page;
  for (const auto& point : series.points)
    if (isDrawn(plot, point)) page.push_back({axes.pageX(point[0]), axes.pageY(point[1])});
  if (series.line) canvas.polyline(page, series.color, 0.9, series.dashes);
  if (!series.marks) return;
  for (const auto& point : page) drawMark(canvas, point[0], point[1], series);
}

void drawGuides(PdfCanvas& canvas, const Axes& axes, const PdfPlot& plot) {
  for (const PdfGuide& guide : plot.guides) {
    const double x = axes.pageX(guide.x);
    canvas.polyline({{x, axes.box.y}, {x, axes.box.bottom()}}, kFaintInk, 0.7, {2.0, 1.5});
    // Below the middle: curves of shares run along the top and the bottom.
    canvas.text(x + 2.0, axes.box.y + 0.6 * axes.box.height, 60.0, guide.name,
                {kLabelSize, false, false, kFaintInk, 1});
  }
}

/// Title above, labels around; the area within the axes is what remains.
PdfBox drawSurroundings(PdfCanvas& canvas, const PdfBox& box, const std::string& title,
                        const std::string& x_label, const std::string& y_label) {
  canvas.text(box.x, box.y, box.width, title, {8.0, true, false, kInk, 1});
  canvas.text(box.x, box.y + 10.5, box.width, y_label, {kLabelSize, false, false, kFaintInk, 1});
  const PdfBox area = {box.x + 34.0, box.y + 21.0, box.width - 40.0, box.height - 42.0};
  canvas.text(area.x, area.bottom() + 10.0, area.width, x_label,
              {kLabelSize, false, false, kFaintInk, 1, PdfTextStyle::Align::kCentre});
  return area;
}

void drawNames(PdfCanvas& canvas, const PdfBox& area, const PdfPlot& plot) {
  if (!plot.with_names || plot.series.size() < 2) return;
  double y = plot.names_at_foot ? area.bottom() - 9.0 * static_cast<double>(plot.series.size())
                                : area.y + 2.0;
  for (const PdfSeries& series : plot.series) {
    const std::string sign = series.crosses ? "\xC3\x97 " : "\xE2\x97\x8F ";
    y += canvas.text(area.x, y, area.width - 3.0, sign + series.name,
                     {kLabelSize, false, false, series.color, 1, PdfTextStyle::Align::kRight});
  }
}

}  // namespace

std::vector<double> roundTicks(double low, double high, int most) {
  std::vector<double> ticks;
  if (!(low < high) || most < 1 || !std::isfinite(high - low)) return ticks;
  const double rough = (high - low) / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= rough) step = factor * power;
  for (double i = std::ceil(low / step); i * step <= high; i += 1.0) ticks.push_back(i * step);
  return ticks;
}

void drawTickY(PdfCanvas& canvas, const PdfBox& area, double y, double value) {
  canvas.line(area.x, y, area.right(), y, kPaperGrid, 0.4);
  canvas.text(area.x - 34.0, y - 4.0, 32.0, tickText(value),
              {kLabelSize, false, false, kFaintInk, 1, PdfTextStyle::Align::kRight});
}

void drawPlot(PdfCanvas& canvas, const PdfBox& box, const PdfPlot& plot) {
  const PdfBox area = drawSurroundings(canvas, box, plot.title, plot.x_label, plot.y_label);
  const Axes axes = axesOf(area, plot);
  drawTicks(canvas, axes, plot);
  canvas.frame(area, kFaintInk);
  canvas.clip(area);
  drawGuides(canvas, axes, plot);
  for (const PdfSeries& series : plot.series) drawSeries(canvas, axes, plot, series);
  canvas.unclip();
  drawNames(canvas, area, plot);
}

double drawSeriesNames(PdfCanvas& canvas, double x, double y, double width,
                       const std::vector<PdfSeries>& series) {
  constexpr double kSample = 24.0;
  double taken = 0.0;
  for (const PdfSeries& pdf_series : series) {
    const double middle = y + taken + 5.0;
    if (pdf_series.line)
      canvas.polyline({{x, middle}, {x + kSample, middle}}, pdf_series.color, 0.9,
                      pdf_series.dashes);
    if (pdf_series.marks) drawMark(canvas, x + 0.5 * kSample, middle, pdf_series);
    taken += 1.5 + canvas.text(x + kSample + 4.0, y + taken, width - kSample - 4.0, pdf_series.name,
                               {7.0, false, false, kInk, 1});
  }
  return taken;
}

void drawHistogram(PdfCanvas& canvas, const PdfBox& box, const std::string& title,
                   const std::string& x_label, const std::vector<double>& values, double low,
                   double high, int bins) {
  const PdfBox area = drawSurroundings(canvas, box, title, x_label, "count");
  std::vector<double> counts(static_cast<std::size_t>(bins), 0.0);
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double place = std::floor((value - low) / (high - low) * bins);
    counts[static_cast<std::size_t>(std::clamp(place, 0.0, bins - 1.0))] += 1.0;
  }
  Axes axes{area, low, high, 0.0,
            1.05 * std::max(1.0, *std::max_element(counts.begin(), counts.end()))};
  for (const double value : roundTicks(low, high, 6)) drawTickX(canvas, axes, value);
  for (const double value : roundTicks(0.0, axes.y_high, 4))
    drawTickY(canvas, area, axes.pageY(value), value);
  const double width = area.width / bins;
  for (int i = 0; i < bins; ++i) {
    const double top = axes.pageY(counts[static_cast<std::size_t>(i)]);
    canvas.fill({area.x + i * width + 0.3, top, width - 0.6, area.bottom() - top}, kPdfBlue);
  }
  canvas.frame(area, kFaintInk);
}

}  // namespace boresight::sessions
