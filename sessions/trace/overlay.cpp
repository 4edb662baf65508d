// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/overlay.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "sessions/io/images/image_file.h"
#include "sessions/trace/scene_render.h"

namespace boresight::sessions {
namespace {

cv::Mat grayAsColor(const ImageView& image) {
  const cv::Mat gray(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                     static_cast<std::size_t>(image.stride));
  cv::Mat color;
  cv::cvtColor(gray, color, cv::COLOR_GRAY2BGR);
  return color;
}

cv::Scalar scalarOf(const ColorBgr& color) { return cv::Scalar(color[0], color[1], color[2]); }

/// Squares of half-side `radius_px` on the edge pixels.
void drawEdges(const RenderTrace& render, const ColorBgr& color, int radius_px, cv::Mat& canvas) {
  const cv::Rect whole(0, 0, canvas.cols, canvas.rows);
  const int side_px = 2 * radius_px + 1;
  for (const EdgePixel& pixel : render.pixels) {
    const cv::Rect square(pixel.x - radius_px, pixel.y - radius_px, side_px, side_px);
    canvas(square & whole).setTo(scalarOf(color));
  }
}

/// A sample of the colour and the name for each layer on a dark plate.
void drawLegend(std::span<const OverlayLayer> layers, std::span<const std::string> labels,
                cv::Mat& canvas) {
  const double scale = std::max(canvas.cols, canvas.rows) / 1600.0;
  const double font_scale = std::max(0.35, 0.8 * scale);
  const int thickness = std::max(1, static_cast<int>(2.0 * scale));
  const int line_px = std::max(14, static_cast<int>(34.0 * scale));
  int text_px = 0;
  for (const std::string& label : labels) {
    int baseline = 0;
    text_px = std::max(
        text_px,
        cv::getTextSize(label, cv::FONT_HERSHEY_SIMPLEX, font_scale, thickness, &baseline).width);
  }
  const int sample_px = 2 * line_px;
  const int lines = static_cast<int>(layers.size());
  const cv::Rect plate = cv::Rect(line_px / 2, line_px / 2, sample_px + text_px + line_px,
                                  lines * line_px + line_px / 2) &
                         cv::Rect(0, 0, canvas.cols, canvas.rows);
  cv::Mat under = canvas(plate);
  under *= 0.25;
  for (int i = 0; i < lines; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const int y = plate.y + line_px * i + 3 * line_px / 4;
    const int x = plate.x + line_px / 2;
    cv::line(canvas, {x, y}, {x + sample_px - line_px / 2, y}, scalarOf(layers[index].color),
             std::max(2, line_px / 6));
    cv::putText(canvas, labels[index], {x + sample_px, y + line_px / 4}, cv::FONT_HERSHEY_SIMPLEX,
                font_scale, cv::Scalar::all(255), thickness, cv::LINE_AA);
  }
}

}  // namespace

ColorImage drawOverlay(const ImageView& image, const Camera& camera, const MeshView& mesh,
                       std::span<const OverlayLayer> layers) {
  cv::Mat canvas = grayAsColor(image);
  const int radius_px = std::max(1, std::max(image.width, image.height) / 2048);
  std::vector<std::string> labels;
  for (const OverlayLayer& layer : layers) {
    RenderTrace render;
    const Status status = renderScene(camera, mesh, layer.camera_from_station, render);
    const bool visible = status == Status::kOk && !render.pixels.empty();
    if (visible) drawEdges(render, layer.color, layer.thin ? radius_px - 1 : radius_px, canvas);
    labels.push_back(layer.label + (visible ? "" : " (no edges in view)"));
  }
  const auto named = [](const OverlayLayer& layer) { return !layer.label.empty(); };
  if (std::ranges::any_of(layers, named)) drawLegend(layers, labels, canvas);
  return {canvas.cols, canvas.rows, {canvas.datastart, canvas.dataend}};
}

void writeColorPng(const std::filesystem::path& file, const ColorImage& image) {
  writePng(file, image.bgr, image.width, image.height, 3);
}

}  // namespace boresight::sessions
