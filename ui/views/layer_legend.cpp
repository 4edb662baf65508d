// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layer_legend.h"

#include <algorithm>

#include <QtWidgets>

#include "ui/style/icons.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/line_painter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kSample = 30;
constexpr int kKeySide = 18;
constexpr int kSpace = 8;

/// Layers that are listed while there is something to compare, even hidden ones.
constexpr LayerId kOnDemand[] = {LayerId::kHypothesisEdges, LayerId::kChosenEdges,
                                 LayerId::kNudgedEdges, LayerId::kAnnotationEdges};

template <class Layers>
bool has(const Layers& layers, LayerId id) {
  return std::ranges::count(layers, id) > 0;
}

}  // namespace

/// A button that draws itself: the look of a line is its own icon.
class LayerLegend::Row : public QAbstractButton {
 public:
  explicit Row(const LayerInfo& info) : info_(info) {
    setCheckable(true);
    setFocusPolicy(Qt::NoFocus);  // keys stay the image's
    setObjectName(QStringLiteral("legend%1").arg(static_cast<int>(info.id)));
    setToolTip(ImagePanel::tr(info.help));
    setCursor(Qt::PointingHandCursor);
  }

  void setLayer(const Layer& layer) {
    layer_line_ = layer.shownLine();
    empty_ = layer.empty();
    setText(layer.name.isEmpty() ? ImagePanel::tr(info_.name) : layer.name);
    setChecked(layer.style.visible);
    setAccessibleName(text());
    update();
  }

  QSize sizeHint() const override {
    return {kSample + kKeySide + 3 * kSpace + fontMetrics().horizontalAdvance(text()),
            std::max(kKeySide, fontMetrics().height()) + 4};
  }

 protected:
  void paintEvent(QPaintEvent*) override {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    if (underMouse()) painter.fillRect(rect(), QColor(255, 255, 255, 24));
    const bool dim = !isChecked() || empty_;
    painter.setOpacity(dim ? 0.45 : 1.0);
    const QRectF sample(2.0, 0.0, kSample, height());
    if (info_.id == LayerId::kPoints) {
      painter.setPen(linePen(layer_line_));
      painter.drawEllipse(sample.center(), 5.0, 5.0);
    } else {
      paintLineSample(painter, sample, layer_line_);
    }
    painter.setPen(QColor(kOverlayText));
    const int left = kSample + kSpace;
    painter.drawText(QRect(left, 0, width() - left - kKeySide - kSpace, height()),
                     Qt::AlignLeft | Qt::AlignVCenter, text());
    paintKey(painter);
  }

 private:
  void paintKey(QPainter& painter) const {
    const QString key = QString::fromLatin1(info_.key);
    const QRectF cap(width() - kKeySide - 0.5, 0.5 * (height() - kKeySide), kKeySide - 1, kKeySide);
    painter.setPen(QColor(kDarkTheme.overlay_line));
    if (key.size() == 1) painter.drawRoundedRect(cap, 3.0, 3.0);
    painter.setPen(QColor(kDarkTheme.text2));
    if (key.size() == 1) painter.drawText(cap, Qt::AlignCenter, key);
  }

  const LayerInfo& info_;
  LineToken layer_line_ = kPoseLine;
  bool empty_ = true;
};

LayerLegend::LayerLegend(ImagePanel& image) : QFrame(&image.view()), image_(image) {
  setObjectName(QStringLiteral("legend"));
  setFocusPolicy(Qt::NoFocus);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(8, 6, 8, 6);
  column->setSpacing(2);
  for (int i = 0; i < kLayerCount; ++i) {
    const LayerInfo& info = layerInfo(static_cast<LayerId>(i));
    auto* row = new Row(info);
    rows_.push_back(row);
    connect(row, &QAbstractButton::clicked, this,
            [this, id = info.id](bool on) { image_.showLayer(id, on); });
  }
  auto* all = named(new QToolButton, "allLayers", tr("Colour and opacity of every layer"));
  all->setText(tr("All layers"));
  all->setIcon(overlayIcon(Icon::kLayers));
  all->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  all->setAutoRaise(true);
  all->setFocusPolicy(Qt::NoFocus);
  connect(all, &QToolButton::clicked, this, &LayerLegend::allLayersRequested);
  for (Row* row : rows_) column->addWidget(row);
  column->addWidget(all);
  connect(&image.view(), &ImageView::layersChanged, this, &LayerLegend::update);
  setLayers(
      {LayerId::kSeedEdges, LayerId::kIterationEdges, LayerId::kTruthEdges, LayerId::kMatches});
}

void LayerLegend::setLayers(const std::vector<LayerId>& layers) {
  layers_ = layers;
  auto* column = static_cast<QVBoxLayout*>(layout());
  int place = 0;
  for (const LayerId id : layers_)
    column->insertWidget(place++, rows_[static_cast<std::size_t>(id)]);
  update();
}

/// The layers of the workspace, and all others that are drawn.
std::vector<LayerId> LayerLegend::shown() const {
  std::vector<LayerId> result = layers_;
  for (int i = 0; i < kLayerCount; ++i) {
    const auto id = static_cast<LayerId>(i);
    const Layer& layer = image_.view().layer(id);
    const bool is_drawn = !layer.empty() && (layer.style.visible || has(kOnDemand, id));
    if (is_drawn && !has(result, id)) result.push_back(id);
  }
  return result;
}

void LayerLegend::update() {
  const std::vector<LayerId> listed = shown();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto id = static_cast<LayerId>(i);
    rows_[i]->setLayer(image_.view().layer(id));
    rows_[i]->setVisible(has(listed, id));
  }
  adjustSize();
  move(8, parentWidget()->height() - height() - 8);
}

}  // namespace boresight::ui
