// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_canvas.h"

#include <QPainter>
#include <QWidget>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <new>
#include <optional>
#include <vector>

#include "sessions/trace/scene_render.h"
#include "ui/plots/plot_colors.h"

namespace boresight::ui {
namespace {

/// The core's render of the surfaces, by device pixels.
struct Surfaces {
  Camera camera;
  std::vector<float> depth_m;
  std::vector<std::int32_t> face;
  std::vector<std::uint8_t> intensity;
  sessions::RenderTrace render;
  bool drawn = false;

  Surfaces(const SceneContent& content, const Viewpoint& view, double ratio) {
    camera = view.camera;
    camera.width = std::max(1, static_cast<int>(std::lround(view.camera.width * ratio)));
    camera.height = std::max(1, static_cast<int>(std::lround(view.camera.height * ratio)));
    camera.fx *= ratio;
    camera.fy *= ratio;
    camera.cx = (view.camera.cx + 0.5) * ratio - 0.5;
    camera.cy = (view.camera.cy + 0.5) * ratio - 0.5;
    const auto pixels =
        static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    depth_m.assign(pixels, 0.0F);
    face.assign(pixels, -1);
    intensity.assign(pixels, 0);
    if (content.empty() || prepareCamera(camera) != Status::kOk) return;
    SurfaceRender wanted;
    wanted.depth_m = depth_m;
    wanted.face = face;
    wanted.intensity = intensity;
    drawn = sessions::renderScene(camera, content.mesh(), view.view_from_station, render, wanted) ==
            Status::kOk;
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
           static_cast<std::size_t>(x);
  }
};

/// Dots ready to be copied: of edge places there are ten thousand, and an ellipse takes Qt as long
/// as a hundred copies.
class DotStamps {
 public:
  DotStamps(double radius_px, double ratio) : radius_px_(radius_px), ratio_(ratio) {}

  /// Drawn to whole device pixels; `at` is in device pixels, 0 the left edge.
  void draw(QPainter& painter, const QPointF& at, bool inlier, double share) {
    const int shade =
        inlier ? static_cast<int>(std::lround(kShades * std::clamp(share, 0.0, 1.0))) : kShades + 1;
    QImage& stamp = stamps_[static_cast<std::size_t>(shade)];
    if (stamp.isNull()) stamp = make(inlier, static_cast<double>(shade) / kShades);
    const int half = stamp.width() / 2;
    painter.drawImage(QPoint(static_cast<int>(std::floor(at.x())) - half,
                             static_cast<int>(std::floor(at.y())) - half),
                      stamp);
  }

 private:
  static constexpr int kShades = 32;

  QImage make(bool inlier, double share) const {
    const double radius = (inlier ? radius_px_ : 0.5 * radius_px_) * ratio_;
    const int side = 2 * static_cast<int>(std::ceil(radius + ratio_)) + 1;
    QImage stamp(side, side, QImage::Format_ARGB32_Premultiplied);
    stamp.fill(Qt::transparent);
    QPainter painter(&stamp);
    painter.setRenderHint(QPainter::Antialiasing);
    // Around dots this small a rim would be most of what is seen.
    painter.setPen(radius < 2.5 * ratio_ ? QPen(Qt::NoPen) : QPen(Qt::black, 0.8 * ratio_));
    painter.setBrush(inlier ? heatColor(share) : QColor(150, 150, 150));
    painter.drawEllipse(QPointF(0.5 * side, 0.5 * side), radius, radius);
    return stamp;
  }

  double radius_px_;
  double ratio_;
  std::array<QImage, kShades + 2> stamps_;
};

/// Painting in the view's pixels (0, 0 the centre of the top-left one) with the surfaces' depth.
struct Brush {
  QPainter& painter;
  const SceneContent& content;
  const Viewpoint& view;
  const Surfaces& surfaces;
  DotStamps& dots;
  bool occludes = true;

  double ratio() const { return static_cast<double>(surfaces.camera.width) / view.camera.width; }

  bool hidden(const QPointF& pixel, double depth_m) const {
    if (!occludes || !surfaces.drawn) return false;
    const int x = static_cast<int>(std::floor((pixel.x() + 0.5) * ratio()));
    const int y = static_cast<int>(std::floor((pixel.y() + 0.5) * ratio()));
    if (x < 0 || y < 0 || x >= surfaces.camera.width || y >= surfaces.camera.height) return false;
    const auto surface_m = static_cast<double>(surfaces.depth_m[surfaces.index(x, y)]);
    return surface_m > 0.0 && surface_m < depth_m - 2e-3 * content.bounds.diagonal();
  }

  /// Its pixel, where nothing hides it.
  std::optional<QPointF> visible(const Eigen::Vector3d& at_m) const {
    const auto pixel = view.toCanvas(at_m);
    const bool shown = pixel && !hidden(*pixel, (view.view_from_station * at_m).z());
    return shown ? pixel : std::nullopt;
  }

  /// In short pieces, those that nothing hides.
  void line(const SceneLine& line, const QPen& pen) const {
    constexpr int kPieces = 24;
    painter.setPen(pen);
    for (int i = 0; i < kPieces; ++i) {
      const auto at = [&](double share) -> Eigen::Vector3d {
        return line.first + share * (line.second - line.first);
      };
      const auto from = view.toCanvas(at(static_cast<double>(i) / kPieces));
      const auto to = view.toCanvas(at((i + 1.0) / kPieces));
      if (from && to && visible(at((i + 0.5) / kPieces))) painter.drawLine(*from, *to);
    }
  }

  void point(const ScenePoint& point) const {
    const auto place = visible(point.at_m);
    if (!place) return;
    const QPointF& at = *place;
    const double radius_px = content.point_radius_px;
    const double share = point.residual_px / content.residual_limit_px;
    if (point.kind == ScenePointKind::kOutlier) {
      const QColor color = heatColor(share);
      const double r = 1.2 * radius_px;
      for (const auto& [pen_color, width] : {std::pair(QColor(Qt::black), 4.0), {color, 2.2}}) {
        painter.setPen(QPen(pen_color, width));
        painter.drawLine(at - QPointF(r, r), at + QPointF(r, r));
        painter.drawLine(at - QPointF(r, -r), at + QPointF(r, -r));
      }
    } else {
      const QTransform scaled = painter.transform();
      painter.resetTransform();
      dots.draw(painter, (at + QPointF(0.5, 0.5)) * ratio(), point.kind == ScenePointKind::kInlier,
                share);
      painter.setTransform(scaled);
    }
    painter.setBrush(Qt::NoBrush);
    if (point.template_index >= 0 && point.template_index == content.selected_template) {
      painter.setPen(QPen(QColor(255, 235, 60), 2.0));
      painter.drawEllipse(at, 2.1 * radius_px, 2.1 * radius_px);
    }
  }
};

QRgb shaded(const QColor& base, int intensity, double opacity) {
  const auto part = [&](int value) { return value * intensity / 255; };
  return qPremultiply(qRgba(part(base.red()), part(base.green()), part(base.blue()),
                            static_cast<int>(255.0 * opacity + 0.5)));
}

/// The mesh alone, transparent elsewhere.
QImage meshPicture(const SceneContent& content, const SceneLook& look, const Surfaces& surfaces) {
  QImage picture(surfaces.camera.width, surfaces.camera.height,
                 QImage::Format_ARGB32_Premultiplied);
  picture.fill(Qt::transparent);
  if (!surfaces.drawn) return picture;
  const MeshView mesh = content.mesh();
  const BitImage edges = surfaces.render.edges.view();
  for (int y = 0; y < picture.height(); ++y) {
    auto* row = reinterpret_cast<QRgb*>(picture.scanLine(y));
    for (int x = 0; x < picture.width(); ++x) {
      const std::size_t i = surfaces.index(x, y);
      const std::int32_t face = surfaces.face[i];
      if (look.shown.mesh && face >= 0) {
        const bool match = mesh.parts[mesh.part_of_face[static_cast<std::size_t>(face)]].match;
        row[x] = shaded(match ? kMatchedColor : kOccludingColor, surfaces.intensity[i],
                        look.mesh_opacity);
      }
      if (look.shown.mesh_edges && edges.get(x, y)) row[x] = look.mesh_lines.rgba();
    }
  }
  return picture;
}

void paintThings(const Brush& brush, const SceneContent& content, const SceneLook& look) {
  if (look.shown.axes)
    for (const auto& [line, color] : axisLines(content)) brush.line(line, QPen(color, 2.0));
  if (look.shown.frusta)
    for (const Frustum& frustum : content.frusta)
      for (const SceneLine& line : frustum.lines)
        brush.line(line, QPen(frustum.color, poseRoleStyle(frustum.role).width_px));
  if (look.shown.trail) {
    for (const auto& [line, color] : trailLines(content)) brush.line(line, QPen(color, 1.5));
    for (std::size_t i = 0; i < content.trail_m.size(); ++i) {
      const auto at = brush.visible(content.trail_m[i]);
      if (!at) continue;
      const double radius = static_cast<int>(i) == content.trail_now ? 4.5 : 2.5;
      brush.painter.setPen(QPen(Qt::black, 0.8));
      brush.painter.setBrush(poseRoleStyle(PoseRole::kEstimate).color);
      brush.painter.drawEllipse(*at, radius, radius);
      brush.painter.setBrush(Qt::NoBrush);
    }
  }
  if (look.shown.points)
    for (const ScenePoint& point : content.points) brush.point(point);
}

QImage drawPicture(const SceneContent& content, const SceneLook& look, const Viewpoint& view,
                   const std::optional<Backdrop>& backdrop, double ratio,
                   const Surfaces& surfaces) {
  QImage picture(surfaces.camera.width, surfaces.camera.height,
                 QImage::Format_ARGB32_Premultiplied);
  picture.fill(look.background);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  if (backdrop) {
    const QRectF& where = backdrop->where;
    painter.drawImage(QRectF(where.topLeft() * ratio, where.size() * ratio), backdrop->gray);
  }
  if (content.empty()) return picture;
  painter.drawImage(0, 0, meshPicture(content, look, surfaces));
  painter.setRenderHint(QPainter::Antialiasing);
  painter.scale(ratio, ratio);
  painter.translate(0.5, 0.5);
  const bool occludes = look.shown.mesh && look.mesh_opacity >= 1.0;
  DotStamps dots(content.point_radius_px, ratio);
  paintThings({painter, content, view, surfaces, dots, occludes}, content, look);
  painter.end();
  picture.setDevicePixelRatio(ratio);
  return picture;
}

class PictureCanvas final : public QWidget, public SceneCanvas {
 public:
  using QWidget::QWidget;

  QWidget* widget() override { return this; }
  void setContent(std::shared_ptr<const SceneContent> content, const SceneLook& look) override {
    if (!content || !content_ || !sameMesh(*content, *content_)) surfaces_.reset();
    content_ = std::move(content);
    look_ = look;
    changed();
  }
  void setView(const Viewpoint& view, const std::optional<Backdrop>& backdrop) override {
    if (view.camera != view_.camera || view.view_from_station != view_.view_from_station)
      surfaces_.reset();
    view_ = view;
    backdrop_ = backdrop;
    changed();
  }

 protected:
  void paintEvent(QPaintEvent*) override {
    QPainter painter(this);
    painter.fillRect(rect(), look_.background);
    if (!content_ || view_.camera.width <= 0) return;
    try {
      if (picture_.isNull()) draw();
      painter.drawImage(0, 0, picture_);
    } catch (const std::bad_alloc&) {
      surfaces_.reset();
      painter.drawText(rect(), Qt::AlignCenter, tr("Not enough memory to draw the scene."));
    }
  }

 private:
  void draw() {
    const double ratio = devicePixelRatioF();
    // Surfaces take longest, and do not change during a run.
    if (!surfaces_ || ratio != ratio_) surfaces_.emplace(*content_, view_, ratio);
    ratio_ = ratio;
    picture_ = drawPicture(*content_, look_, view_, backdrop_, ratio, *surfaces_);
  }
  void changed() {
    picture_ = QImage();
    update();
  }

  std::shared_ptr<const SceneContent> content_;
  SceneLook look_;
  Viewpoint view_;
  std::optional<Backdrop> backdrop_;
  std::optional<Surfaces> surfaces_;  ///< of this content's mesh, view and ratio
  double ratio_ = 0.0;
  QImage picture_;
};

}  // namespace

QImage drawScenePicture(const SceneContent& content, const SceneLook& look, const Viewpoint& view,
                        const std::optional<Backdrop>& backdrop, double ratio) {
  return drawPicture(content, look, view, backdrop, ratio, Surfaces(content, view, ratio));
}

std::unique_ptr<SceneCanvas> makePictureCanvas(QWidget* parent) {
  return std::make_unique<PictureCanvas>(parent);
}

}  // namespace boresight::ui
