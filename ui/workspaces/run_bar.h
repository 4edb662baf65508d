// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QList>

class QAction;
class QHBoxLayout;
class QLabel;
class QToolButton;

namespace boresight::ui {

class RunScrubber;
class ViewState;

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
  QWidget* corrections_ = nullptr;  ///< curve of the corrections of all iterations
  bool narrow_ = false;
};

}  // namespace boresight::ui
