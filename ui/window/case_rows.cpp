// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_rows.h"

#include <QCoreApplication>

namespace boresight::ui {
namespace {

CaseState stateOf(const sessions::Session& session, const std::string& id) {
  const sessions::Decision* decision = session.decisionOn(id);
  if (decision && decision->verdict == sessions::Verdict::kValidated) return CaseState::kValidated;
  if (const sessions::RunRecord* run = session.lastRunOf(id))
    return run->status == "converged" ? CaseState::kConverged : CaseState::kFailed;
  return session.annotations.count(id) > 0 ? CaseState::kAnnotated : CaseState::kNew;
}

}  // namespace

std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running) {
  std::vector<CaseRow> rows;
  for (const auto& one : session.cases) {
    CaseRow row;
    row.id = QString::fromStdString(one->id);
    row.station = QString::fromStdString(one->station);
    row.state = row.id == running ? CaseState::kRunning : stateOf(session, one->id);
    if (const sessions::RunRecord* run = session.lastRunOf(one->id))
      row.detail = QCoreApplication::translate("CaseRows", "Last run %1: %2")
                       .arg(QString::fromStdString(run->time), QString::fromStdString(run->status));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace boresight::ui
