// SPDX-License-Identifier: Apache-2.0
// Figures and tables as texts.
#pragma once

#include <optional>
#include <string>

#include <QStringList>
#include <QVector>

namespace boresight::ui {

/// For table cells: a fixed number of decimals, always with a dot; empty for NaN.
QString numberText(double value, int decimals);

/// A finite number as an operator types it, with a point or a comma before the decimals, in any
/// locale; empty for other texts.
std::optional<double> typedNumber(QString text);

/// For table cells: "98.7 %", "> 99.9 %"; empty for NaN.
QString probabilityCell(double probability);

/// The least of 1, 2 or 5 times a power of ten not below the value (up to rounding), for the end of
/// an axis. 1 for values that are not above zero.
double roundedUp(double value);

/// A core or session text in UTF-8.
inline QString fromText(const std::string& text) { return QString::fromStdString(text); }

/// "2026-11-28 02:11:45" of a time in ISO 8601, UTC.
QString timeText(const std::string& utc);

/// An HTML table; its cells are HTML. Numbers are aligned to the right, and the last cell of a row
/// that is shorter than others spans the rest.
QString htmlTable(const QVector<QStringList>& rows);

/// The same under a title; empty without rows.
QString titledTable(const QString& title, const QVector<QStringList>& rows);

/// Name, value with four decimals, unit and, where there is a limit, whether the value is within.
QStringList judgedRow(const QString& name, double value, const QString& unit,
                      const std::optional<double>& limit = std::nullopt);

}  // namespace boresight::ui
