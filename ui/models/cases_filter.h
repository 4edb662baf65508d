// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QSortFilterProxyModel>

#include "ui/models/cases_model.h"

namespace boresight::ui {

/// Cases whose id or station holds a text, in one state or any; those without a number come last
/// either way.
class CasesFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit CasesFilter(QObject* parent = nullptr);

  void setText(const QString& text);
  void setState(std::optional<CaseState> state);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  QString text_;
  std::optional<CaseState> state_;
};

}  // namespace boresight::ui
