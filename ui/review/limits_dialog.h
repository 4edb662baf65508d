// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QDialog>

#include "sessions/session/check_limits.h"
#include "ui/models/rows_model.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class QTableView;
class QVBoxLayout;

namespace boresight::ui {

/// A limit, and the preset's.
struct LimitRow {
  sessions::OptionDescription now;
  sessions::OptionDescription of_preset;

  bool isChanged() const { return now.value != of_preset.value; }
};

/// The limits of the checks beside those of the preset. What differs is bold and can be reset. A
/// value out of range is refused, and `refused` says why.
class LimitsModel : public RowsModel<LimitRow> {
  Q_OBJECT

 public:
  enum Column { kName, kValue, kUnit, kPreset, kRange };

  explicit LimitsModel(QObject* parent = nullptr);

  /// From the document; emits nothing.
  void setLimits(const sessions::CheckLimits& limits, const sessions::CheckLimits& of_preset);
  /// To the preset's value.
  void reset(int row);
  void resetAll();

  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

 Q_SIGNALS:
  void edited(const boresight::sessions::CheckLimits& limits);
  /// A value was not taken; one sentence for people.
  void refused(const QString& message);

 protected:
  QVariant look(const LimitRow& row, int column, int role) const override;

 private:
  sessions::CheckLimits limits_;
  sessions::CheckLimits of_preset_;
};

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
