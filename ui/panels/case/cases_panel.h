// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QImage>
#include <QString>
#include <QStringList>
#include <QWidget>

#include "ui_cases_panel.h"

#include "sessions/review/review_status.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

class EmptyHint;

/// In the order of sessions::ReviewState, with a state for runs under way in addition.
enum class CaseState { kNew, kConverged, kFailed, kAnnotated, kValidated, kRejected, kRunning };
inline constexpr int kCaseStateCount = static_cast<int>(CaseState::kRunning) + 1;

inline CaseState caseStateOf(sessions::ReviewState status) {
  return static_cast<CaseState>(status);
}
static_assert(static_cast<int>(sessions::ReviewState::kRejected) ==
              static_cast<int>(CaseState::kRejected));

/// One case as the list shows it.
struct CaseRow {
  QString id;       ///< unique
  QString station;  ///< may be empty
  QImage thumbnail;
  CaseState state = CaseState::kNew;
  bool stale = false;            ///< outdated: its last run was made with other inputs or options
  bool awaits_approval = false;  ///< validated by one person where two are required
  QString detail;                ///< e.g. why it failed, for the tooltip
  /// Errors against the truth, if it is known and the run has a pose.
  std::optional<double> normal_mm;
  std::optional<double> lateral_mm;
  std::optional<double> rotation_deg;

  bool operator==(const CaseRow&) const = default;
};

/// The cases of a session. New rows with the same ids change in place, so that selections stay.
class CasesModel : public RowsModel<CaseRow> {
  Q_OBJECT

 public:
  enum Column { kCase, kState, kNormal_mm, kLateral_mm, kRotation_deg };

  CasesModel();

  void setRows(std::vector<CaseRow> rows);
  /// -1 when there is none.
  int rowOf(const QString& id) const;
  /// A word after a sign whose shape is unique to the state.
  static QString stateText(CaseState state);

 protected:
  QVariant look(const CaseRow& row, int column, int role) const override;
};

/// The cases of the session: filter, sort, open, run one, run all that are listed.
class CasesPanel : public QWidget {
  Q_OBJECT

 public:
  CasesPanel();

  void setRows(std::vector<CaseRow> rows);
  void setRow(int row, const CaseRow& value);
  /// Shows the open case as chosen without requesting it.
  void setCurrent(const QString& id);
  /// Whether runs can be started now.
  void setRunnable(bool runnable);
  /// Ids in the order in which they are listed.
  QStringList listed() const;
  const CasesModel& model() const { return model_; }
  CasesModel& model() { return model_; }

 Q_SIGNALS:
  void openRequested(const QString& id);
  void runRequested(const QString& id);
  void runAllRequested(const QStringList& ids);
  /// At a place on the screen.
  void menuRequested(const QString& id, const QPoint& at);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void buildTable();
  void applyFilter();
  void fitColumns();
  void fitCaseColumn();
  QString chosen() const;
  void chooseRow(const QModelIndex& current);
  void showCount();

  CasesModel model_;
  RowsFilter filter_;
  EmptyHint* hint_ = nullptr;
  QString current_;
  int whole_case_ = 0;  ///< width that the longest name needs, 0 without rows
  bool runnable_ = true;
  bool showing_ = false;  ///< the table is being updated by the window, not the operator
  Ui::CasesPanel ui_;
};

}  // namespace boresight::ui
