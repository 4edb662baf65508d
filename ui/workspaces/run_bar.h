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

/// Below the canvas: buttons of the run, and the scrubber through its iterations and stages.
class RunBar : public QFrame {
  Q_OBJECT

 public:
  explicit RunBar(ViewState& state, QWidget* parent = nullptr);

  RunScrubber& scrubber() { return *scrubber_; }
  /// Of the menus; their icons and states are theirs.
  void setActions(const QList<QAction*>& actions);
  /// A narrow bar is lower, has icons without text, and no figures at its end.
  void setNarrow(bool narrow);

 private:
  void showCursor();

  ViewState& state_;
  QHBoxLayout* buttons_ = nullptr;
  QList<QToolButton*> run_buttons_;
  RunScrubber* scrubber_ = nullptr;
  QLabel* correction_ = nullptr;
  bool narrow_ = false;
};

}  // namespace boresight::ui
