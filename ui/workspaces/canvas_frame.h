// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>

class QLabel;

namespace boresight::ui {

/// Source of the run that the canvas shows.
enum class CanvasSource { kOnly, kOnboard, kGround };

/// Frame round the canvas: when onboard and ground run are compared, frame and head show which of
/// them is displayed. An onboard run has its frame in every workspace.
class CanvasFrame : public QFrame {
  Q_OBJECT

 public:
  explicit CanvasFrame(QWidget& canvas, QWidget* parent = nullptr);

  void setSource(CanvasSource source);

 private:
  CanvasSource source_ = CanvasSource::kOnboard;
  QLabel* head_ = nullptr;
};

}  // namespace boresight::ui
