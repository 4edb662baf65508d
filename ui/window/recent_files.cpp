// SPDX-License-Identifier: Apache-2.0
#include "ui/window/recent_files.h"

#include <QFileInfo>
#include <QSettings>

namespace boresight::ui {
namespace {

constexpr int kRecentFiles = 10;
constexpr const char* kKey = "recent";

}  // namespace

QStringList recentFiles() {
  QStringList files;
  for (const QString& file : QSettings().value(QLatin1String(kKey)).toStringList())
    if (QFileInfo::exists(file)) files << file;
  return files;
}

void noteRecentFile(const std::filesystem::path& file) {
  const QString name = QString::fromStdString(std::filesystem::absolute(file).string());
  QStringList files = recentFiles();
  files.removeAll(name);
  files.prepend(name);
  while (files.size() > kRecentFiles) files.removeLast();
  QSettings().setValue(QLatin1String(kKey), files);
}

}  // namespace boresight::ui
