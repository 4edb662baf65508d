// SPDX-License-Identifier: Apache-2.0
#include "ui/style/theme.h"

#include "tests/ui/window_test.h"
#include "ui/plots/plots.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"
#include "ui/window/application.h"

namespace boresight::ui {
namespace {

double luminance(const QColor& color) {
  const auto linear = [](double value) {
    return value <= 0.03928 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) +
         0.0722 * linear(color.blueF());
}

double contrast(QRgb a, QRgb b) {
  const double first = luminance(QColor(a)) + 0.05;
  const double second = luminance(QColor(b)) + 0.05;
  return std::max(first, second) / std::min(first, second);
}

TEST(Theme, TextsAreReadableOnTheirGround) {
  for (const Theme& theme : {kLightTheme, kDarkTheme}) {
    EXPECT_GE(contrast(theme.text, theme.panel), 7.0);
    EXPECT_GE(contrast(theme.text2, theme.panel), 4.5);
    EXPECT_GE(contrast(theme.success_text, theme.success_tint), 4.5);
    EXPECT_GE(contrast(theme.failure_text, theme.failure_tint), 4.5);
    EXPECT_GE(contrast(theme.warning_text, theme.warning_tint), 4.5);
    EXPECT_GE(contrast(theme.accent, theme.accent_tint), 4.0) << "the chosen tab";
    EXPECT_GE(contrast(theme.on_accent, theme.accent), 4.5);
  }
}

TEST(Theme, StyleSheetKnowsEveryName) {
  QSet<QString> sheets;
  for (const ThemeName name : {ThemeName::kLight, ThemeName::kDark}) {
    applyTheme(*qApp, name);
    EXPECT_FALSE(qApp->styleSheet().isEmpty());
    EXPECT_FALSE(qApp->styleSheet().contains(QLatin1Char('@')));
    static const QRegularExpression kColor(QStringLiteral("#[0-9a-f]{6}"));
    sheets << qApp->styleSheet().remove(kColor);
  }
  EXPECT_EQ(sheets.size(), 1) << "themes differ in colours, not in sizes";
  qApp->setStyleSheet({});
}

TEST(Theme, ProgramBringsItsFontWithFiguresOfOneWidth) {
  applyTheme(*qApp, ThemeName::kLight);
  for (const bool bold : {false, true}) {
    QFont font = qApp->font();
    font.setBold(bold);
    EXPECT_EQ(QFontInfo(font).family(), QStringLiteral("Inter Tabular"));
    const QFontMetricsF metrics(font);
    for (const char* figure : {"0000", "1111", "4444", "7777"})
      EXPECT_NEAR(metrics.horizontalAdvance(QLatin1String(figure)),
                  metrics.horizontalAdvance(QStringLiteral("8888")), 0.5)
          << figure;
  }
  qApp->setStyleSheet({});
}

/// Those of Fusion are pictures in colours of another age, on the buttons too.
TEST(Theme, MessageBoxesHaveTheIconsOfTheProgram) {
  nameApplication(*qApp);
  const QMessageBox box(QMessageBox::Question, {}, QStringLiteral("Save?"),
                        QMessageBox::Save | QMessageBox::Cancel);
  const QImage shown = box.iconPixmap().toImage();
  const QImage own = iconOf(Icon::kHelp, &Theme::accent).pixmap(box.iconPixmap().size()).toImage();
  EXPECT_EQ(shown, own);
  EXPECT_TRUE(box.button(QMessageBox::Save)->icon().isNull());
  qApp->setStyle(QStringLiteral("fusion"));
}

class ThemeSwitchTest : public test::WindowTest {};

/// Icons in labels kept the colour of the start.
TEST_F(ThemeSwitchTest, IconsAndPlotsFollowAtOnceAndTheNextStartHasIt) {
  applyTheme(*qApp, ThemeName::kLight);
  auto* icon = window_.findChild<IconLabel*>();
  ASSERT_NE(icon, nullptr);
  icon->setIcon(Icon::kCube);
  DoublePlot plot({QStringLiteral("mm"), false}, {QStringLiteral("px"), false});
  plot.show();
  const QWidget* canvas = plot.canvas();
  const auto ink = [icon] {
    QImage picture(icon->size(), QImage::Format_ARGB32);
    picture.fill(Qt::transparent);
    icon->render(&picture, {}, {}, QWidget::RenderFlags());
    int sum = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x)
        if (qAlpha(picture.pixel(x, y)) > 200) sum = std::max(sum, qGray(picture.pixel(x, y)));
    return sum;
  };
  const auto ground = [canvas] { return canvas->palette().color(QPalette::Window).lightness(); };
  EXPECT_LT(ink(), 100);
  EXPECT_GT(ground(), 200);
  find<QToolButton>("switchTheme").click();
  EXPECT_GT(ink(), 150);
  EXPECT_TRUE(QTest::qWaitFor([&] { return ground() < 100; }));
  EXPECT_EQ(themeName(), ThemeName::kDark);
  EXPECT_EQ(rememberedTheme(), ThemeName::kDark);
  find<QToolButton>("switchTheme").click();
  EXPECT_EQ(rememberedTheme(), ThemeName::kLight);
  qApp->setStyleSheet({});
}

}  // namespace
}  // namespace boresight::ui
