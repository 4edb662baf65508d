// SPDX-License-Identifier: Apache-2.0
#include "ui/window/input_findings.h"

#include <algorithm>
#include <set>
#include <string>

#include <QMessageBox>

#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::FindingKind;

InputFindings::InputFindings(WindowParts& parts, Banner& bar, QWidget& window)
    : QObject(&window), parts_(parts), bar_(bar), window_(window) {
  connect(&parts_.document, &Document::opened, this, &InputFindings::check);
  connect(&bar_, &Banner::actionRequested, this, &InputFindings::repair);
  connect(&tasks_, &TaskRunner::failed, this, &InputFindings::failed);
}

/// After the files of the case that is shown are read: the same thread does one after the other.
void InputFindings::check() {
  findings_.clear();
  show();
  tasks_.cancel(QStringLiteral("check"));
  tasks_.cancel(QStringLiteral("mend"));
  waits_ = true;
  parts_.tasks.start(
      QStringLiteral("first case read"), [](const std::stop_token&) { return true; },
      [this](bool) {
        waits_ = false;
        tasks_.start(
            QStringLiteral("check"),
            [session = parts_.document.session()](const std::stop_token&) {
              return sessions::checkInputs(session);
            },
            [this](std::vector<sessions::Finding> findings) {
              findings_ = std::move(findings);
              show();
            });
      });
}

void InputFindings::show() {
  QStringList sentences;
  for (const sessions::Finding& finding : findings_) sentences << fromText(finding.text);
  bar_.showWarnings(sentences);
  Q_EMIT changed();
}

QString InputFindings::adviceFor(const QString& case_id) const {
  QStringList lines;
  bool missing = false;
  for (const sessions::Finding& finding : findings_) {
    if (finding.case_id != case_id.toStdString() || finding.what == "run") continue;
    lines << fromText(finding.text);
    missing |= finding.kind == FindingKind::kMissing;
  }
  if (lines.isEmpty()) return {};
  lines << (missing
                ? tr("Restore the file, or use \"Fix ...\" to search below the session's folder.")
                : tr("Restore the former file, or use \"Fix ...\" to accept the changed file."));
  return lines.join(QStringLiteral("\n\n"));
}

bool InputFindings::has(FindingKind kind) const {
  return std::ranges::any_of(findings_, [kind](const sessions::Finding& finding) {
    return finding.kind == kind && finding.what != "run";
  });
}

void InputFindings::repair() {
  if (has(FindingKind::kMissing)) {
    findMoved();
  } else if (has(FindingKind::kChanged)) {
    const auto answer = QMessageBox::question(
        &window_, tr("Boresight"),
        tr("Accept the changed files? Runs of the former files become stale."));
    if (answer == QMessageBox::Yes) acceptChanged();
  } else {
    check();  // the operator may have put things right
  }
}

void InputFindings::findMoved() {
  const sessions::Session session = parts_.document.session();
  tasks_.start(
      QStringLiteral("mend"),
      [session, file = parts_.document.file()](const std::stop_token&) {
        return sessions::findMissing(session, file);
      },
      [this](const std::vector<sessions::Relink>& relinks) {
        const Document& document = parts_.document;
        if (relinks.empty()) {
          Q_EMIT failed(tr("None of the missing files is in %1 or below. Copy them there, or "
                           "restore them, and try again.")
                            .arg(fromText(document.file().parent_path().string())));
        } else if (parts_.document.edit(sessions::relinked(document.session(), relinks),
                                        tr("Find moved files"))) {
          check();
        }
      });
}

void InputFindings::acceptChanged() {
  std::set<std::string> ids;
  for (const sessions::Finding& finding : findings_)
    if (finding.kind == FindingKind::kChanged) ids.insert(finding.case_id);
  tasks_.start(
      QStringLiteral("mend"),
      [session = parts_.document.session(), ids](const std::stop_token&) {
        std::vector<sessions::SessionCase> accepted;
        for (const std::string& id : ids)
          accepted.push_back(*sessions::acceptingInputs(session, id).findCase(id));
        return accepted;
      },
      [this](const std::vector<sessions::SessionCase>& accepted) {
        sessions::Session session = parts_.document.session();
        for (const sessions::SessionCase& session_case : accepted)
          session = sessions::withCase(session, session_case);
        if (parts_.document.edit(session, tr("Accept changed files"))) check();
      });
}

}  // namespace boresight::ui
