// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/pdf_canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <pango/pangocairo.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace boresight::sessions {
namespace {

constexpr int kLongestPictureSide_px = 1400;
constexpr int kJpegQuality = 88;
constexpr double kPngPixelsPerPoint = 2.5;

struct LayoutDeleter {
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
};
using Layout = std::unique_ptr<PangoLayout, LayoutDeleter>;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  try {
    auto* out = static_cast<std::vector<std::uint8_t>*>(bytes);
    out->insert(out->end(), data, data + length);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::bad_alloc&) {  // not through C
    return CAIRO_STATUS_NO_MEMORY;
  }
}

std::string validUtf8(const std::string& text) {
  char* valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  std::string result = valid;
  g_free(valid);
  return result;
}

constexpr PangoAlignment kAlignments[] = {PANGO_ALIGN_LEFT, PANGO_ALIGN_CENTER,
                                          PANGO_ALIGN_RIGHT};  ///< by PdfTextStyle::Align

Layout makeLayout(cairo_t* cairo, double width, const std::string& text,
                  const PdfTextStyle& style) {
  Layout layout(pango_cairo_create_layout(cairo));
  PangoFontDescription* font = pango_font_description_new();
  pango_font_description_set_family(font, style.fixed ? "DejaVu Sans Mono" : "DejaVu Sans");
  pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
  pango_font_description_set_weight(font, style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
  pango_layout_set_font_description(layout.get(), font);
  pango_font_description_free(font);
  pango_layout_set_width(layout.get(), static_cast<int>(width * PANGO_SCALE));
  pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
  pango_layout_set_alignment(layout.get(), kAlignments[static_cast<std::size_t>(style.align)]);
  if (style.max_lines > 0) {
    pango_layout_set_height(layout.get(), -style.max_lines);
    pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
  }
  const std::string valid = validUtf8(text);
  pango_layout_set_text(layout.get(), valid.data(), static_cast<int>(valid.size()));
  return layout;
}

double heightOf(PangoLayout* layout) {
  int width = 0;
  int height = 0;
  pango_layout_get_size(layout, &width, &height);
  return static_cast<double>(height) / PANGO_SCALE;
}

/// As a page needs it: a PDF takes JPEG as it is, which keeps a report small.
cv::Mat scaledDown(const ColorImage& image) {
  const cv::Mat whole(image.height, image.width, CV_8UC3,
                      const_cast<std::uint8_t*>(image.bgr.data()));
  const double scale =
      static_cast<double>(kLongestPictureSide_px) / std::max(image.width, image.height);
  if (scale >= 1.0) return whole;
  cv::Mat small;
  cv::resize(whole, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

cairo_surface_t* makeSurface(const cv::Mat& bgr) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, bgr.cols, bgr.rows);
  cairo_surface_flush(surface);
  if (unsigned char* data = cairo_image_surface_get_data(surface)) {
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
    cv::Mat pixels(bgr.size(), CV_8UC4, data, stride);
    cv::cvtColor(bgr, pixels, cv::COLOR_BGR2BGRA);  // RGB24 in memory, on little-endian machines
  }
  cairo_surface_mark_dirty(surface);
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", bgr, jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  auto* kept = static_cast<unsigned char*>(g_memdup2(jpeg.data(), jpeg.size()));
  cairo_surface_set_mime_data(surface, CAIRO_MIME_TYPE_JPEG, kept, jpeg.size(), g_free, kept);
  return surface;
}

}  // namespace

struct PdfCanvas::Pieces {
  CanvasFormat format = CanvasFormat::kPdf;
  std::vector<std::uint8_t> bytes;
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;

  void color(const PdfColor& rgb) const { cairo_set_source_rgb(cairo, rgb[0], rgb[1], rgb[2]); }
};

PdfCanvas::PdfCanvas(const std::string& title, CanvasFormat format, double width, double height)
    : pieces_(std::make_unique<Pieces>()) {
  pieces_->format = format;
  if (format == CanvasFormat::kPng) {
    pieces_->surface = cairo_image_surface_create(
        CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(kPngPixelsPerPoint * width)),
        static_cast<int>(std::lround(kPngPixelsPerPoint * height)));
    cairo_surface_set_device_scale(pieces_->surface, kPngPixelsPerPoint, kPngPixelsPerPoint);
  } else if (format == CanvasFormat::kSvg) {
    pieces_->surface = cairo_svg_surface_create_for_stream(append, &pieces_->bytes, width, height);
  } else {
    pieces_->surface = cairo_pdf_surface_create_for_stream(append, &pieces_->bytes, width, height);
    cairo_pdf_surface_set_metadata(pieces_->surface, CAIRO_PDF_METADATA_TITLE,
                                   validUtf8(title).c_str());
    cairo_pdf_surface_set_metadata(pieces_->surface, CAIRO_PDF_METADATA_CREATOR, "Boresight");
  }
  pieces_->cairo = cairo_create(pieces_->surface);
  if (format == CanvasFormat::kPng)  // also the pixels that the page ends in
    fill({0.0, 0.0, width + 1.0, height + 1.0}, {1.0, 1.0, 1.0});
}

PdfCanvas::~PdfCanvas() {
  if (pieces_->cairo != nullptr) cairo_destroy(pieces_->cairo);
  if (pieces_->surface != nullptr) cairo_surface_destroy(pieces_->surface);
}

void PdfCanvas::nextPage() {
  cairo_show_page(pieces_->cairo);
  ++page_;
}

double PdfCanvas::text(double x, double y, double width, const std::string& text,
                       const PdfTextStyle& style) {
  const Layout layout = makeLayout(pieces_->cairo, width, text, style);
  pieces_->color(style.color);
  cairo_move_to(pieces_->cairo, x, y);
  pango_cairo_show_layout(pieces_->cairo, layout.get());
  return heightOf(layout.get());
}

void PdfCanvas::line(double x0, double y0, double x1, double y1, const PdfColor& color,
                     double width) {
  polyline({{x0, y0}, {x1, y1}}, color, width);
}

void PdfCanvas::polyline(const std::vector<std::array<double, 2>>& points, const PdfColor& color,
                         double width, const std::vector<double>& dashes) {
  if (points.size() < 2) return;
  pieces_->color(color);
  cairo_set_dash(pieces_->cairo, dashes.data(), static_cast<int>(dashes.size()), 0.0);
  cairo_set_line_width(pieces_->cairo, width);
  cairo_move_to(pieces_->cairo, points[0][0], points[0][1]);
  for (const auto& point : points) cairo_line_to(pieces_->cairo, point[0], point[1]);
  cairo_stroke(pieces_->cairo);
  cairo_set_dash(pieces_->cairo, nullptr, 0, 0.0);
}

void PdfCanvas::circle(double x, double y, double radius, const PdfColor& color, bool filled) {
  pieces_->color(color);
  cairo_set_line_width(pieces_->cairo, 0.6);
  cairo_new_sub_path(pieces_->cairo);
  cairo_arc(pieces_->cairo, x, y, radius, 0.0, 2.0 * std::numbers::pi);
  filled ? cairo_fill(pieces_->cairo) : cairo_stroke(pieces_->cairo);
}

void PdfCanvas::cross(double x, double y, double radius, const PdfColor& color) {
  line(x - radius, y - radius, x + radius, y + radius, color);
  line(x - radius, y + radius, x + radius, y - radius, color);
}

void PdfCanvas::fill(const PdfBox& box, const PdfColor& color) {
  pieces_->color(color);
  cairo_rectangle(pieces_->cairo, box.x, box.y, box.width, box.height);
  cairo_fill(pieces_->cairo);
}

void PdfCanvas::frame(const PdfBox& box, const PdfColor& color, double width) {
  pieces_->color(color);
  cairo_set_line_width(pieces_->cairo, width);
  cairo_rectangle(pieces_->cairo, box.x, box.y, box.width, box.height);
  cairo_stroke(pieces_->cairo);
}

PdfBox PdfCanvas::picture(const PdfBox& box, const ColorImage& image) {
  if (image.width <= 0 || image.height <= 0) return {box.x, box.y, 0.0, 0.0};
  const cv::Mat small = scaledDown(image);
  const double scale = std::min(box.width / small.cols, box.height / small.rows);
  cairo_surface_t* surface = makeSurface(small);
  cairo_save(pieces_->cairo);
  cairo_translate(pieces_->cairo, box.x, box.y);
  cairo_scale(pieces_->cairo, scale, scale);
  cairo_set_source_surface(pieces_->cairo, surface, 0.0, 0.0);
  cairo_paint(pieces_->cairo);
  cairo_restore(pieces_->cairo);
  cairo_surface_destroy(surface);
  return {box.x, box.y, scale * small.cols, scale * small.rows};
}

void PdfCanvas::clip(const PdfBox& box) {
  cairo_save(pieces_->cairo);
  cairo_rectangle(pieces_->cairo, box.x, box.y, box.width, box.height);
  cairo_clip(pieces_->cairo);
}

void PdfCanvas::unclip() { cairo_restore(pieces_->cairo); }

std::vector<std::uint8_t> PdfCanvas::finish() {
  cairo_show_page(pieces_->cairo);
  cairo_status_t drawn = cairo_status(pieces_->cairo);
  cairo_destroy(pieces_->cairo);
  pieces_->cairo = nullptr;
  if (pieces_->format == CanvasFormat::kPng && drawn == CAIRO_STATUS_SUCCESS)
    drawn = cairo_surface_write_to_png_stream(pieces_->surface, append, &pieces_->bytes);
  cairo_surface_finish(pieces_->surface);
  const cairo_status_t written = cairo_surface_status(pieces_->surface);
  cairo_surface_destroy(pieces_->surface);
  pieces_->surface = nullptr;
  for (const cairo_status_t status : {drawn, written}) {
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(std::string("drawing a page: ") + cairo_status_to_string(status));
  }
  return std::move(pieces_->bytes);
}

}  // namespace boresight::sessions
