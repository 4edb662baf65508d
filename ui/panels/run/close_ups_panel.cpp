// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/close_ups_panel.h"

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/state/view_state.h"
#include "ui/style/theme.h"
#include "ui/views/display_image.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/line_painter.h"

namespace boresight::ui {
namespace {

/// Side of the squares that are searched for corners: about that of a close-up.
constexpr double kSide_px = 32.0;
/// Zoom of the canvas after a click, at least.
constexpr double kCanvasScale = 8.0;
constexpr LayerId kShownLayers[] = {LayerId::kSeedEdges, LayerId::kIterationEdges,
                                    LayerId::kTruthEdges};

}  // namespace

CloseUpView::CloseUpView(ImagePanel& image) : image_(image) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setCursor(Qt::PointingHandCursor);
  connect(&image_.view(), &ImageView::layersChanged, this, QOverload<>::of(&QWidget::update));
  connect(&image_.display(), &DisplayImage::pictureChanged, this,
          QOverload<>::of(&QWidget::update));
}

void CloseUpView::setPlace(const std::optional<sessions::CloseUp>& place, bool rejected) {
  place_ = place;
  rejected_ = rejected;
  setToolTip(!place_ ? QString()
             : rejected
                 ? tr("%1: the image has edges at %2 % of the model's. The pose is rejected. Click "
                      "to show the place on the canvas.")
                       .arg(fromText(place_->name), numberText(100.0 * place_->found_share, 0))
                 : tr("%1: the edges of model and image are %2 px apart (median). Click to show "
                      "the place on the canvas.")
                       .arg(fromText(place_->name), numberText(place_->distance_px, 2)));
  update();
}

QString CloseUpView::figureText() const {
  if (!place_) return {};
  return rejected_ ? tr("%1 % found").arg(numberText(100.0 * place_->found_share, 0))
                   : tr("%1 px").arg(numberText(place_->distance_px, 2));
}

QRectF CloseUpView::pictureArea() const {
  return QRectF(rect()).adjusted(0.0, 0.0, 0.0, -fontMetrics().height() - 2.0);
}

void CloseUpView::paintEvent(QPaintEvent* /*event*/) {
  if (!place_) return;
  QPainter painter(this);
  painter.setPen(QColor(theme().text2));
  const QRectF caption(0.0, pictureArea().bottom() + 2.0, width(), fontMetrics().height());
  painter.drawText(caption, Qt::AlignLeft | Qt::AlignVCenter, fromText(place_->name));
  painter.drawText(caption, Qt::AlignRight | Qt::AlignVCenter, figureText());
  paintPicture(painter);
}

void CloseUpView::paintPicture(QPainter& painter) const {
  const QRectF area = pictureArea();
  painter.setClipRect(area);
  painter.fillRect(area, QColor(theme().canvas));
  ViewTransform transform;
  transform.zoomAt({}, kScale);
  transform.centreOn(pointOf(place_->center_px), area.size());
  const QImage& picture = image_.display().picture();
  painter.drawImage(transform.toWidget(QRectF(-0.5, -0.5, picture.width(), picture.height())),
                    picture);
  painter.setRenderHint(QPainter::Antialiasing);
  for (const LayerId id : kShownLayers) {
    const Layer& layer = image_.view().layer(id);
    if (layer.lines && layer.style.visible)
      paintLines(painter, transform, *layer.lines, layer.shownLine(), area);
  }
}

void CloseUpView::mousePressEvent(QMouseEvent* /*event*/) {
  if (place_) image_.view().centreOn(pointOf(place_->center_px), kCanvasScale);
}

CloseUpsPanel::CloseUpsPanel(ImagePanel& image, ViewState& state) : state_(state) {
  ui_.setupUi(this);
  for (std::size_t i = 0; i < views_.size(); ++i) {
    views_[i] = new CloseUpView(image);
    ui_.grid->addWidget(views_[i], static_cast<int>(i / 2), static_cast<int>(i % 2));
  }
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCursor | ViewChange::kCase, this,
                  &CloseUpsPanel::showIteration);
  showIteration();
}

void CloseUpsPanel::showIteration() {
  const auto iteration = state_.iteration();
  const auto& loaded_case = state_.currentCase();
  std::vector<sessions::CloseUp> close_ups;
  if (iteration && loaded_case)
    close_ups = sessions::closeUps(loaded_case->source.camera, iteration->refinement, kSide_px);
  const bool rejected = state_.snapshot() && isRejected(*state_.snapshot());
  for (std::size_t i = 0; i < views_.size(); ++i)
    views_[i]->setPlace(i < close_ups.size() ? std::optional(close_ups[i]) : std::nullopt,
                        rejected);
  ui_.pages->setCurrentIndex(close_ups.empty() ? 0 : 1);
}

}  // namespace boresight::ui
