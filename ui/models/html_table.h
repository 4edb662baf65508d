// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QStringList>
#include <QVector>

namespace boresight::ui {

/// An HTML table; its cells are HTML. Numbers are aligned to the right, and the last cell of a row
/// that is shorter than others spans the rest.
QString htmlTable(const QVector<QStringList>& rows);

/// The same under a title; empty without rows.
QString titledTable(const QString& title, const QVector<QStringList>& rows);

/// Name, value with four decimals, unit and, where there is a limit, whether the value is within.
QStringList judgedRow(const QString& name, double value, const QString& unit,
                      const std::optional<double>& limit = std::nullopt);

}  // namespace boresight::ui
