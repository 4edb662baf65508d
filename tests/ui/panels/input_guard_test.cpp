// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/input_guard.h"

#include <gtest/gtest.h>

#include <QtWidgets>

namespace boresight::ui {
namespace {

/// The wheel gave a field the focus, and with it changed the value that was scrolled over.
TEST(InputGuard, WheelOverAField_NeitherChangesNorFocusesIt) {
  const InputGuard guard(nullptr);
  QWidget window;
  auto* column = new QVBoxLayout(&window);
  auto* other = new QLineEdit;
  auto* number = new QSpinBox;
  number->setValue(8);
  column->addWidget(other);
  column->addWidget(number);
  window.show();
  window.activateWindow();
  other->setFocus();
  EXPECT_EQ(number->focusPolicy(), Qt::StrongFocus);
  const QPointF place(number->rect().center());
  QWheelEvent event(place, number->mapToGlobal(place.toPoint()), {}, {0, -360}, Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(number, &event);
  EXPECT_EQ(number->value(), 8);
  EXPECT_FALSE(number->hasFocus());
}

}  // namespace
}  // namespace boresight::ui
