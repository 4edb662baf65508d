// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

namespace boresight::ui {

class MainWindow;

/// The share of the window that shows the image, 0 .. 1: the part of the image that is inside its
/// view and not covered by another widget.
double imageShare(MainWindow& window);

}  // namespace boresight::ui
