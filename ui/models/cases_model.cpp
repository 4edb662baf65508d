// SPDX-License-Identifier: Apache-2.0
#include "ui/models/cases_model.h"

#include <limits>
#include <utility>

#include <QIcon>
#include <QPixmap>

namespace boresight::ui {
namespace {

/// In the order of `CaseState`.
constexpr const char* kStateTexts[kCaseStateCount] = {
    QT_TR_NOOP("○ new"),     QT_TR_NOOP("… running"),   QT_TR_NOOP("✓ converged"),
    QT_TR_NOOP("✗ failed"),  QT_TR_NOOP("✎ annotated"), QT_TR_NOOP("★ validated"),
    QT_TR_NOOP("⊘ rejected")};

QString tooltipOf(const CaseRow& row) {
  QString text = row.id;
  if (!row.station.isEmpty()) text += CasesModel::tr(", station %1").arg(row.station);
  text += QLatin1Char('\n') + CasesModel::stateText(row.state);
  if (row.stale)
    text += CasesModel::tr("\nStale: the inputs or options have changed since its run.");
  if (!row.detail.isEmpty()) text += QLatin1Char('\n') + row.detail;
  return text;
}

std::vector<TableColumn<CaseRow>> caseColumns() {
  using Row = const CaseRow&;
  constexpr auto tr = [](const char* text) { return CasesModel::tr(text); };
  const auto error = [](std::optional<double> CaseRow::*value) {
    return [value](Row row) {
      return (row.*value).value_or(std::numeric_limits<double>::quiet_NaN());
    };
  };
  return {
      {tr("Case"), tr("The image's name."), -1, [](Row row) { return row.id; }},
      {tr("State"),
       tr("What has become of the case: new, running, converged, failed, annotated, validated, "
          "rejected. Stale: its inputs or options have changed since its run."),
       -1,
       [](Row row) {
         return CasesModel::stateText(row.state) +
                (row.stale ? CasesModel::tr(", stale") : QString());
       },
       [](Row row) { return static_cast<int>(row.state); }},
      {tr("Normal,\nmm"),
       tr("Error of the result along the view axis at the end effector (at the camera where that "
          "is not known), in mm, where the truth is known."),
       3, error(&CaseRow::normal_mm)},
      {tr("Lateral,\nmm"),
       tr("Error of the result across the view axis at the end effector (at the camera where that "
          "is not known), in mm, where the truth is known."),
       3, error(&CaseRow::lateral_mm)},
      {tr("Turned,\ndeg"),
       tr("Angle between the view axes of the result and the truth, in degrees, where that is "
          "known."),
       3, error(&CaseRow::rotation_deg)},
  };
}

}  // namespace

CaseState caseStateOf(sessions::ReviewState status) {
  using sessions::ReviewState;
  switch (status) {
    case ReviewState::kConverged:
      return CaseState::kConverged;
    case ReviewState::kFailed:
      return CaseState::kFailed;
    case ReviewState::kAnnotated:
      return CaseState::kAnnotated;
    case ReviewState::kValidated:
      return CaseState::kValidated;
    case ReviewState::kRejected:
      return CaseState::kRejected;
    case ReviewState::kNew:
      break;
  }
  return CaseState::kNew;
}

CasesModel::CasesModel(QObject* parent) : RowsModel(caseColumns(), parent) {}

void CasesModel::setRows(std::vector<CaseRow> rows) {
  if (rows != this->rows())
    setRowsByKey(std::move(rows), [](const CaseRow& row) { return row.id; });
}

int CasesModel::rowOf(const QString& id) const {
  return firstRow([&id](const CaseRow& row) { return row.id == id; });
}

QString CasesModel::stateText(CaseState state) {
  return tr(kStateTexts[static_cast<std::size_t>(state)]);
}

QVariant CasesModel::look(const CaseRow& row, int column, int role) const {
  if (role == Qt::ToolTipRole) return tooltipOf(row);
  if (role != Qt::DecorationRole || column != kCase || row.thumbnail.isNull()) return {};
  return QIcon(QPixmap::fromImage(row.thumbnail));  // drawn in the view's size
}

}  // namespace boresight::ui
