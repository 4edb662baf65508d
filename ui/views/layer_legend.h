// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QFrame>

#include "ui/views/layer.h"

namespace boresight::ui {

class ImagePanel;

/// On the image: a line sample, the name and the key of each of a few layers; a click shows or
/// hides the layer. Layers without content are gray.
class LayerLegend : public QFrame {
  Q_OBJECT

 public:
  explicit LayerLegend(ImagePanel& image);

  /// Layers from top to bottom; layers for comparison are added while they have content.
  void setLayers(const std::vector<LayerId>& layers);
  const std::vector<LayerId>& layers() const { return layers_; }
  /// Layers that are listed now.
  std::vector<LayerId> shown() const;

 Q_SIGNALS:
  void allLayersRequested();

 private:
  class Row;

  void update();

  ImagePanel& image_;
  std::vector<LayerId> layers_;
  std::vector<Row*> rows_;  ///< by layer
};

}  // namespace boresight::ui
