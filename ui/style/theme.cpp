// SPDX-License-Identifier: Apache-2.0
#include "ui/style/theme.h"

#include <utility>

#include <QtWidgets>

static void loadStyleResources() { Q_INIT_RESOURCE(style); }  // of a static library

namespace boresight::ui {
namespace {

constexpr const char* kThemeKey = "theme";
ThemeName applied = ThemeName::kLight;

QString styleSheet(const Theme& colors) {
  QFile file(QStringLiteral(":/style/boresight.qss"));
  if (!file.open(QIODevice::ReadOnly)) return {};
  QString sheet = QString::fromUtf8(file.readAll());
  for (const ThemeColor& color : kThemeColors)
    sheet.replace(QStringLiteral("@%1@").arg(QLatin1String(color.name)),
                  QColor(colors.*color.member).name());
  return sheet;
}

QPalette paletteOf(const Theme& colors) {
  QPalette palette(QColor(colors.panel), QColor(colors.window));  // with the shades of frames
  const auto set = [&palette](QPalette::ColorRole role, QRgb color) {
    palette.setColor(role, QColor(color));
  };
  set(QPalette::Base, colors.panel);
  set(QPalette::AlternateBase, colors.alt);
  set(QPalette::ToolTipBase, colors.panel);
  set(QPalette::Link, colors.accent);
  set(QPalette::Highlight, colors.accent);
  set(QPalette::HighlightedText, colors.on_accent);
  set(QPalette::PlaceholderText, colors.text3);
  for (const QPalette::ColorRole role :
       {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText}) {
    set(role, colors.text);
    palette.setColor(QPalette::Disabled, role, QColor(colors.text3));
  }
  palette.setColor(QPalette::Disabled, QPalette::Link, QColor(colors.text3));
  return palette;
}

/// Figures have one width. Without these files fonts of the system are used.
void loadFonts() {
  static bool loaded = false;
  if (std::exchange(loaded, true)) return;
  for (const char* file : {"InterTabular-Regular.otf", "InterTabular-Bold.otf"})
    QFontDatabase::addApplicationFont(QStringLiteral(":/style/") + QLatin1String(file));
}

QFont typeface() {
  loadFonts();
  QFont font = QApplication::font();
  const QStringList known = QFontDatabase().families();
  for (const char* family : kFontFamilies)
    if (known.contains(QLatin1String(family))) {
      font.setFamily(QLatin1String(family));
      break;
    }
  font.setPointSizeF(kTextSize);
  return font;
}

}  // namespace

const Theme& theme() { return applied == ThemeName::kDark ? kDarkTheme : kLightTheme; }

ThemeName themeName() { return applied; }

void applyTheme(QApplication& application, ThemeName name) {
  applied = name;
  loadStyleResources();
  QApplication::setPalette(paletteOf(theme()));
  QApplication::setFont(typeface());
  application.setStyleSheet(styleSheet(theme()));
}

ThemeName rememberedTheme() {
  const QString name = QSettings().value(QLatin1String(kThemeKey)).toString();
  if (name == QLatin1String("dark")) return ThemeName::kDark;
  if (name == QLatin1String("light")) return ThemeName::kLight;
  const bool dark = QApplication::palette().color(QPalette::Base).lightness() < 128;
  return dark ? ThemeName::kDark : ThemeName::kLight;
}

void rememberTheme(ThemeName name) {
  QSettings().setValue(QLatin1String(kThemeKey),
                       name == ThemeName::kDark ? QStringLiteral("dark") : QStringLiteral("light"));
}

}  // namespace boresight::ui
