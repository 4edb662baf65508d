// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QStringList>

class QWidget;

namespace boresight::test {

/// Faults of the layout of a window as it is now, a line each with the path of the widget:
/// widgets outside their parent, overlapping widgets of a layout, panels smaller than their
/// contents, and cut texts of labels, buttons, fields, tabs, heads and figures of tables.
/// Text cells and sentences that a tool tip repeats may be elided. Docks behind the tab of another
/// dock are not looked at.
QStringList layoutFaults(QWidget& window);

}  // namespace boresight::test
