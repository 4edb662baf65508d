// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_overlay.h"

#include <QtWidgets>
#include <algorithm>

#include "ui/annotation/annotation_aim.h"
#include "ui/plots/plot_colors.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

constexpr int kLegendOfCameras_px = 480;

QString overlayText(const char* source) {
  return QCoreApplication::translate("SceneOverlay", source);
}

/// Readable on any background of the scene.
bool isDark(const QColor& color) { return color.lightnessF() < 0.5; }

/// One line of the legend: a sign and what it means.
struct Entry {
  enum Sign { kLine, kInlier, kOutlier, kUnmatched, kMatched, kOccluding } sign = kLine;
  const PoseRoleStyle* style = nullptr;  ///< of a line
  QString meaning;
};

std::vector<Entry> entries(const SceneContent& content, const SceneLook& look, bool with_cameras) {
  std::vector<Entry> result;
  if (look.shown.frusta && with_cameras)
    for (const Frustum& frustum : content.frusta)
      result.push_back(
          {Entry::kLine, &poseRoleStyle(frustum.role, frustum.rejected), frustum.label});
  const auto& parts = content.mesh().parts;
  if (look.shown.mesh && std::ranges::find(parts, false, &ScenePart::match) != parts.end()) {
    result.push_back({Entry::kMatched, nullptr, overlayText("matched part")});
    result.push_back({Entry::kOccluding, nullptr, overlayText("occluding part")});
  }
  if (!look.shown.points) return result;
  const auto add = [&](ScenePointKind kind, Entry::Sign sign, const char* meaning) {
    if (std::ranges::find(content.points, kind, &ScenePoint::kind) != content.points.end())
      result.push_back({sign, nullptr, overlayText(meaning)});
  };
  add(ScenePointKind::kInlier, Entry::kInlier, "inlier");
  add(ScenePointKind::kOutlier, Entry::kOutlier, "outlier");
  add(ScenePointKind::kUnmatched, Entry::kUnmatched, "not used");
  return result;
}

void paintSign(QPainter& painter, const Entry& entry, const QRectF& box) {
  const QPointF centre = box.center();
  painter.setBrush(Qt::NoBrush);
  switch (entry.sign) {
    case Entry::kLine: {
      const PoseRoleStyle& style = *entry.style;
      painter.setPen(QPen(style.color, 2.0));
      // The same dashes as in the scene, three times along the sign.
      const SceneLine whole = {{box.left(), centre.y(), 0.0}, {box.right(), centre.y(), 0.0}};
      for (const auto& [from, to] : dashed(whole, style.dashes, 3.0))
        painter.drawLine(QPointF(from.x(), from.y()), QPointF(to.x(), to.y()));
      return;
    }
    case Entry::kInlier:
      painter.setPen(QPen(Qt::black, 0.8));
      painter.setBrush(heatColor(0.6));
      painter.drawEllipse(centre, 4.5, 4.5);
      return;
    case Entry::kOutlier:
      painter.setPen(QPen(heatColor(1.0), 2.2));
      painter.drawLine(centre - QPointF(5, 5), centre + QPointF(5, 5));
      painter.drawLine(centre - QPointF(5, -5), centre + QPointF(5, -5));
      return;
    case Entry::kUnmatched:
      painter.setPen(Qt::NoPen);
      painter.setBrush(QColor(150, 150, 150));
      painter.drawEllipse(centre, 2.5, 2.5);
      return;
    case Entry::kMatched:
    case Entry::kOccluding:
      painter.setPen(QPen(Qt::black, 0.8));
      painter.setBrush(entry.sign == Entry::kMatched ? kMatchedColor : kOccludingColor);
      painter.drawRect(QRectF(centre - QPointF(8, 5), centre + QPointF(8, 5)));
      return;
  }
}

/// The bar of residuals, with its ends and its middle in px.
void paintBar(QPainter& painter, const QRectF& area, double limit_px, const QColor& ink) {
  const QFontMetricsF metrics(painter.font());
  const double line = metrics.height();
  const QRectF bar(area.left(), area.top() + line + 2.0, area.width(), 10.0);
  painter.setPen(ink);
  painter.drawText(QRectF(area.left(), area.top(), area.width(), line), Qt::AlignCenter,
                   overlayText("residual, px"));
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (int i = 0; i <= 10; ++i) gradient.setColorAt(0.1 * i, heatColor(0.1 * i));
  painter.setBrush(gradient);
  painter.drawRect(bar);
  painter.setBrush(Qt::NoBrush);
  const QRectF numbers(area.left(), bar.bottom() + 1.0, area.width(), line);
  painter.drawText(numbers, Qt::AlignLeft, QStringLiteral("0"));
  painter.drawText(numbers, Qt::AlignHCenter, QString::number(0.5 * limit_px, 'g', 3));
  painter.drawText(numbers, Qt::AlignRight,
                   QString(QChar(0x2265)) + QString::number(limit_px, 'g', 3));
}

}  // namespace

SceneOverlay::SceneOverlay(QWidget* canvas) : QWidget(canvas) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setAttribute(Qt::WA_NoSystemBackground);
  setFocusPolicy(Qt::NoFocus);
}

void SceneOverlay::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor ink = isDark(look.background) ? QColor(230, 230, 230) : QColor(30, 30, 30);
  if (!content || content->empty()) {
    painter.setPen(ink);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     overlayText("Open a case to see its station and cameras here."));
    return;
  }
  paintNames(painter);
  paintMarks(painter);
  paintLegend(painter);
  if (paint_over) paint_over(painter);
  if (!note.isEmpty()) {
    const QFontMetricsF metrics(font());
    paintText(painter, {8.0, 6.0 + metrics.ascent()}, note, ink);
  }
}

void SceneOverlay::paintText(QPainter& painter, const QPointF& at, const QString& written,
                             const QColor& color) const {
  paintOutlined(painter, at, painter.font(), written, color,
                isDark(look.background) ? QColor(0, 0, 0, 200) : QColor(255, 255, 255, 220));
}

void SceneOverlay::paintNames(QPainter& painter) const {
  const bool dark = isDark(look.background);
  const auto legible = [dark](const QColor& color) {
    return dark ? color.lighter(115) : color.darker(170);
  };
  if (look.shown.axes)
    for (int axis = 0; axis < 3; ++axis)
      if (const auto at =
              view.toCanvas(1.08 * content->axis_length_m * Eigen::Vector3d::Unit(axis)))
        paintText(painter, *at + QPointF(-4.0, 5.0), QStringLiteral("xyz").mid(axis, 1),
                  legible(axisColor(axis)));
  if (look.shown.frusta)
    for (const Frustum& frustum : content->frusta)
      if (const auto at = view.toCanvas(frustum.label_at_m))
        paintText(painter, *at + QPointF(6.0, -5.0), frustum.label, legible(frustum.color));
}

void SceneOverlay::paintMarks(QPainter& painter) const {
  if (const auto pixel = hovered ? view.toCanvas(*hovered) : std::nullopt)
    for (const QPen& pen : {QPen(QColor(0, 0, 0, 160), 3.5), QPen(QColor(255, 255, 255), 1.5)}) {
      painter.setPen(pen);
      paintTicks(painter, *pixel + QPointF(0.5, 0.5), 4.0, 12.0);
    }
  const auto pixel = clicked ? view.toCanvas(*clicked) : std::nullopt;
  if (!pixel) return;
  const QPointF at = *pixel + QPointF(0.5, 0.5);
  for (const QPen& pen : {QPen(QColor(0, 0, 0), 3.5), QPen(QColor(255, 210, 0), 1.5)}) {
    painter.setPen(pen);
    painter.drawEllipse(at, 6.0, 6.0);
    paintTicks(painter, at, 3.0, 10.0);
  }
}

void SceneOverlay::paintLegend(QPainter& painter) const {
  // Cameras have their names next to them in the scene, too.
  const std::vector<Entry> lines = entries(*content, look, width() >= kLegendOfCameras_px);
  const bool bar = look.shown.points && !content->points.empty();
  if (lines.empty() && !bar) return;
  const QFontMetricsF metrics(painter.font());
  const double line = metrics.height() + 2.0;
  double wide = bar ? metrics.horizontalAdvance(overlayText("residual, px")) + 20.0 : 60.0;
  for (const Entry& entry : lines)
    wide = std::max(wide, 42.0 + metrics.horizontalAdvance(entry.meaning));
  const double bar_height = bar ? 2.0 * metrics.height() + 20.0 : 0.0;
  const double high = line * static_cast<double>(lines.size()) + bar_height + 12.0;
  const QRectF box(width() - wide - 24.0, height() - high - 8.0, wide + 16.0, high);
  if (box.left() < 0.4 * width() || box.top() < 0.0) return;  // a small scene is not covered up
  const bool dark = isDark(look.background);
  const QColor ink = dark ? QColor(230, 230, 230) : QColor(30, 30, 30);
  painter.setPen(Qt::NoPen);
  painter.setBrush(dark ? QColor(20, 22, 26, 200) : QColor(250, 250, 250, 215));
  painter.drawRoundedRect(box, 4.0, 4.0);
  double y = box.top() + 6.0;
  for (const Entry& entry : lines) {
    paintSign(painter, entry, {box.left() + 8.0, y, 30.0, line});
    painter.setPen(ink);
    painter.drawText(QRectF(box.left() + 46.0, y, wide, line), Qt::AlignVCenter | Qt::AlignLeft,
                     entry.meaning);
    y += line;
  }
  if (bar)
    paintBar(painter, {box.left() + 8.0, y + 2.0, wide, bar_height}, content->residual_limit_px,
             ink);
}

}  // namespace boresight::ui
