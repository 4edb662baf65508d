// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <QtWidgets>

#include "tests/support/temporary_folder.h"

namespace boresight::test {

/// Answers modal dialogs of a class during its lifetime.
template <class Dialog>
class ModalAnswer {
 public:
  explicit ModalAnswer(std::function<void(Dialog&)> answer) {
    timer_.callOnTimeout([answer = std::move(answer)] {
      if (auto* dialog = qobject_cast<Dialog*>(QApplication::activeModalWidget())) answer(*dialog);
    });
    timer_.start(10);
  }

 private:
  QTimer timer_;
};

/// Replaces the folder of sessions without a name by one of its own: tests run side by side.
class OwnDataFolder {
 public:
  OwnDataFolder() {
    QStandardPaths::setTestModeEnabled(false);
    qputenv("XDG_DATA_HOME", QByteArray::fromStdString(data_.path().string()));
  }
  ~OwnDataFolder() {
    qunsetenv("XDG_DATA_HOME");
    QStandardPaths::setTestModeEnabled(true);
  }

 private:
  TemporaryFolder data_;
};

}  // namespace boresight::test
