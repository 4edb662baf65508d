// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QStringList>
#include <QWidget>

#include "ui/models/cases_model.h"

namespace boresight::ui {

namespace Ui {
class CasesPanel;
}

class EmptyHint;

/// The images of the session: filter, sort, open, run one, run those that are listed.
class CasesPanel : public QWidget {
  Q_OBJECT

 public:
  explicit CasesPanel(QWidget* parent = nullptr);
  ~CasesPanel() override;

  void setRows(std::vector<CaseRow> rows);
  /// The case that is open; shows it without asking for it.
  void setCurrent(const QString& id);
  /// Whether runs can be started now.
  void setRunnable(bool runnable);
  /// Ids in the order in which they are listed.
  QStringList listed() const;
  const CasesModel& model() const { return model_; }

 Q_SIGNALS:
  void openRequested(const QString& id);
  void runRequested(const QString& id);
  void runAllRequested(const QStringList& ids);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void buildTable();
  void applyFilter();
  void fitCaseColumn();
  QString chosen() const;
  void chooseRow(const QModelIndex& current);
  void showCount();

  CasesModel model_;
  RowsFilter filter_;
  EmptyHint* hint_ = nullptr;
  QString current_;
  int whole_case_ = 0;  ///< width in which the longest name would be shown whole, 0 before any
  bool runnable_ = true;
  bool showing_ = false;  ///< the table follows the window, not a person
  const std::unique_ptr<Ui::CasesPanel> ui_;
};

}  // namespace boresight::ui
