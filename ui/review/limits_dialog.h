// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QDialog>

#include "ui/review/limits_model.h"

QT_BEGIN_NAMESPACE
class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class QTableView;
class QVBoxLayout;
QT_END_NAMESPACE

namespace boresight::ui {

class ReviewController;

/// By what the poses of the session are judged: preset, limits, and whether a second person
/// approves. Stays open beside the checks; every change is an edit at once.
class LimitsDialog : public QDialog {
  Q_OBJECT

 public:
  LimitsDialog(ReviewController& controller, QWidget* parent);

 private:
  void buildTop(QVBoxLayout& column);
  void buildTable(QVBoxLayout& column);
  void buildBottom(QVBoxLayout& column);
  void showSettings();
  void showChosen();

  ReviewController& controller_;
  LimitsModel model_;
  QComboBox* preset_ = nullptr;
  QLabel* preset_help_ = nullptr;
  QTableView* table_ = nullptr;
  QLabel* help_ = nullptr;
  QCheckBox* second_ = nullptr;
  QPushButton* reset_ = nullptr;
};

}  // namespace boresight::ui
