// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layers_panel.h"

#include <cmath>

#include <QtWidgets>

#include "ui/views/image_panel.h"

namespace boresight::ui {
namespace {

constexpr int kSwatchPx = 14;
constexpr int kWidestSlider_px = 240;

QIcon swatch(const QColor& color) {
  QPixmap picture(kSwatchPx, kSwatchPx);
  picture.fill(color);
  return picture;
}

}  // namespace

LayersPanel::LayersPanel(ImagePanel& image, QWidget* parent) : QWidget(parent), image_(image) {
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  outer->addWidget(scroll);
  auto* list = new QWidget;
  auto* grid = new QGridLayout(list);
  grid->setContentsMargins(6, 6, 6, 6);
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(2);
  rows_.resize(kLayerCount);
  for (int i = 0; i < kLayerCount; ++i) buildRow(*grid, static_cast<LayerId>(i));
  grid->setColumnStretch(3, 100);  // as wide as a slider may be; the rest stays empty
  grid->setColumnStretch(4, 1);
  grid->setRowStretch(kLayerCount, 1);
  scroll->setWidget(list);
  connect(&image_, &ImagePanel::stylesChanged, this, &LayersPanel::showStyles);
  showStyles();
}

void LayersPanel::buildRow(QGridLayout& grid, LayerId id) {
  const int index = static_cast<int>(id);
  Row& row = rows_[static_cast<std::size_t>(index)];
  const LayerInfo& info = layerInfo(id);
  row.shown = new QCheckBox(tr(info.name));
  row.shown->setObjectName(QStringLiteral("layer%1").arg(index));
  row.shown->setToolTip(tr(info.help));
  auto* key = new QLabel(QString::fromLatin1(info.key));
  key->setFrameShape(QFrame::StyledPanel);  // as a key cap
  key->setAlignment(Qt::AlignCenter);
  key->setToolTip(tr("Key that toggles this layer"));
  row.color = new QToolButton;
  row.color->setAutoRaise(true);
  row.color->setToolTip(tr("Colour of %1").arg(tr(info.name).toLower()));
  row.color->setAccessibleName(row.color->toolTip());
  row.opacity = new QSlider(Qt::Horizontal);
  row.opacity->setRange(0, 100);
  row.opacity->setMaximumWidth(kWidestSlider_px);
  row.opacity->setToolTip(tr("Opacity, percent"));
  row.opacity->setAccessibleName(tr("Opacity of %1").arg(tr(info.name).toLower()));
  // The uppermost layer stands first, as it lies over the others.
  const int line = kLayerCount - 1 - index;
  grid.addWidget(row.shown, line, 0);
  grid.addWidget(key, line, 1);
  grid.addWidget(row.color, line, 2);
  grid.addWidget(row.opacity, line, 3);
  connect(row.shown, &QCheckBox::toggled, this, [this, id](bool on) {
    LayerStyle style = image_.style(id);
    style.visible = on;
    image_.setStyle(id, style);
  });
  connect(row.opacity, &QSlider::valueChanged, this, [this, id](int percent) {
    LayerStyle style = image_.style(id);
    style.opacity = percent / 100.0;
    image_.setStyle(id, style);
  });
  connect(row.color, &QToolButton::clicked, this, [this, id] { chooseColor(id); });
}

void LayersPanel::chooseColor(LayerId id) {
  LayerStyle style = image_.style(id);
  const QColor chosen =
      QColorDialog::getColor(style.color, this, tr("Colour of %1").arg(tr(layerInfo(id).name)));
  if (!chosen.isValid()) return;
  style.color = chosen;
  image_.setStyle(id, style);
}

void LayersPanel::showStyles() {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const LayerStyle& style = image_.style(static_cast<LayerId>(i));
    const QSignalBlocker no_toggle(rows_[i].shown);
    const QSignalBlocker no_change(rows_[i].opacity);
    rows_[i].shown->setChecked(style.visible);
    rows_[i].opacity->setValue(static_cast<int>(std::lround(100.0 * style.opacity)));
    rows_[i].color->setIcon(swatch(style.color));
  }
}

}  // namespace boresight::ui
