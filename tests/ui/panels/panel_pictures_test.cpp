// SPDX-License-Identifier: Apache-2.0
// Pictures of the panels for people to look at: BORESIGHT_PICTURES names the folder; with
// QT_SCALE_FACTOR they come larger.
#include <functional>

#include <gtest/gtest.h>
#include <QApplication>
#include <QDir>
#include <QPixmap>
#include <QStyle>
#include <QStyleFactory>

#include "tests/support/example_run.h"
#include "ui/panels/iterations_panel.h"

namespace boresight::ui {
namespace {

QPalette darkPalette() {
  QPalette dark;
  dark.setColor(QPalette::Window, QColor(45, 45, 48));
  dark.setColor(QPalette::WindowText, Qt::white);
  dark.setColor(QPalette::Base, QColor(30, 30, 32));
  dark.setColor(QPalette::AlternateBase, QColor(40, 40, 43));
  dark.setColor(QPalette::Text, Qt::white);
  dark.setColor(QPalette::Button, QColor(58, 58, 62));
  dark.setColor(QPalette::ButtonText, Qt::white);
  dark.setColor(QPalette::ToolTipBase, QColor(58, 58, 62));
  dark.setColor(QPalette::ToolTipText, Qt::white);
  dark.setColor(QPalette::Highlight, QColor(42, 110, 170));
  dark.setColor(QPalette::HighlightedText, Qt::white);
  dark.setColor(QPalette::Link, QColor(86, 180, 233));
  dark.setColor(QPalette::PlaceholderText, QColor(160, 160, 160));
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    dark.setColor(QPalette::Disabled, role, QColor(130, 130, 130));
  return dark;
}

class PanelPictures : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = qEnvironmentVariable("BORESIGHT_PICTURES");
    if (folder_.isEmpty()) GTEST_SKIP() << "BORESIGHT_PICTURES names no folder";
    QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
    light_ = QApplication::style()->standardPalette();
    view_.setSnapshot(test::exampleRun());
  }
  void TearDown() override {
    if (!folder_.isEmpty()) QApplication::setPalette(light_);
  }

  /// Draws a widget in both palettes.
  void picture(const QString& name, QWidget& widget, const QSize& size) {
    widget.resize(size);
    widget.show();
    for (const bool dark : {false, true}) {
      QApplication::setPalette(dark ? darkPalette() : light_);
      QApplication::processEvents();
      const QString file = QStringLiteral("%1-%2-%3.png")
                               .arg(name)
                               .arg(widget.devicePixelRatioF())
                               .arg(dark ? QStringLiteral("dark") : QStringLiteral("light"));
      EXPECT_TRUE(widget.grab().save(QDir(folder_).filePath(file)));
    }
  }

  QString folder_;
  QPalette light_;
  ViewState view_;
};

TEST_F(PanelPictures, Iterations) {
  IterationsPanel panel(view_);
  view_.setCursor({1, Stage::kMatch});
  picture(QStringLiteral("iterations"), panel, {1400, 300});
}

}  // namespace
}  // namespace boresight::ui
