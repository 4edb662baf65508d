// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

namespace boresight::ui {

class MainWindow;

/// The share of the window, 0 .. 1, that shows the image: its part inside the view that no other
/// widget covers.
double imageShare(MainWindow& window);

}  // namespace boresight::ui
