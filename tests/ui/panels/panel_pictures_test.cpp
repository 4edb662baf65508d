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
#include <QTreeView>
#include <QtTest/QTest>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_run.h"
#include "ui/panels/cases_panel.h"
#include "ui/panels/configuration_panel.h"
#include "ui/panels/input_sheet_panel.h"
#include "ui/panels/iterations_panel.h"
#include "ui/panels/match_inspector_panel.h"
#include "ui/panels/score_map_view.h"

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

/// What the program says of the example's inputs.
sessions::InputSheet exampleSheet() {
  const sessions::Session session =
      sessions::makeSession(test::exampleFolder() / "dataset.json", {});
  return sessions::inputSheet(*sessions::loadCase(*session.cases.front()));
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

TEST_F(PanelPictures, Matches) {
  MatchInspectorPanel panel(view_);
  view_.setCursor({0, Stage::kFinished});
  view_.selectTemplate(5);
  auto* map = panel.findChild<ScoreMapView*>();
  ASSERT_TRUE(QTest::qWaitFor([map] { return map->map() != nullptr; }, 20000));
  picture(QStringLiteral("matches"), panel, {1400, 420});
}

TEST_F(PanelPictures, Refinement) {
  MatchInspectorPanel panel(view_);
  picture(QStringLiteral("refinement"), panel, {1400, 300});
}

TEST_F(PanelPictures, Configuration) {
  ConfigurationPanel panel(view_);
  LocalizerOptions options;
  options.loop.max_iterations = 7;
  options.loop.inlier_threshold_px = 4.0;
  options.refinement.enabled = false;
  panel.setOptions(QStringLiteral("default"), options);
  auto* tree = panel.findChild<QTreeView*>();
  const QModelIndex branch = tree->model()->index(4, 0);
  tree->setCurrentIndex(tree->model()->index(0, 0, branch));
  picture(QStringLiteral("configuration"), panel, {760, 640});
}

TEST_F(PanelPictures, Inputs) {
  InputSheetPanel panel;
  panel.setSheet(exampleSheet());
  picture(QStringLiteral("inputs"), panel, {640, 520});
}

TEST_F(PanelPictures, Cases) {
  CasesPanel panel;
  const test::ExampleCase example("os");
  const QImage image(example.image.pixels.data(), example.image.width, example.image.height,
                     example.image.width, QImage::Format_Grayscale8);
  std::vector<CaseRow> rows(kCaseStateCount);
  for (int i = 0; i < kCaseStateCount; ++i) {
    CaseRow& row = rows[static_cast<std::size_t>(i)];
    row.id = QStringLiteral("os-00%1").arg(i);
    row.station = QStringLiteral("os");
    row.state = static_cast<CaseState>(i);
    row.thumbnail = image.scaled(64, 64, Qt::KeepAspectRatio, Qt::SmoothTransformation);
  }
  rows[2].normal_mm = 0.031;
  rows[2].lateral_mm = 0.104;
  rows[2].rotation_deg = 0.021;
  panel.setRows(rows);
  panel.setCurrent(rows[2].id);
  picture(QStringLiteral("cases"), panel, {520, 480});
}

}  // namespace
}  // namespace boresight::ui
