// SPDX-License-Identifier: Apache-2.0
#include "ui/models/options_filter.h"

#include <algorithm>

#include "ui/models/number_text.h"
#include "ui/models/options_model.h"

namespace boresight::ui {

OptionsFilter::OptionsFilter(QObject* parent) : QSortFilterProxyModel(parent) {
  setRecursiveFilteringEnabled(true);  // a branch shows when one of its options does
}

void OptionsFilter::setWords(const QString& text) {
  words_ = text.simplified().split(QLatin1Char(' '));
  invalidateFilter();
}

void OptionsFilter::setChangedOnly(bool changed_only) {
  changed_only_ = changed_only;
  invalidateFilter();
}

bool OptionsFilter::filterAcceptsRow(int row, const QModelIndex& parent) const {
  const auto* model = qobject_cast<const OptionsModel*>(sourceModel());
  const QModelIndex index = sourceModel()->index(row, 0, parent);
  const sessions::OptionDescription* option = model ? model->option(index) : nullptr;
  if (option == nullptr) return false;
  if (changed_only_ && !model->isChanged(index)) return false;
  const QString text = fromText(option->name + " " + option->help);
  return std::all_of(words_.begin(), words_.end(), [&text](const QString& word) {
    return text.contains(word, Qt::CaseInsensitive);
  });
}

}  // namespace boresight::ui
