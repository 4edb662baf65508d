// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sessions/report/pdf_canvas.h"

namespace boresight::sessions {

/// Points that are joined by a line, each with a mark.
struct PdfSeries {
  std::string name;
  std::vector<std::array<double, 2>> points;  ///< x ascending
  PdfColor color = kPdfBlue;
  bool crosses = false;  ///< marks are crosses instead of dots
};

struct PdfPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PdfSeries> series;
  bool log_y = false;          ///< values that are not positive are left out
  bool whole_x = false;        ///< ticks at whole numbers only
  bool names_at_foot = false;  ///< of the series, where the upper right corner is taken
};

/// Draws axes with round ticks, grid, series and their names.
void drawPlot(PdfCanvas& canvas, const PdfBox& box, const PdfPlot& plot);

/// Counts in equal bins from `low` to `high`; what lies beyond counts in the outermost ones.
void drawHistogram(PdfCanvas& canvas, const PdfBox& box, const std::string& title,
                   const std::string& x_label, const std::vector<double>& values, double low,
                   double high, int bins);

/// Round numbers (1, 2 or 5 times a power of ten apart) that span a range, at most `most` of them.
std::vector<double> roundTicks(double low, double high, int most);

}  // namespace boresight::sessions
