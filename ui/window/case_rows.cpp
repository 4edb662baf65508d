// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_rows.h"

#include <exception>

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

/// Options that cannot be read are said where they are shown.
bool isStale(const sessions::Session& session,
             const sessions::SharedValue<sessions::SessionCase>& one,
             const std::filesystem::path& file, sessions::StaleRuns& known) {
  const sessions::RunRecord* run = session.lastRunOf(one->id);
  try {
    return run && known.isStale(*run, one, session, file);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running,
                              const std::filesystem::path& file, sessions::StaleRuns& known) {
  std::vector<CaseRow> rows;
  for (const auto& one : session.cases) {
    CaseRow row;
    row.id = QString::fromStdString(one->id);
    row.station = QString::fromStdString(one->station);
    const sessions::Standing standing = sessions::standingOf(session, one->id);
    row.state = row.id == running ? CaseState::kRunning : caseStateOf(standing.state);
    const bool of_run = row.state == CaseState::kConverged || row.state == CaseState::kFailed;
    row.stale = of_run && isStale(session, one, file, known);
    row.detail = detailOf(session, one->id, standing);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace boresight::ui
