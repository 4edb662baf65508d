// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <QWidget>

#include "ui/views/layer.h"

class QCheckBox;
class QGridLayout;
class QLabel;
class QSlider;
class QToolButton;

namespace boresight::ui {

class ImagePanel;

/// One row per layer: shown or not (with its key), colour, opacity. The few layers of a workspace
/// come first; the others are below a button.
class LayersPanel : public QWidget {
  Q_OBJECT

 public:
  explicit LayersPanel(ImagePanel& image, QWidget* parent = nullptr);

  /// The layers of a workspace, from top to bottom, here and in the image's legend; empty: all.
  void setShortList(const std::vector<LayerId>& layers);
  /// Shows all layers; called by the legend's button.
  void showAll();

 private:
  struct Row {
    QCheckBox* shown = nullptr;
    QLabel* key = nullptr;
    QToolButton* color = nullptr;
    QSlider* opacity = nullptr;
  };

  void buildRow(LayerId id);
  std::array<QWidget*, 4> place(const Row& row, int grid_row);
  void chooseColor(LayerId id);
  void showStyles();
  void arrange();

  ImagePanel& image_;
  std::vector<Row> rows_;
  std::vector<LayerId> short_list_;
  QGridLayout* grid_ = nullptr;
  QToolButton* all_ = nullptr;  ///< checked: all layers are listed
};

}  // namespace boresight::ui
