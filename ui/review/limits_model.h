// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QAbstractTableModel>
#include <QString>

#include "sessions/session/check_limits.h"

namespace boresight::ui {

/// The limits of the checks beside those of the preset. What differs is bold and can be reset. A
/// value out of range is refused, and `refused` says why.
class LimitsModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kName, kValue, kUnit, kPreset, kRange, kColumnCount };

  explicit LimitsModel(QObject* parent = nullptr);

  /// From the document; emits nothing.
  void setLimits(const sessions::CheckLimits& limits, const sessions::CheckLimits& of_preset);
  bool isChanged(int row) const;
  /// To the preset's value.
  void reset(int row);
  void resetAll();

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 Q_SIGNALS:
  void edited(const boresight::sessions::CheckLimits& limits);
  /// A value was not taken; one sentence for people.
  void refused(const QString& message);

 private:
  QString text(int row, int column) const;

  sessions::CheckLimits limits_;
  sessions::CheckLimits of_preset_;
  std::vector<sessions::OptionDescription> now_;
  std::vector<sessions::OptionDescription> before_;
};

}  // namespace boresight::ui
