// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QWidget>

#include "ui/views/layer.h"

class QCheckBox;
class QGridLayout;
class QSlider;
class QToolButton;

namespace boresight::ui {

class ImagePanel;

/// One row per layer: shown or not (with its key), colour, opacity.
class LayersPanel : public QWidget {
  Q_OBJECT

 public:
  explicit LayersPanel(ImagePanel& image, QWidget* parent = nullptr);

 private:
  struct Row {
    QCheckBox* shown = nullptr;
    QToolButton* color = nullptr;
    QSlider* opacity = nullptr;
  };

  void buildRow(QGridLayout& grid, LayerId id);
  void chooseColor(LayerId id);
  void showStyles();

  ImagePanel& image_;
  std::vector<Row> rows_;
};

}  // namespace boresight::ui
