// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QMessageBox>
#include <QString>

namespace boresight::ui {

/// "Log: FILE"; empty when the program keeps none.
QString logHint();

/// Writes the text of a box about trouble to the log, and the log's place below the text.
void noteInLog(QMessageBox& box);

}  // namespace boresight::ui
