// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <QString>

class QWidget;

namespace boresight::ui {

/// Waits until `holds`, and handles events meanwhile, but none of the operator. What takes longer
/// than two seconds is reported in a box, whose button `leave` ends the wait. Returns whether it
/// holds; false: the operator has ended the wait.
bool waitOrLeave(QWidget* parent, const QString& text, const QString& leave,
                 const std::function<bool()>& holds);

}  // namespace boresight::ui
