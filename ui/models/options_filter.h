// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QSortFilterProxyModel>

namespace boresight::ui {

/// Options whose name or help holds every word of a text; all of them, or those that were changed.
class OptionsFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit OptionsFilter(QObject* parent = nullptr);

  void setWords(const QString& text);
  void setChangedOnly(bool changed_only);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

 private:
  QStringList words_;
  bool changed_only_ = false;
};

}  // namespace boresight::ui
