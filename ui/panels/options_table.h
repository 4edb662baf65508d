// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QTableView>

#include "ui/models/options_model.h"

namespace boresight::ui {

/// Options to read and edit: a list for choices, a spin box for integers, a line for other numbers.
/// The Delete key and a click on "reset" ask for the default.
class OptionsTable : public QTableView {
  Q_OBJECT

 public:
  explicit OptionsTable(QWidget* parent = nullptr);

  OptionsModel& options() { return model_; }
  void setOptions(const std::vector<sessions::OptionDescription>& now,
                  const std::vector<sessions::OptionDescription>& by_default);
  /// Shows the options whose name or help holds every word; all of them, or those that differ from
  /// their default.
  void setFilter(const QString& words, bool changed_only);

 Q_SIGNALS:
  /// What the chosen option does; empty when none is chosen.
  void helpChanged(const QString& help);

 private:
  void showHelp();

  OptionsModel model_;
  RowsFilter filter_;
};

}  // namespace boresight::ui
