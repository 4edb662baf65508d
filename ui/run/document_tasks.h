// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <QObject>
#include <QString>

#include "ui/run/task_runner.h"

namespace boresight::ui {

class Document;

/// What the operator loses with a result that cannot be used: "The new camera of bc-000004", and
/// the way to have it again, in the session that it belongs to: "choose cam.json for bc-000004
/// again".
struct ResultName {
  QString what;
  QString again;
};

/// Tasks whose results belong to the session, or to a case of it, that is open when they begin: a
/// result, or a failure, of a session that is left is dropped, and the report says how to have it
/// again. A session whose edits are recovered or declined, or whose file is read again, is not
/// left. Arguments are those of TaskRunner.
class DocumentTasks : public QObject {
  Q_OBJECT

 public:
  DocumentTasks(const Document& document, TaskRunner& tasks);

  template <class Make, class Done, FailureReceiver Failed>
  void ofDocument(const ResultName& name, Make make, Done done, Failed failed) {
    tasks_.queue(std::move(make), ifHeld({}, name, std::move(done)),
                 ifHeld({}, name, std::move(failed)));
  }
  /// The result is also dropped where the case has been removed.
  template <class Make, class Done, FailureReceiver Failed>
  void ofCase(const TaskKind& kind, const std::string& id, const ResultName& name, Make make,
              Done done, Failed failed) {
    tasks_.replace(kind, std::move(make), ifHeld(id, name, std::move(done)),
                   ifHeld({}, name, std::move(failed)));
  }

 Q_SIGNALS:
  /// A result was dropped; one sentence.
  void failed(const QString& message);

 private:
  /// The session that was open when a task began.
  struct Opened {
    int openings;
    QString name;  ///< empty: none was open
  };

  /// Calls `take` while the session that is open now is open, and has the case (if not empty).
  template <class Take>
  auto ifHeld(const std::string& id, const ResultName& name, Take take) {
    return [this, id, name, begun = opened(), take = std::move(take)](auto&& value) {
      if (holds(begun, id, name)) take(std::forward<decltype(value)>(value));
    };
  }
  Opened opened() const;
  bool holds(const Opened& begun, const std::string& id, const ResultName& name);

  const Document& document_;
  TaskRunner& tasks_;
};

}  // namespace boresight::ui
