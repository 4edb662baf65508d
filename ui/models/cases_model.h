// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QImage>
#include <QString>

#include "sessions/review/review_status.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

enum class CaseState { kNew, kRunning, kConverged, kFailed, kAnnotated, kValidated, kRejected };
inline constexpr int kCaseStateCount = 7;

/// How the list names where a case stands.
CaseState caseStateOf(sessions::ReviewState status);

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
class CasesModel : public RowsModel<CaseRow> {
  Q_OBJECT

 public:
  enum Column { kCase, kState, kNormal_mm, kLateral_mm, kRotation_deg };

  explicit CasesModel(QObject* parent = nullptr);

  void setRows(std::vector<CaseRow> rows);
  /// -1 where there is none.
  int rowOf(const QString& id) const;
  /// A word with a sign of its own shape before it.
  static QString stateText(CaseState state);

 protected:
  QVariant look(const CaseRow& row, int column, int role) const override;
};

}  // namespace boresight::ui
