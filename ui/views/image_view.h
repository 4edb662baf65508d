// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <QPointF>
#include <QPointer>
#include <QWidget>

#include "ui/views/canvas_tool.h"
#include "ui/views/display_image.h"
#include "ui/views/layer.h"
#include "ui/views/overlay_painters.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// The image with layers over it, in plain Qt: exact, and the same on every platform. The wheel
/// zooms at the cursor, dragging pans, a double click fits, H held hides the layers; from 8x the
/// pixel grid and the gray values show. It is independent of runs; its owner sets pictures, lines
/// and marks.
class ImageView : public QWidget {
  Q_OBJECT

 public:
  static constexpr double kGridScale = 8.0;
  static constexpr double kValueScale = 28.0;  ///< a pixel must hold three digits

  explicit ImageView(QWidget* parent = nullptr);

  /// 8-bit gray; a null image shows only a hint. Keeps the zoom when the size stays.
  void setImage(const QImage& gray);
  /// Sets the gray levels for the values of the grid, when the picture is stretched.
  void setValues(const QImage& gray) { values_ = gray; }
  /// Replaces one layer; the others keep their pixmaps.
  void setLayer(Layer layer);
  const Layer& layer(LayerId id) const { return layers_[static_cast<std::size_t>(id)]; }
  /// Replaces one part of a layer, such as its marks.
  template <class Part>
  void setPart(LayerId id, Part Layer::*part, std::type_identity_t<Part> value) {
    layers_[static_cast<std::size_t>(id)].*part = std::move(value);
    layerChanged(id);
  }
  void setStyle(LayerId id, const LayerStyle& style);

  QSize imageSize() const { return image_.size(); }
  const ViewTransform& transform() const { return transform_; }
  void setTransform(const ViewTransform& transform);
  void fit();
  /// Whether the whole image is shown at any size of the widget, until the operator zooms.
  bool isFitted() const { return fitted_; }
  void showOneToOne();  ///< one image pixel on one device pixel
  void centreOn(const QPointF& pixel, double least_scale);

  /// Layers are drawn only left of this share of the width; none: everywhere.
  void setSwipe(std::optional<double> share);
  const std::optional<double>& swipe() const { return swipe_; }
  /// Sets the position of another view's pointer, drawn as a cross. Empty: none.
  void setLinkedCursor(const std::optional<QPointF>& pixel);
  const std::optional<QPointF>& linkedCursor() const { return linked_cursor_; }
  /// Whether the screen shows the current image and layers. Slow drawing is split among several
  /// events; meanwhile the former picture is shown at its new position.
  bool isDrawn() const { return !outdated_ || !isVisible(); }
  /// Hides all layers temporarily (blinking).
  void setLayersHidden(bool hidden);
  bool layersHidden() const { return layers_hidden_; }

  /// The mark under a place of the widget that belongs to an item of a visible layer, the nearest
  /// one within 8 px; {layer, item}.
  struct Pick {
    LayerId layer = LayerId::kTemplates;
    int item = -1;
  };
  std::optional<Pick> pickAt(const QPointF& widget) const;

  /// The text shown when there is no image.
  const QString& hint() const { return hint_; }
  void setHint(const QString& hint);

  QSize sizeHint() const override { return {640, 640}; }

 Q_SIGNALS:
  void cursorMoved(const QPointF& pixel);
  void cursorLeft();
  void clicked(const QPointF& pixel, Qt::MouseButton button, Qt::KeyboardModifiers modifiers);
  void itemClicked(boresight::ui::LayerId layer, int item);
  void transformChanged();
  void layersChanged();  ///< contents or styles
  void contextMenuRequested(const QPointF& pixel, const QPoint& global);
  /// While a tool is set, the left button is the tool's (the middle one pans); a double click is
  /// two presses.
  void toolPressed(const QPointF& pixel);
  void toolMoved(const QPointF& pixel);
  void toolReleased(const QPointF& pixel);

 public:
  /// A tool takes the left button; its radius (image px) is shown round the cursor when positive.
  void setToolActive(bool active, double radius_px = 0.0);
  bool toolActive() const { return tool_active_; }
  /// Ends the tool before, and gives the keyboard focus to this one; nullptr: none is active.
  void setTool(CanvasTool* tool);
  /// nullptr while no tool is active.
  CanvasTool* tool() const { return tool_; }
  /// Drops the gesture of the active tool, if any, and a drag of the view.
  void cancelGesture();
  void setToolPreviews(std::vector<ToolPreview> previews);
  /// Adds painting over everything else, in the widget's coordinates, as long as its owner lives.
  void addOverlay(QObject* owner, std::function<void(QPainter&)> overlay) {
    overlays_.emplace_back(owner, std::move(overlay));
  }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  /// Image and layers as drawn with a transform.
  struct Ground {
    QPixmap picture;
    ViewTransform transform;
    QRgb canvas = 0;
  };
  /// A ground that is being drawn from top to bottom.
  struct Drawing {
    Ground ground;
    int bands = 1;
    int next = 0;
    bool superseded = false;  ///< another is to be drawn after it
  };

  /// Transform of the ground that is being drawn.
  const ViewTransform& drawn() const { return drawing_->ground.transform; }
  QRgb canvasColor() const;
  QSize deviceSize() const;
  void updateGround();
  void beginDrawing();
  void draw();
  bool prepareBits();
  void drawBand(const QRectF& band);
  void paintGround(QPainter& painter) const;
  double workToDraw() const;
  double bitsPerPixel(int level) const;
  void redraw();
  /// Draws a layer anew and reports the change.
  void layerChanged(LayerId id);
  void paintImage(QPainter& painter) const;
  void paintLayer(QPainter& painter, std::size_t index);
  void paintGrid(QPainter& painter, const QRectF& band) const;
  void paintValues(QPainter& painter, const QRectF& band) const;
  void paintTool(QPainter& painter) const;
  void paintSwipe(QPainter& painter) const;
  void paintLinkedCursor(QPainter& painter) const;
  LineToken lineOf(const Layer& layer) const;
  bool isOnSwipe(const QPointF& place) const;
  void paintBits(QPainter& painter, std::size_t index);
  QRect visiblePixels(const QRectF& area) const;
  void changed();
  QPointF middle() const { return {0.5 * width(), 0.5 * height()}; }
  void zoomTo(const QPointF& widget, double scale);
  void panBy(const QPointF& delta);

  GrayPyramid image_;
  QImage values_;
  std::vector<Layer> layers_;
  std::vector<std::vector<BitPixmaps>> pixmaps_;  ///< by layer, one per LayerBits, made when drawn
  ViewTransform transform_;
  bool fitted_ = true;  ///< follows the widget's size
  std::optional<double> swipe_;
  bool layers_hidden_ = false;
  QString hint_;
  QPointF press_;
  QPointF last_;
  bool dragging_ = false;
  QPointer<CanvasTool> tool_;
  bool tool_active_ = false;
  bool tool_pressed_ = false;
  double tool_radius_px_ = 0.0;
  std::vector<ToolPreview> tool_previews_;
  std::vector<std::pair<QPointer<QObject>, std::function<void(QPainter&)>>> overlays_;
  std::optional<QPointF> linked_cursor_;
  Ground ground_;                   ///< as drawn last
  std::optional<Drawing> drawing_;  ///< in place of `ground_`
  bool outdated_ = true;            ///< `ground_` is of another image, transform or layers
  bool swiping_ = false;
};

}  // namespace boresight::ui
