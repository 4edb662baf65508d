// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_rows.h"

#include <QCoreApplication>

#include "sessions/review/standing.h"
#include "ui/models/number_text.h"

namespace boresight::ui {
namespace {

QString detailOf(const sessions::Session& session, const std::string& id,
                 const sessions::Standing& standing) {
  QString text = fromText(sessions::standingText(standing));
  if (const sessions::RunRecord* run = session.lastRunOf(id))
    text += QCoreApplication::translate("CaseRows", "\nLast run %1: %2")
                .arg(fromText(run->time), fromText(run->status)) +
            (run->together ? QStringLiteral(", ") + fromText(togetherText(run->together->views, id))
                           : QString());
  return text;
}

}  // namespace

std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running) {
  std::vector<CaseRow> rows;
  for (const auto& one : session.cases) {
    CaseRow row;
    row.id = QString::fromStdString(one->id);
    row.station = QString::fromStdString(one->station);
    const sessions::Standing standing = sessions::standingOf(session, one->id);
    row.state = row.id == running ? CaseState::kRunning : caseStateOf(standing.state);
    row.detail = detailOf(session, one->id, standing);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace boresight::ui
