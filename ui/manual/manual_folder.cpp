// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_folder.h"

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QRegularExpression>

namespace boresight::ui {

QString manualFolder() {
  QDir folder(QCoreApplication::applicationDirPath());
  do {
    const QString place = folder.filePath(QStringLiteral("share/boresight/manual"));
    if (QFile::exists(place + QStringLiteral("/index.md"))) return place;
  } while (folder.cdUp());
  return {};
}

QString manualText(const QString& file) {
  QFile opened(file);
  if (!opened.open(QIODevice::ReadOnly)) return {};
  return QString::fromUtf8(opened.readAll());
}

std::vector<ManualPage> manualPages(const QString& folder) {
  const QString index = manualText(folder + QStringLiteral("/index.md"));
  if (index.isEmpty()) return {};
  std::vector<ManualPage> pages = {
      {{}, QCoreApplication::translate("ManualWindow", "Contents"), QStringLiteral("index.md")}};
  static const QRegularExpression kEntry(
      QStringLiteral("^[-*] \\[([^\\]]+)\\]\\(([A-Za-z0-9_]+\\.md)\\)"));
  QString chapter;
  for (const QString& line : index.split(QLatin1Char('\n'))) {
    if (line.startsWith(QLatin1String("## "))) chapter = line.mid(3).trimmed();
    const QRegularExpressionMatch match = kEntry.match(line);
    if (match.hasMatch()) pages.push_back({chapter, match.captured(1), match.captured(2)});
  }
  return pages;
}

QString headingAnchor(const QString& heading) {
  QString anchor;
  for (const QChar c : heading.toLower()) {
    if (c.isLetterOrNumber() || c == QLatin1Char('_') || c == QLatin1Char('-')) anchor += c;
    if (c == QLatin1Char(' ')) anchor += QLatin1Char('-');
  }
  return anchor;
}

}  // namespace boresight::ui
