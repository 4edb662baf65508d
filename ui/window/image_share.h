// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

namespace boresight::ui {

class MainWindow;

/// The part of the window that shows the image, 0 .. 1: of the image as it lies in its view, what
/// neither the view's border nor another widget above the view cuts off.
double imageShare(MainWindow& window);

}  // namespace boresight::ui
