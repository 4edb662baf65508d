// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/wait_box.h"

#include <QtWidgets>

#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kLook_ms = 20;     ///< between looks whether it holds
constexpr int kQuiet_ms = 2000;  ///< without a word

}  // namespace

bool waitOrLeave(QWidget* parent, const QString& text, const QString& leave,
                 const std::function<bool()>& holds) {
  QElapsedTimer waited;
  waited.start();
  QTimer look;
  look.start(kLook_ms);
  QEventLoop loop;
  QObject::connect(&look, &QTimer::timeout, &loop, [&] {
    if (holds() || waited.elapsed() > kQuiet_ms) loop.quit();
  });
  if (!holds()) loop.exec(QEventLoop::ExcludeUserInputEvents);
  if (holds()) return true;
  QMessageBox box(QMessageBox::Information, QObject::tr("Boresight"), text, QMessageBox::NoButton,
                  parent);
  named(box.addButton(leave, QMessageBox::RejectRole), "leave");
  QObject::connect(&look, &QTimer::timeout, &box, [&] {
    if (holds()) box.accept();
  });
  box.exec();
  return holds();
}

}  // namespace boresight::ui
