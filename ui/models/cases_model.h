// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QAbstractTableModel>
#include <QImage>
#include <QString>

#include "sessions/review/standing.h"

namespace boresight::ui {

enum class CaseState { kNew, kRunning, kConverged, kFailed, kAnnotated, kValidated, kRejected };
inline constexpr int kCaseStateCount = 7;

/// How the list names where a case stands.
CaseState caseStateOf(sessions::CaseStanding standing);

/// One case as the list shows it.
struct CaseRow {
  QString id;       ///< unique
  QString station;  ///< may be empty
  QImage thumbnail;
  CaseState state = CaseState::kNew;
  bool stale = false;  ///< its last run was made with other inputs or options
  QString detail;      ///< e.g. why it failed, for the tooltip
  /// Against the truth, where it is known and a pose came out.
  std::optional<double> normal_mm;
  std::optional<double> lateral_mm;
  std::optional<double> rotation_deg;

  bool operator==(const CaseRow&) const = default;
};

/// The images of a session. New rows of the same ids change in place, so that selections stay.
class CasesModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kCase, kState, kNormal_mm, kLateral_mm, kRotation_deg, kColumnCount };
  /// What a column sorts by: text, or a number.
  static constexpr int kSortRole = Qt::UserRole;

  explicit CasesModel(QObject* parent = nullptr);

  void setRows(std::vector<CaseRow> rows);
  const CaseRow& caseAt(int row) const { return rows_[static_cast<std::size_t>(row)]; }
  /// -1 where there is none.
  int rowOf(const QString& id) const;
  /// A word with a sign of its own shape before it.
  static QString stateText(CaseState state);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  bool hasSameIds(const std::vector<CaseRow>& rows) const;

  std::vector<CaseRow> rows_;
};

}  // namespace boresight::ui
