// SPDX-License-Identifier: Apache-2.0
#include "ui/models/cases_model.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <QIcon>
#include <QPixmap>

#include "ui/models/number_text.h"

namespace boresight::ui {
namespace {

double errorOf(const CaseRow& row, int column) {
  const std::optional<double>& value = column == CasesModel::kNormal_mm    ? row.normal_mm
                                       : column == CasesModel::kLateral_mm ? row.lateral_mm
                                                                           : row.rotation_deg;
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

bool isError(int column) { return column >= CasesModel::kNormal_mm; }

QString tooltipOf(const CaseRow& row) {
  QString text = row.id;
  if (!row.station.isEmpty()) text += CasesModel::tr(", station %1").arg(row.station);
  text += QLatin1Char('\n') + CasesModel::stateText(row.state);
  if (row.stale)
    text += CasesModel::tr("\nStale: the inputs or options have changed since its run.");
  if (!row.detail.isEmpty()) text += QLatin1Char('\n') + row.detail;
  return text;
}

}  // namespace

CaseState caseStateOf(sessions::CaseStanding standing) {
  using sessions::CaseStanding;
  switch (standing) {
    case CaseStanding::kConverged:
      return CaseState::kConverged;
    case CaseStanding::kFailed:
      return CaseState::kFailed;
    case CaseStanding::kAnnotated:
      return CaseState::kAnnotated;
    case CaseStanding::kValidated:
      return CaseState::kValidated;
    case CaseStanding::kRejected:
      return CaseState::kRejected;
    case CaseStanding::kNew:
      break;
  }
  return CaseState::kNew;
}

CasesModel::CasesModel(QObject* parent) : QAbstractTableModel(parent) {}

bool CasesModel::hasSameIds(const std::vector<CaseRow>& rows) const {
  return std::equal(rows.begin(), rows.end(), rows_.begin(), rows_.end(),
                    [](const CaseRow& a, const CaseRow& b) { return a.id == b.id; });
}

void CasesModel::setRows(std::vector<CaseRow> rows) {
  if (!hasSameIds(rows)) {
    beginResetModel();
    rows_ = std::move(rows);
    endResetModel();
    return;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows_[i] == rows[i]) continue;
    rows_[i] = std::move(rows[i]);
    const int row = static_cast<int>(i);
    Q_EMIT dataChanged(index(row, 0), index(row, kColumnCount - 1));
  }
}

int CasesModel::rowOf(const QString& id) const {
  const auto found =
      std::find_if(rows_.begin(), rows_.end(), [&id](const CaseRow& row) { return row.id == id; });
  return found == rows_.end() ? -1 : static_cast<int>(found - rows_.begin());
}

QString CasesModel::stateText(CaseState state) {
  switch (state) {
    case CaseState::kNew:
      return tr("○ new");
    case CaseState::kRunning:
      return tr("… running");
    case CaseState::kConverged:
      return tr("✓ converged");
    case CaseState::kFailed:
      return tr("✗ failed");
    case CaseState::kAnnotated:
      return tr("✎ annotated");
    case CaseState::kValidated:
      return tr("★ validated");
    case CaseState::kRejected:
      return tr("⊘ rejected");
  }
  return {};
}

int CasesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int CasesModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QVariant CasesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const CaseRow& row = caseAt(index.row());
  const int column = index.column();
  switch (role) {
    case Qt::DisplayRole:
      if (column == kCase) return row.id;
      if (column != kState) return numberText(errorOf(row, column), 3);
      return stateText(row.state) + (row.stale ? tr(", stale") : QString());
    case Qt::DecorationRole:
      if (column != kCase || row.thumbnail.isNull()) return {};
      return QIcon(QPixmap::fromImage(row.thumbnail));  // drawn in the view's size
    case Qt::ToolTipRole:
      return tooltipOf(row);
    case Qt::TextAlignmentRole:
      return static_cast<int>((isError(column) ? Qt::AlignRight : Qt::AlignLeft) |
                              Qt::AlignVCenter);
    case kSortRole:
      if (column == kCase) return row.id;
      return column == kState ? QVariant(static_cast<int>(row.state)) : errorOf(row, column);
    default:
      return {};
  }
}

QVariant CasesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumnCount) return {};
  const QString titles[] = {tr("Case"), tr("State"), tr("Normal,\nmm"), tr("Lateral,\nmm"),
                            tr("Turned,\ndeg")};
  const QString help[] = {
      tr("The image's name."),
      tr("What has become of the case: new, running, converged, failed, annotated, validated, "
         "rejected. Stale: its inputs or options have changed since its run."),
      tr("Error of the result along the view axis at the end effector (at the camera where that is "
         "not known), in mm, where the truth is known."),
      tr("Error of the result across the view axis at the end effector (at the camera where that "
         "is not known), in mm, where the truth is known."),
      tr("Angle between the view axes of the result and the truth, in degrees, where that is "
         "known.")};
  if (role == Qt::DisplayRole) return titles[section];
  if (role == Qt::ToolTipRole) return help[section];
  return {};
}

}  // namespace boresight::ui
