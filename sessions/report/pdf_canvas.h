// SPDX-License-Identifier: Apache-2.0
// Pages of a PDF, or one picture as SVG or PNG, drawn without a display (Cairo and Pango).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sessions/trace/overlay.h"

namespace boresight::sessions {

/// In points (1/72 inch), from the upper left corner of the page.
struct PdfBox {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

/// Red, green, blue in 0 ... 1.
using PdfColor = std::array<double, 3>;
inline constexpr PdfColor kInk = {0.10, 0.10, 0.12};
inline constexpr PdfColor kFaintInk = {0.45, 0.45, 0.50};
inline constexpr PdfColor kPaperGrid = {0.85, 0.85, 0.88};
/// Distinct also for readers who confuse red and green (Okabe and Ito 2008).
inline constexpr PdfColor kPdfBlue = {0.00, 0.45, 0.70};
inline constexpr PdfColor kPdfOrange = {0.84, 0.37, 0.00};

struct PdfTextStyle {
  double size = 8.5;  ///< pt
  bool bold = false;
  bool fixed = false;  ///< monospaced, for numbers in columns
  PdfColor color = kInk;
  int max_lines = 0;  ///< further lines are cut with an ellipsis; 0: no limit
  enum class Align { kLeft, kCentre, kRight } align = Align::kLeft;
};

/// Output format of a canvas. A PNG has 2.5 pixels per point, on white.
enum class CanvasFormat { kPdf, kSvg, kPng };

/// A4 upright by default. Not thread-safe.
class PdfCanvas {
 public:
  static constexpr double kWidth = 595.0;
  static constexpr double kHeight = 842.0;

  /// `title` is stored in the file's properties. Pages are kept in memory until finish().
  explicit PdfCanvas(const std::string& title, CanvasFormat format = CanvasFormat::kPdf,
                     double width = kWidth, double height = kHeight);
  ~PdfCanvas();
  PdfCanvas(const PdfCanvas&) = delete;
  PdfCanvas& operator=(const PdfCanvas&) = delete;

  /// Ends the page and begins the next one; only a PDF has several.
  void nextPage();
  int page() const { return page_; }  ///< from 1

  /// Draws text (UTF-8; invalid bytes are replaced) wrapped at `width`. Returns its height, pt.
  double text(double x, double y, double width, const std::string& text,
              const PdfTextStyle& style = {});

  void line(double x0, double y0, double x1, double y1, const PdfColor& color, double width = 0.6);
  /// `dashes`: lengths drawn and left out in turn, pt; empty: a solid line.
  void polyline(const std::vector<std::array<double, 2>>& points, const PdfColor& color,
                double width, const std::vector<double>& dashes = {});
  void circle(double x, double y, double radius, const PdfColor& color, bool filled);
  void cross(double x, double y, double radius, const PdfColor& color);
  void fill(const PdfBox& box, const PdfColor& color);
  void frame(const PdfBox& box, const PdfColor& color, double width = 0.6);
  /// Draws an image fitted into the box at its top left, keeping its aspect ratio. Returns its box.
  PdfBox picture(const PdfBox& box, const ColorImage& image);

  /// Restricts drawing to the box until unclip().
  void clip(const PdfBox& box);
  void unclip();

  /// The whole file; nothing can be drawn afterwards. std::bad_alloc or std::runtime_error.
  std::vector<std::uint8_t> finish();

 private:
  struct Pieces;
  std::unique_ptr<Pieces> pieces_;
  int page_ = 1;
};

/// Points that are joined by a line, each with a mark.
struct PdfSeries {
  std::string name;
  std::vector<std::array<double, 2>> points;  ///< x ascending
  PdfColor color = kPdfBlue;
  bool crosses = false;  ///< marks are crosses instead of dots
  bool line = true;
  bool marks = true;
  std::vector<double> dashes = {};  ///< of the line, see PdfCanvas::polyline
  double mark_radius = 1.7;         ///< pt
};

/// An upright line with a name, e.g. at a limit.
struct PdfGuide {
  double x = 0.0;
  std::string name;
};

struct PdfPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PdfSeries> series;
  bool log_y = false;          ///< values that are not positive are left out
  bool whole_x = false;        ///< ticks at whole numbers only
  bool names_at_foot = false;  ///< series names at the bottom, when the upper right is occupied
  bool log_x = false;          ///< values that are not positive are left out
  std::optional<std::array<double, 2>> x_range = {};  ///< instead of the range of the points
  std::optional<std::array<double, 2>> y_range = {};
  std::vector<PdfGuide> guides = {};
  bool with_names = true;  ///< of the series; several plots side by side may share one list
};

/// Draws axes with round ticks, grid, series and their names.
void drawPlot(PdfCanvas& canvas, const PdfBox& box, const PdfPlot& plot);

/// Draws the names of series with their lines and marks, one below the other. Returns the height.
double drawSeriesNames(PdfCanvas& canvas, double x, double y, double width,
                       const std::vector<PdfSeries>& series);

/// Draws a grid line across an area, with its value to the left.
void drawTickY(PdfCanvas& canvas, const PdfBox& area, double y, double value);

/// Counts in equal bins from `low` to `high`; values beyond count in the outermost ones.
void drawHistogram(PdfCanvas& canvas, const PdfBox& box, const std::string& title,
                   const std::string& x_label, const std::vector<double>& values, double low,
                   double high, int bins);

/// Round numbers (1, 2 or 5 times a power of ten apart) that span a range, at most `most` of them.
std::vector<double> roundTicks(double low, double high, int most);

}  // namespace boresight::sessions
