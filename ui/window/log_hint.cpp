// SPDX-License-Identifier: Apache-2.0
#include "ui/window/log_hint.h"

#include <QObject>

#include "sessions/log/program_log.h"

namespace boresight::ui {

QString logHint() {
  const std::filesystem::path file = sessions::logFile();
  return file.empty() ? QString()
                      : QObject::tr("Log: %1").arg(QString::fromStdString(file.string()));
}

void noteInLog(QMessageBox& box) {
  sessions::logEvent(sessions::LogLevel::kError, [&box] { return box.text().toStdString(); });
  const QString hint = logHint();
  if (hint.isEmpty()) return;
  const QString text = box.informativeText();
  box.setInformativeText(text.isEmpty() ? hint : text + QStringLiteral("\n\n") + hint);
}

}  // namespace boresight::ui
