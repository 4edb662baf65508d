// SPDX-License-Identifier: Apache-2.0
#include "tests/ui/pictures/stage_pictures.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <QPainter>

#include "core/localizer/localizer_options.h"
#include "sessions/run/edge_detection.h"
#include "sessions/run/overlay.h"
#include "sessions/run/scene_render.h"

namespace boresight::ui {
namespace {

constexpr int kTile_px = 420;
constexpr int kGap_px = 8;

void require(Status status) {
  if (status != Status::kOk) throw std::runtime_error("a stage cannot be drawn");
}

/// Tiles in a row, each with its name in its corner.
QImage row(const std::vector<std::pair<QString, QImage>>& tiles) {
  const int count = static_cast<int>(tiles.size());
  QImage picture(count * kTile_px + (count - 1) * kGap_px, kTile_px, QImage::Format_RGB32);
  picture.fill(Qt::white);
  QPainter painter(&picture);
  QFont font = painter.font();
  font.setPixelSize(15);
  font.setBold(true);
  painter.setFont(font);
  for (int i = 0; i < count; ++i) {
    const auto& [name, tile] = tiles[static_cast<std::size_t>(i)];
    const int x = i * (kTile_px + kGap_px);
    painter.drawImage(
        x, 0, tile.scaled(kTile_px, kTile_px, Qt::IgnoreAspectRatio, Qt::SmoothTransformation));
    const QRect plate(x, kTile_px - 26, painter.fontMetrics().horizontalAdvance(name) + 16, 26);
    painter.fillRect(plate, QColor(20, 20, 20));
    painter.setPen(Qt::white);
    painter.drawText(plate, Qt::AlignCenter, name);
  }
  return picture;
}

/// The middle of the image, where the station is.
QRect middleOf(const Camera& camera) {
  const int side = std::min(camera.width, camera.height) * 3 / 4;
  return {(camera.width - side) / 2, (camera.height - side) / 2, side, side};
}

QImage depthImage(const std::vector<float>& depth_m, int width, int height) {
  float nearest = 1e9F;
  float farthest = 0.0F;
  for (const float depth : depth_m) {
    if (depth <= 0.0F) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  QImage image(width, height, QImage::Format_RGB32);
  for (int i = 0; i < width * height; ++i) {
    const float depth = depth_m[static_cast<std::size_t>(i)];
    const float share = (depth - nearest) / std::max(1e-6F, farthest - nearest);
    const int gray = depth <= 0.0F ? 0 : static_cast<int>(255.0F - 200.0F * share);
    image.setPixel(i % width, i / width, qRgb(gray, gray, gray));
  }
  return image;
}

QImage normalImage(const std::vector<Eigen::Vector3f>& normal, int width, int height) {
  QImage image(width, height, QImage::Format_RGB32);
  for (int i = 0; i < width * height; ++i) {
    const Eigen::Vector3f& n = normal[static_cast<std::size_t>(i)];
    const auto part = [](float value) { return static_cast<int>(127.5F + 127.5F * value); };
    image.setPixel(i % width, i / width,
                   n.isZero() ? qRgb(0, 0, 0) : qRgb(part(n.x()), part(-n.y()), part(-n.z())));
  }
  return image;
}

QImage bitsImage(const sessions::BitMap& bits) {
  QImage image(bits.width, bits.height, QImage::Format_RGB32);
  image.fill(Qt::black);
  QPainter painter(&image);
  const BitImage view = bits.view();
  for (int y = 0; y < bits.height; ++y)
    for (int x = 0; x < bits.width; ++x)
      if (view.get(x, y)) painter.fillRect(x - 1, y - 1, 2, 2, Qt::white);
  return image;
}

QImage grayImage(const ImageView& image) {
  return QImage(image.data, image.width, image.height, static_cast<int>(image.stride),
                QImage::Format_Grayscale8)
      .convertToFormat(QImage::Format_RGB32);
}

QImage overlay(const LocalizationProblem& problem, const Pose& pose,
               const sessions::ColorBgr& color) {
  const std::array<sessions::OverlayLayer, 1> layers = {{{"", pose, color}}};
  const sessions::ColorImage drawn =
      sessions::drawOverlay(problem.image, problem.camera, problem.mesh, layers);
  return QImage(drawn.bgr.data(), drawn.width, drawn.height, 3 * drawn.width, QImage::Format_RGB888)
      .rgbSwapped();
}

}  // namespace

QImage renderPicture(const sessions::LoadedCase& one) {
  const LocalizationProblem problem = one.problem();
  const int width = problem.camera.width;
  const int height = problem.camera.height;
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<float> depth_m(size);
  std::vector<Eigen::Vector3f> normal(size, Eigen::Vector3f::Zero());
  SurfaceRender surfaces;
  surfaces.depth_m = depth_m;
  surfaces.normal_in_camera = normal;
  sessions::RenderTrace render;
  require(sessions::renderScene(problem.camera, problem.mesh, problem.camera_from_station_seed,
                                render, surfaces));
  const QRect middle = middleOf(problem.camera);
  return row({{QStringLiteral("depth"), depthImage(depth_m, width, height).copy(middle)},
              {QStringLiteral("normals"), normalImage(normal, width, height).copy(middle)},
              {QStringLiteral("salient edges"), bitsImage(render.edges).copy(middle)}});
}

QImage edgePicture(const sessions::LoadedCase& one) {
  const LocalizationProblem problem = one.problem();
  sessions::EdgeMapTrace edges;
  require(sessions::detectEdges(problem.image, nullptr, defaultProfile().edges, edges));
  const QRect middle = middleOf(problem.camera);
  return row({{QStringLiteral("image"), grayImage(problem.image).copy(middle)},
              {QStringLiteral("Canny's edges"), bitsImage(edges.level[0]).copy(middle)}});
}

QImage beforeAndAfter(const sessions::LoadedCase& one, const Pose& camera_from_station) {
  const LocalizationProblem problem = one.problem();
  const QRect middle = middleOf(problem.camera);
  return row(
      {{QStringLiteral("seed"),
        overlay(problem, problem.camera_from_station_seed, sessions::kSeedColor).copy(middle)},
       {QStringLiteral("result"),
        overlay(problem, camera_from_station, sessions::kResultColor).copy(middle)}});
}

}  // namespace boresight::ui
