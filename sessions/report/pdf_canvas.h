// SPDX-License-Identifier: Apache-2.0
// Pages of a PDF, or one picture as SVG or PNG, drawn without a display (Cairo and Pango).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sessions/run/overlay.h"

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
/// Two that people who confuse red and green tell apart (Okabe and Ito 2008).
inline constexpr PdfColor kPdfBlue = {0.00, 0.45, 0.70};
inline constexpr PdfColor kPdfOrange = {0.84, 0.37, 0.00};

struct PdfTextStyle {
  double size = 8.5;  ///< pt
  bool bold = false;
  bool fixed = false;  ///< all letters of one width, for numbers in columns
  PdfColor color = kInk;
  int max_lines = 0;  ///< what goes beyond is cut with an ellipsis; 0: no limit
  enum class Align { kLeft, kCentre, kRight } align = Align::kLeft;
};

/// What a canvas becomes. A PNG has 2.5 pixels a point, on white.
enum class CanvasFormat { kPdf, kSvg, kPng };

/// A4, upright, unless another size is asked for. Not for several threads.
class PdfCanvas {
 public:
  static constexpr double kWidth = 595.0;
  static constexpr double kHeight = 842.0;

  /// `title` goes into the file's properties. OutputError is not its business: pages are kept in
  /// memory until `finish`.
  explicit PdfCanvas(const std::string& title, CanvasFormat format = CanvasFormat::kPdf,
                     double width = kWidth, double height = kHeight);
  ~PdfCanvas();
  PdfCanvas(const PdfCanvas&) = delete;
  PdfCanvas& operator=(const PdfCanvas&) = delete;

  /// Ends the page and begins the next one; only a PDF has several.
  void nextPage();
  int page() const { return page_; }  ///< from 1

  /// Text (UTF-8; what is not is replaced) broken at the box's width; the height that it takes, pt.
  double text(double x, double y, double width, const std::string& text,
              const PdfTextStyle& style = {});
  /// The height that it would take.
  double textHeight(double width, const std::string& text, const PdfTextStyle& style = {}) const;

  void line(double x0, double y0, double x1, double y1, const PdfColor& color, double width = 0.6);
  /// `dashes`: lengths drawn and left out in turn, pt; empty: a whole line.
  void polyline(const std::vector<std::array<double, 2>>& points, const PdfColor& color,
                double width, const std::vector<double>& dashes = {});
  void circle(double x, double y, double radius, const PdfColor& color, bool filled);
  void cross(double x, double y, double radius, const PdfColor& color);
  void fill(const PdfBox& box, const PdfColor& color);
  void frame(const PdfBox& box, const PdfColor& color, double width = 0.6);
  /// Fitted into the box with its own proportions, at its top left; the box that it takes.
  PdfBox picture(const PdfBox& box, const ColorImage& image);

  /// What lies outside of the box is not drawn until `unclip`.
  void clip(const PdfBox& box);
  void unclip();

  /// The whole file; nothing can be drawn afterwards. std::bad_alloc or std::runtime_error.
  std::vector<std::uint8_t> finish();

 private:
  struct Pieces;
  std::unique_ptr<Pieces> pieces_;
  int page_ = 1;
};

}  // namespace boresight::sessions
