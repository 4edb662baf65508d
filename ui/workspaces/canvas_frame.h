// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>

class QLabel;
class QVBoxLayout;

namespace boresight::ui {

/// Whose run the canvas shows.
enum class CanvasSource { kOnly, kOnboard, kGround };

/// Round the canvas: where onboard and ground run are compared, a frame and a head that say which
/// of them is shown. An onboard run has its frame in every workspace.
class CanvasFrame : public QFrame {
  Q_OBJECT

 public:
  explicit CanvasFrame(QWidget& canvas, QWidget* parent = nullptr);

  void setSource(CanvasSource source);
  CanvasSource source() const { return source_; }

 private:
  CanvasSource source_ = CanvasSource::kOnboard;
  QLabel* head_ = nullptr;
};

}  // namespace boresight::ui
