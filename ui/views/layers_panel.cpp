// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layers_panel.h"

#include <algorithm>
#include <cmath>

#include <QtWidgets>

#include "ui/views/image_panel.h"
#include "ui/views/layer_legend.h"
#include "ui/widgets/widgets.h"

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
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  outer->addWidget(scroll);
  auto* list = new QWidget;
  grid_ = new QGridLayout(list);
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setHorizontalSpacing(8);
  grid_->setVerticalSpacing(2);
  rows_.resize(kLayerCount);
  for (int i = 0; i < kLayerCount; ++i) buildRow(static_cast<LayerId>(i));
  all_ = named(new QToolButton, "allLayersOpen", tr("List the other layers too"));
  all_->setText(tr("All layers"));
  all_->setCheckable(true);
  all_->setAutoRaise(true);
  all_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  connect(all_, &QToolButton::toggled, this, &LayersPanel::arrange);
  grid_->setColumnStretch(3, 100);  // as wide as a slider may be; the rest stays empty
  grid_->setColumnStretch(4, 1);
  grid_->setRowStretch(kLayerCount + 1, 1);
  scroll->setWidget(list);
  arrange();
  connect(&image_, &ImagePanel::stylesChanged, this, &LayersPanel::showStyles);
  showStyles();
}

void LayersPanel::buildRow(LayerId id) {
  const int index = static_cast<int>(id);
  Row& row = rows_[static_cast<std::size_t>(index)];
  const LayerInfo& info = layerInfo(id);
  row.shown = new QCheckBox(tr(info.name));
  row.shown->setObjectName(QStringLiteral("layer%1").arg(index));
  row.shown->setToolTip(tr(info.help));
  row.key = new QLabel(QString::fromLatin1(info.key));
  row.key->setFrameShape(QFrame::StyledPanel);  // as a key cap
  row.key->setAlignment(Qt::AlignCenter);
  row.key->setToolTip(tr("Key that toggles this layer"));
  row.color = new QToolButton;
  row.color->setAutoRaise(true);
  row.color->setToolTip(tr("Colour of %1").arg(tr(info.name).toLower()));
  row.color->setAccessibleName(row.color->toolTip());
  row.opacity = new QSlider(Qt::Horizontal);
  row.opacity->setRange(0, 100);
  row.opacity->setMaximumWidth(kWidestSlider_px);
  row.opacity->setToolTip(tr("Opacity, percent"));
  row.opacity->setAccessibleName(tr("Opacity of %1").arg(tr(info.name).toLower()));
  place(row, index);
  connect(row.shown, &QCheckBox::toggled, this, [this, id](bool on) { image_.showLayer(id, on); });
  connect(row.opacity, &QSlider::valueChanged, this, [this, id](int percent) {
    LayerStyle style = image_.style(id);
    style.opacity = percent / 100.0;
    image_.setStyle(id, style);
  });
  connect(row.color, &QToolButton::clicked, this, [this, id] { chooseColor(id); });
}

std::array<QWidget*, 4> LayersPanel::place(const Row& row, int grid_row) {
  const std::array<QWidget*, 4> widgets = {row.shown, row.key, row.color, row.opacity};
  for (int column = 0; column < 4; ++column)
    grid_->addWidget(widgets[static_cast<std::size_t>(column)], grid_row, column);
  return widgets;
}

/// The short list in its order, then the others, the uppermost first as it lies over the others.
void LayersPanel::arrange() {
  std::vector<LayerId> order = short_list_;
  for (int i = kLayerCount - 1; i >= 0; --i)
    if (std::ranges::count(short_list_, static_cast<LayerId>(i)) == 0)
      order.push_back(static_cast<LayerId>(i));
  const auto fewer = static_cast<int>(short_list_.size());
  for (int i = 0; i < kLayerCount; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    const bool shows = i < fewer || fewer == 0 || all_->isChecked();
    for (QWidget* each : place(row, i < fewer ? i : i + 1)) each->setVisible(shows);
  }
  grid_->addWidget(all_, fewer, 0, 1, 4);
  all_->setVisible(fewer > 0);
  all_->setArrowType(all_->isChecked() ? Qt::DownArrow : Qt::RightArrow);
}

void LayersPanel::setShortList(const std::vector<LayerId>& layers) {
  short_list_ = layers;
  if (!layers.empty()) image_.legend().setLayers(layers);
  arrange();
}

void LayersPanel::showAll() { all_->setChecked(true); }

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
