// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QWidget>

#include "ui/workspaces/remedies.h"

class QVBoxLayout;

namespace boresight::ui {

class Banner;
class ViewState;

/// Remedies for the shown run, the most likely first: the observed cause, and a button that applies
/// the remedy.
class RemediesPanel : public QWidget {
  Q_OBJECT

 public:
  explicit RemediesPanel(ViewState& state, QWidget* parent = nullptr);

  /// Sets the remedies tried before the shown run.
  void setTried(const std::vector<Step>& tried);

 Q_SIGNALS:
  void stepRequested(boresight::ui::Step step);

 private:
  void showRun();
  QWidget* rowOf(const Remedy& remedy);

  ViewState& state_;
  std::vector<Step> tried_;
  std::vector<Remedy> remedies_;  ///< shown
  QString none_;                  ///< shown instead of them
  Banner* status_ = nullptr;      ///< measured and required values, in full
  QVBoxLayout* rows_ = nullptr;
};

}  // namespace boresight::ui
