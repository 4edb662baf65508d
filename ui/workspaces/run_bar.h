// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QList>
#include <QPointF>
#include <QVector>
#include <QWidget>

class QAction;
class QHBoxLayout;
class QLabel;
class QToolButton;

namespace boresight::ui {

class RunScrubber;
class ViewState;

/// Corrections of the shown run's iterations: a line with a dot per iteration, on a logarithmic
/// scale; the shown iteration's dot is filled.
class CorrectionLine : public QWidget {
  Q_OBJECT

 public:
  explicit CorrectionLine(ViewState& state);

  QSize sizeHint() const override { return {120, 32}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QVector<QPointF> places() const;

  ViewState& state_;
};

/// Bar below the canvas: buttons of the run, and the scrubber through its iterations and stages.
class RunBar : public QFrame {
  Q_OBJECT

 public:
  explicit RunBar(ViewState& state, QWidget* parent = nullptr);

  RunScrubber& scrubber() { return *scrubber_; }
  /// Sets actions of the menus; the buttons show their icons and states.
  void setActions(const QList<QAction*>& actions);
  /// A narrow bar is lower, has icons without text, and no corrections at its end.
  void setNarrow(bool narrow);
  /// Without the corrections, which are shown where there is room.
  QSize minimumSizeHint() const override;

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void showCursor();
  int widthOfCorrections() const;

  ViewState& state_;
  QHBoxLayout* buttons_ = nullptr;
  QList<QToolButton*> run_buttons_;
  RunScrubber* scrubber_ = nullptr;
  QLabel* correction_ = nullptr;
  CorrectionLine* corrections_ = nullptr;
  bool narrow_ = false;
};

}  // namespace boresight::ui
