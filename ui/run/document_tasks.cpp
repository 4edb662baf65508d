// SPDX-License-Identifier: Apache-2.0
#include "ui/run/document_tasks.h"

#include "ui/models/text.h"
#include "ui/state/document.h"

namespace boresight::ui {

DocumentTasks::DocumentTasks(const Document& document, TaskRunner& tasks)
    : document_(document), tasks_(tasks) {}

DocumentTasks::Opened DocumentTasks::opened() const {
  return {document_.openings(), fromText(document_.file().string())};
}

/// Whether a result can be used: its session is open, and has its case.
bool DocumentTasks::holds(const Opened& begun, const std::string& id, const ResultName& name) {
  if (begun.openings != document_.openings())
    Q_EMIT failed(begun.name.isEmpty()
                      ? tr("%1 was not used: another session was opened. To use it there, %2.")
                            .arg(name.what, name.again)
                      : tr("%1 was not used: it belongs to %2, which is not open any more. Open "
                           "that session and %3.")
                            .arg(name.what, begun.name, name.again));
  else if (!id.empty() && !document_.session().findCase(id))
    Q_EMIT failed(tr("%1 was not used: %2 was removed from the session. Undo that and %3.")
                      .arg(name.what, fromText(id), name.again));
  else
    return true;
  return false;
}

}  // namespace boresight::ui
