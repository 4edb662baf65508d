// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <QLabel>
#include <QTableView>

#include "sessions/io/json/option_value.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

/// An option, and its default in the chosen profile or preset.
struct OptionRow {
  sessions::OptionDescription now;
  sessions::OptionDescription by_default;
  bool isChanged() const { return now.value != by_default.value; }
};

/// Options as a table: a row per option, bold where it differs from its default. An edit is only
/// reported: the owner of the options answers with new rows.
class OptionsModel : public RowsModel<OptionRow> {
  Q_OBJECT

 public:
  enum Column { kName, kValue, kReset, kUnit, kDefault, kRange };

  OptionsModel();

  /// Both lists hold the same options in the same order.
  void setOptions(const std::vector<sessions::OptionDescription>& current,
                  const std::vector<sessions::OptionDescription>& by_default);
  int changedCount() const;
  /// Requests the default of a row, unless that is its value already.
  void reset(int row);
  /// "0 .. 1", "true, false", or the choices.
  static QString rangeText(const sessions::OptionDescription& option);

  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

 Q_SIGNALS:
  /// The requested value of an option, as text.
  void edited(const std::string& name, const std::string& value);

 protected:
  QVariant look(const OptionRow& row, int column, int role) const override;
};

/// Table to view and edit options: a list for choices, a spin box for integers, a line for other
/// numbers. The Delete key and a click on "reset" request the default.
class OptionsTable : public QTableView {
  Q_OBJECT

 public:
  explicit OptionsTable(QWidget* parent = nullptr);

  OptionsModel& options() { return model_; }
  /// Sets the label that describes the chosen option and reports refused edits. It shows `prompt`
  /// while no option is chosen.
  void describeIn(QLabel& help, const QString& prompt);
  /// Changes one of the owner's options. Returns false, and reports why, if the value is refused.
  template <class Options>
  bool apply(Options& options, const std::string& name, const std::string& value) {
    try {
      sessions::applyOptionText(options, name, value);
      return true;
    } catch (const sessions::OptionError& error) {
      if (help_) help_->setText(tr("✗ Not changed: %1.").arg(fromText(error.what())));
      return false;
    }
  }
  void setOptions(const std::vector<sessions::OptionDescription>& current,
                  const std::vector<sessions::OptionDescription>& by_default);
  /// Shows the options whose name or help holds every word; with `changed_only` only those that
  /// differ from their default.
  void setFilter(const QString& words, bool changed_only);

 private:
  void showHelp();

  OptionsModel model_;
  RowsFilter filter_;
  QLabel* help_ = nullptr;
  QString prompt_;
};

}  // namespace boresight::ui
