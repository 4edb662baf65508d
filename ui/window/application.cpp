// SPDX-License-Identifier: Apache-2.0
#include "ui/window/application.h"

#include <QtWidgets>

#include "sessions/version.h"
#include "ui/scene/scene_canvas.h"

namespace boresight::ui {

namespace {

/// Fusion draws the frame of an empty box in a shade that a dark ground swallows.
class VisibleBoxes : public QProxyStyle {
 public:
  VisibleBoxes() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
    if (element != PE_IndicatorCheckBox) return;
    QColor frame = option->palette.color(QPalette::Text);
    frame.setAlpha(150);
    painter->save();
    painter->setPen(frame);
    painter->setBrush(Qt::NoBrush);
    painter->drawRect(option->rect.adjusted(0, 0, -1, -1));
    painter->restore();
  }
};

}  // namespace

void prepareApplication(bool without_display) {
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  QCoreApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
  QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
#endif
  prepareSceneSurface();
  if (!qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) return;
  qputenv("QT_QPA_PLATFORM", without_display ? "offscreen" : "xcb");
}

void nameApplication(QApplication& application) {
  QCoreApplication::setOrganizationName(QStringLiteral("Boresight"));
  QCoreApplication::setApplicationName(QStringLiteral("boresight"));
  QCoreApplication::setApplicationVersion(QString::fromUtf8(sessions::kVersion));
  // What is installed: the entry that docks and task bars know the window by, and its icon.
  QGuiApplication::setDesktopFileName(QStringLiteral("boresight"));
  QApplication::setWindowIcon(QIcon::fromTheme(QStringLiteral("boresight")));
  application.setStyle(new VisibleBoxes);
}

void useDarkColors(QApplication& application) {
  QPalette dark;
  const QColor ground(45, 46, 48);
  const QColor base(32, 33, 35);
  const QColor text(225, 226, 228);
  dark.setColor(QPalette::Window, ground);
  dark.setColor(QPalette::WindowText, text);
  dark.setColor(QPalette::Base, base);
  dark.setColor(QPalette::AlternateBase, QColor(40, 41, 44));
  dark.setColor(QPalette::ToolTipBase, ground);
  dark.setColor(QPalette::ToolTipText, text);
  dark.setColor(QPalette::Text, text);
  dark.setColor(QPalette::Button, ground);
  dark.setColor(QPalette::ButtonText, text);
  dark.setColor(QPalette::BrightText, QColor(255, 255, 255));
  dark.setColor(QPalette::Link, QColor(95, 165, 255));
  dark.setColor(QPalette::Highlight, QColor(60, 120, 215));
  dark.setColor(QPalette::HighlightedText, QColor(255, 255, 255));
  dark.setColor(QPalette::Light, QColor(70, 71, 74));
  dark.setColor(QPalette::Midlight, QColor(58, 59, 62));
  dark.setColor(QPalette::Mid, QColor(38, 39, 41));
  dark.setColor(QPalette::Dark, QColor(24, 25, 27));
  for (const QPalette::ColorRole role :
       {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::Link})
    dark.setColor(QPalette::Disabled, role, QColor(125, 126, 128));
  application.setPalette(dark);
}

}  // namespace boresight::ui
