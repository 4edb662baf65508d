// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <QDialog>

namespace boresight::ui {

namespace Ui {
class LimitsDialog;
}
class ReviewController;

/// Limits of the session's checks: preset, single limits, and whether a second person must approve.
/// Stays open next to the checks; every change is an edit at once.
class LimitsDialog : public QDialog {
  Q_OBJECT

 public:
  LimitsDialog(ReviewController& controller, QWidget* parent);
  ~LimitsDialog() override;

 private:
  void change(const std::string& name, const std::string& value);
  void showSettings();

  ReviewController& controller_;
  const std::unique_ptr<Ui::LimitsDialog> ui_;
};

}  // namespace boresight::ui
