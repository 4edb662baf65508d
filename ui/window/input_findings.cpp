// SPDX-License-Identifier: Apache-2.0
#include "ui/window/input_findings.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <QMessageBox>

#include "sessions/session/case_dependencies.h"
#include "sessions/session/session_difference.h"
#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::FindingKind;

namespace {

/// Whether a check of their files has the same outcome.
bool sameFiles(const sessions::SessionCase* a, const sessions::SessionCase* b) {
  if (!a || !b) return a == b;
  const auto files_of = [](const sessions::SessionCase& session_case) {
    std::vector<std::array<std::string, 3>> files;
    sessions::forEachFile(session_case, [&files](const std::string& what, const auto& file,
                                                 const std::string& sha256) {
      files.push_back({what, file.string(), sha256});
    });
    return files;
  };
  return files_of(*a) == files_of(*b);
}

/// The session with these cases and their runs alone.
sessions::Session partOf(const sessions::Session& session, const std::set<std::string>& ids) {
  sessions::Session part;
  for (const auto& each : session.cases) {
    if (!ids.contains(each->id)) continue;
    part.cases.push_back(each);
    for (const sessions::RunRecord* run : session.runs.findAll(each->id)) part.runs.push_back(*run);
  }
  return part;
}

}  // namespace

InputFindings::InputFindings(WindowParts& parts, Banner& bar, QWidget& window)
    : QObject(&window), parts_(parts), bar_(bar), window_(window) {
  connect(&parts_.document, &Document::opened, this, &InputFindings::documentOpened);
  connect(&parts_.document, &Document::changed, this, &InputFindings::documentChanged);
  connect(&bar_, &Banner::actionRequested, this, &InputFindings::repair);
}

void InputFindings::documentOpened() {
  tasks_.cancel(checking_);
  tasks_.cancel(repairing_);
  asked_.clear();
  repairs_ = false;
  followed_ = parts_.document.session();
  findings_.clear();
  show();
  check(allIds());
}

/// A file that was found to be missing may have been replaced.
void InputFindings::documentChanged() {
  const sessions::Session& now = parts_.document.session();
  const sessions::SessionDifference difference = sessions::differenceOf(followed_, now);
  std::set<std::string> ids;
  for (const std::string& id : difference.cases)
    if (now.findCase(id) && !sameFiles(followed_.findCase(id), now.findCase(id))) ids.insert(id);
  followed_ = now;
  const auto of_removed = [&now](const sessions::Finding& finding) {
    return now.findCase(finding.case_id) == nullptr;
  };
  if (difference.list && std::erase_if(findings_, of_removed) > 0) show();
  if (!ids.empty()) check(ids);
}

std::set<std::string> InputFindings::allIds() const {
  std::set<std::string> ids;
  for (const auto& each : parts_.document.session().cases) ids.insert(each->id);
  return ids;
}

/// After the files of the case that is shown are read: the same thread does one after the other.
void InputFindings::check(const std::set<std::string>& ids) {
  asked_.insert(ids.begin(), ids.end());
  tasks_.cancel(checking_);
  waits_ = true;
  parts_.tasks.replace(
      waiting_, [](const std::stop_token&) { return true; }, [this](bool) { checkWhenRead(); },
      reportTo(this, &InputFindings::failed));
}

void InputFindings::checkWhenRead() {
  waits_ = false;
  tasks_.replace(
      checking_,
      [session = parts_.document.session(), ids = asked_](const std::stop_token& stop) {
        return sessions::checkInputs(partOf(session, ids), stop);
      },
      [this, ids = asked_](const std::vector<sessions::Finding>& findings) { take(ids, findings); },
      [this](const QString& message) {
        asked_.clear();
        repairs_ = false;
        Q_EMIT failed(message);
      });
}

void InputFindings::take(const std::set<std::string>& ids,
                         const std::vector<sessions::Finding>& findings) {
  const bool advised = !adviceFor(parts_.cases.caseId()).isEmpty();
  asked_.clear();
  std::erase_if(findings_,
                [&ids](const sessions::Finding& finding) { return ids.contains(finding.case_id); });
  findings_.insert(findings_.end(), findings.begin(), findings.end());
  show();
  if (advised && adviceFor(parts_.cases.caseId()).isEmpty()) parts_.cases.readAgain();
  if (std::exchange(repairs_, false)) repairFound();
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

/// The operator may have restored files since.
void InputFindings::repair() {
  repairs_ = true;
  check(allIds());
}

void InputFindings::repairFound() {
  if (has(FindingKind::kMissing)) return findMoved();
  if (!has(FindingKind::kChanged)) return;
  const CaseOpening seen = parts_.state.opening();
  const auto answer =
      QMessageBox::question(&window_, tr("Boresight"),
                            tr("Accept the changed files? Runs of the former files become stale."));
  if (answer == QMessageBox::Yes && seen == parts_.state.opening()) acceptChanged();
}

void InputFindings::findMoved() {
  tasks_.replace(
      repairing_,
      [session = parts_.document.session(), file = parts_.document.file()](
          const std::stop_token& stop) { return sessions::findMissing(session, file, stop); },
      [this](const std::vector<sessions::Relink>& relinks) {
        Document& document = parts_.document;
        if (relinks.empty())
          Q_EMIT failed(tr("None of the missing files is in %1 or below. Copy them there, or "
                           "restore them, and try again.")
                            .arg(fromText(document.file().parent_path().string())));
        else if (document.edit(sessions::relinked(document.session(), relinks),
                               tr("Find moved files")))
          check(allIds());  // of runs, too
      },
      reportTo(this, &InputFindings::failed));
}

void InputFindings::acceptChanged() {
  using Accepted = std::vector<std::pair<sessions::SessionCase, sessions::SessionCase>>;
  std::set<std::string> ids;
  for (const sessions::Finding& finding : findings_)
    if (finding.kind == FindingKind::kChanged) ids.insert(finding.case_id);
  tasks_.replace(
      repairing_,
      [session = parts_.document.session(), ids](const std::stop_token& stop) {
        Accepted accepted;
        for (const std::string& id : ids)
          if (const auto* before = stop.stop_requested() ? nullptr : session.findCase(id))
            accepted.emplace_back(*before, *sessions::acceptingInputs(session, id).findCase(id));
        return accepted;
      },
      [this](const Accepted& accepted) {
        sessions::Session session = parts_.document.session();
        for (const auto& [before, after] : accepted)
          session = sessions::withAccepted(session, before, after);
        if (!(session == parts_.document.session()))
          parts_.document.edit(session, tr("Accept changed files"));
      },
      reportTo(this, &InputFindings::failed));
}

}  // namespace boresight::ui
