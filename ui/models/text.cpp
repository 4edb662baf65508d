// SPDX-License-Identifier: Apache-2.0
#include "ui/models/text.h"

#include <algorithm>
#include <cmath>

#include <QCoreApplication>

#include "sessions/text/text_table.h"

namespace boresight::ui {

QString numberText(double value, int decimals) {
  if (std::isnan(value)) return QString();
  return QString::number(value, 'f', decimals);  // never the locale's comma
}

std::optional<double> typedNumber(QString text) {
  bool is_number = false;
  const double number = text.replace(QLatin1Char(','), QLatin1Char('.')).toDouble(&is_number);
  return is_number && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

QString timeText(const std::string& utc) {
  return fromText(utc).replace(QLatin1Char('T'), QLatin1Char(' ')).remove(QLatin1Char('Z'));
}

QString probabilityCell(double probability) {
  return std::isnan(probability) ? QString() : fromText(sessions::probabilityPercent(probability));
}

double roundedUp(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (value <= factor * power * (1.0 + 1e-9)) return factor * power;
  return 10.0 * power;
}

QString htmlTable(const QVector<QStringList>& rows) {
  qsizetype columns = 0;
  for (const QStringList& row : rows) columns = std::max<qsizetype>(columns, row.size());
  QString html;
  for (const QStringList& row : rows) {
    html += QStringLiteral("<tr>");
    for (qsizetype i = 0; i < row.size(); ++i) {
      bool is_number = false;
      (void)row[static_cast<int>(i)].toDouble(&is_number);
      html += QStringLiteral("<td colspan='%1' align='%2'>%3&nbsp;&nbsp;</td>")
                  .arg(i + 1 == row.size() ? columns - i : 1)
                  .arg(is_number ? QStringLiteral("right") : QStringLiteral("left"))
                  .arg(row[static_cast<int>(i)]);
    }
    html += QStringLiteral("</tr>");
  }
  return QStringLiteral("<table cellspacing='0' cellpadding='1'>%1</table>").arg(html);
}

QString titledTable(const QString& title, const QVector<QStringList>& rows) {
  return rows.isEmpty() ? QString()
                        : QStringLiteral("<p><b>%1</b></p>").arg(title) + htmlTable(rows);
}

QStringList judgedRow(const QString& name, double value, const QString& unit,
                      const std::optional<double>& limit) {
  const auto tr = [](const char* text) { return QCoreApplication::translate("HtmlTable", text); };
  QStringList cells = {name, QString::number(value, 'f', 4), unit};
  if (limit)
    cells << (std::abs(value) <= *limit ? tr("within %1 %2") : tr("<b>beyond</b> %1 %2"))
                 .arg(QString::number(*limit, 'g', 4), unit);
  return cells;
}

}  // namespace boresight::ui
