// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/input_guard.h"

#include <QtWidgets>

namespace boresight::ui {
namespace {

/// Fields whose value the wheel would change.
bool isField(const QObject* object) {
  return qobject_cast<const QAbstractSpinBox*>(object) || qobject_cast<const QComboBox*>(object) ||
         (qobject_cast<const QSlider*>(object));
}

bool isUndo(const QKeyEvent& key) {
  return key.matches(QKeySequence::Undo) || key.matches(QKeySequence::Redo);
}

/// A comma is a point. Spin boxes take it for a separator of thousands: 0,5 would be 5.
class CommaIsPoint final : public QValidator {
 public:
  explicit CommaIsPoint(QLineEdit& edit) : QValidator(&edit), inner_(*edit.validator()) {}

  State validate(QString& text, int& cursor) const override {
    return inner_.validate(text.replace(QLatin1Char(','), QLatin1Char('.')), cursor);
  }
  void fixup(QString& text) const override { inner_.fixup(text); }

 private:
  const QValidator& inner_;  ///< the spin box' own
};

void readCommaAsPoint(const QObject& field) {
  if (!qobject_cast<const QSpinBox*>(&field) && !qobject_cast<const QDoubleSpinBox*>(&field))
    return;
  auto* edit = field.findChild<QLineEdit*>();
  if (edit && edit->validator() && !dynamic_cast<const CommaIsPoint*>(edit->validator()))
    edit->setValidator(new CommaIsPoint(*edit));
}

}  // namespace

InputGuard::InputGuard(QObject* parent) : QObject(parent) { qApp->installEventFilter(this); }

bool InputGuard::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Wheel &&
      (qobject_cast<const QTabBar*>(watched) ||
       (isField(watched) && !static_cast<QWidget*>(watched)->hasFocus()))) {
    event->ignore();  // what lies below scrolls
    return true;
  }
  // The wheel would give the field the focus, and with it the value and the keys. Not when it is
  // polished: some are before there is a guard.
  if (event->type() == QEvent::Show && isField(watched)) {
    auto* field = static_cast<QWidget*>(watched);
    if (field->focusPolicy() == Qt::WheelFocus) field->setFocusPolicy(Qt::StrongFocus);
    readCommaAsPoint(*watched);
  }
  if (event->type() == QEvent::ShortcutOverride && isUndo(*static_cast<QKeyEvent*>(event))) {
    event->ignore();  // so that the shortcut holds
    return true;
  }
  return QObject::eventFilter(watched, event);
}

}  // namespace boresight::ui
