// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/tint.h"

namespace boresight::ui {

QPalette tinted(const QPalette& base, const QColor& towards) {
  const QColor window = base.color(QPalette::Window);
  const auto mixed = [](int a, int b) { return (3 * a + b) / 4; };
  QPalette made = base;
  made.setColor(QPalette::Window,
                QColor(mixed(window.red(), towards.red()), mixed(window.green(), towards.green()),
                       mixed(window.blue(), towards.blue())));
  return made;
}

}  // namespace boresight::ui
