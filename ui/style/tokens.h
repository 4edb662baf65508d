// SPDX-License-Identifier: Apache-2.0
// The look of the program as constants: colours, lines on the
// image, sizes. The style sheet (ui/style/boresight.qss) names the colours as @name@ and takes them
// from here.
#pragma once

#include <array>
#include <iterator>

#include <QRgb>

namespace boresight::ui {

/// Colours of one theme, 0xRRGGBB.
struct Theme {
  QRgb window;       ///< ground of the window
  QRgb panel;        ///< ground of panels and bars
  QRgb alt;          ///< ground of panel heads and table heads
  QRgb line;         ///< separators
  QRgb line_strong;  ///< borders of fields and buttons
  QRgb text;
  QRgb text2;   ///< captions, units
  QRgb text3;   ///< key hints, disabled
  QRgb accent;  ///< primary action, chosen tab and row
  QRgb accent_tint;
  QRgb on_accent;  ///< text on the accent
  QRgb success;
  QRgb success_tint;
  QRgb success_text;
  QRgb failure;
  QRgb failure_tint;
  QRgb failure_text;
  QRgb warning;
  QRgb warning_tint;
  QRgb warning_text;
  QRgb canvas;        ///< round the image
  QRgb overlay;       ///< tool strip, legend, chips
  QRgb overlay_line;  ///< their borders
};

/// A colour in both themes, with its name in the style sheet.
struct ThemeColor {
  const char* name;
  QRgb Theme::*member;
  QRgb light;
  QRgb dark;
};
inline constexpr ThemeColor kThemeColors[] = {
    {"window", &Theme::window, 0xF1F2F4, 0x1E2023},
    {"panel", &Theme::panel, 0xFFFFFF, 0x26282C},
    {"alt", &Theme::alt, 0xF7F8F9, 0x2C2F33},
    {"line", &Theme::line, 0xD7DBE0, 0x3A3E44},
    {"lineStrong", &Theme::line_strong, 0xB9C0C8, 0x535960},
    {"text", &Theme::text, 0x1B1F24, 0xE8EAED},
    {"text2", &Theme::text2, 0x555E68, 0xAEB5BD},
    {"text3", &Theme::text3, 0x7A838D, 0x8B939C},
    {"accent", &Theme::accent, 0x0B62C4, 0x4A9EF2},
    {"accentTint", &Theme::accent_tint, 0xE5EFFA, 0x1F3650},
    {"onAccent", &Theme::on_accent, 0xFFFFFF, 0x0E1620},
    {"success", &Theme::success, 0x009E73, 0x1FBF92},
    {"successTint", &Theme::success_tint, 0xE3F4EE, 0x17362D},
    {"successText", &Theme::success_text, 0x00684C, 0x5FD9B4},
    {"failure", &Theme::failure, 0xD55E00, 0xF0813A},
    {"failureTint", &Theme::failure_tint, 0xFCEBDD, 0x412A1A},
    {"failureText", &Theme::failure_text, 0xA64900, 0xFFB380},
    {"warning", &Theme::warning, 0xE69F00, 0xE69F00},
    {"warningTint", &Theme::warning_tint, 0xFDF3DC, 0x3D3116},
    {"warningText", &Theme::warning_text, 0x7A5200, 0xF5CC70},
    {"canvas", &Theme::canvas, 0x292B2E, 0x141517},
    {"overlay", &Theme::overlay, 0x1C1D20, 0x1C1D20},
    {"overlayLine", &Theme::overlay_line, 0x45494F, 0x45494F},
};

static_assert(std::size(kThemeColors) * sizeof(QRgb) == sizeof(Theme),
              "each colour of a theme is listed once");

constexpr Theme themeOf(QRgb ThemeColor::*column) {
  Theme theme = {};
  for (const ThemeColor& color : kThemeColors) theme.*color.member = color.*column;
  return theme;
}
inline constexpr Theme kLightTheme = themeOf(&ThemeColor::light);
inline constexpr Theme kDarkTheme = themeOf(&ThemeColor::dark);

/// Badges of a case's state, each with its own icon. The same in both themes.
inline constexpr QRgb kBadgeNew = 0x8A929B;
inline constexpr QRgb kBadgeRunning = 0x0B62C4;
inline constexpr QRgb kBadgeConverged = 0x0072B2;
inline constexpr QRgb kBadgeFailed = 0xD55E00;
inline constexpr QRgb kBadgeAnnotated = 0x7B5EA7;
inline constexpr QRgb kBadgeValidated = 0x009E73;

/// Text on the overlay's ground, which is dark in both themes.
inline constexpr QRgb kOverlayText = 0xE8EAED;

/// A line on the image: of constant width on the screen at any zoom, above a dark halo of the same
/// pattern. Lengths in screen pixels at 100 %.
struct LineToken {
  QRgb color;
  double width_px;
  double dash_px;  ///< 0: solid. Dots: 0 with a gap.
  double gap_px;   ///< from the end of a dash to the next; between centres of dots
  bool round_cap;
  QRgb halo = 0x000000;
  double halo_px = 1.8;  ///< wider than the line, both sides together
  double halo_opacity = 0.55;
};

inline constexpr LineToken kSeedLine = {0xE69F00, 1.6, 9, 5, false};
inline constexpr LineToken kPoseLine = {0x56B4E9, 1.7, 0, 0, true};
inline constexpr LineToken kRejectedLine = {0xFF5CC8, 2.2, 0, 5, true};
inline constexpr LineToken kTruthLine = {0xFFFFFF, 1.0, 0, 0, true};
inline constexpr LineToken kInlierLine = {0x56E0C8, 1.7, 0, 0, true, 0x000000, 1.9};
inline constexpr LineToken kOutlierLine = {0xFFB37A, 1.7, 5, 3, true, 0x000000, 1.9};
inline constexpr LineToken kTemplateLine = {0xFFFFFF, 2.0, 0, 0, false, 0x000000, 2.0};
inline constexpr LineToken kWindowLine = {0xFFFFFF, 1.2, 3, 3, false, 0x000000, 2.0};
inline constexpr LineToken kMarkLine = {0x0072B2, 2.4, 0, 0, false, 0xFFFFFF, 2.6, 1.0};
inline constexpr LineToken kBadMarkLine = {0xD55E00, 2.4, 4, 3, false, 0xFFFFFF, 2.6, 1.0};
inline constexpr LineToken kUnfinishedMarkLine = {0xE69F00, 2.4, 0, 0, false, 0xFFFFFF, 2.6, 1.0};
inline constexpr double kMarkRadius_px = 9;

/// Width factor of the pose's line below the truth's, which would otherwise hide it.
inline constexpr double kPoseUnderTruthFactor = 1.5;

/// Colours of poses in the 3D scene, whose background is light.
inline constexpr QRgb kSceneSeed = 0xB87900;
inline constexpr QRgb kScenePose = 0x0072B2;
inline constexpr QRgb kSceneRejected = 0xC21E8E;

/// Widths of the frames around the onboard run and the ground run.
inline constexpr int kOnboardFrame_px = 6;
inline constexpr int kGroundFrame_px = 4;

// Sizes in device-independent pixels.
inline constexpr int kPanelMargin = 12;  ///< left and right in all panels
inline constexpr int kBlockGap = 8;      ///< between the blocks of a panel; between groups twice
inline constexpr int kTopBarHeight = 40;
inline constexpr int kVerdictHeight = 48;
inline constexpr int kPanelHeadHeight = 32;
inline constexpr int kJobStripHeight = 28;
inline constexpr int kDrawerHandleHeight = 32;
inline constexpr int kButtonHeight = 32;
inline constexpr int kSmallButtonHeight = 28;
inline constexpr int kIcon = 16;
inline constexpr int kToolIcon = 18;
inline constexpr double kIconStroke = 1.4;
inline constexpr int kRadius = 4;
inline constexpr int kBadge = 20;

/// Sizes that depend on the width of the window.
struct Measures {
  int strip_width;
  int strip_thumbnail;
  int run_side;  ///< side pane of each workspace; 0: closed at first
  int diagnose_side;
  int review_side;
  int queue_width;
};
inline constexpr int kWideWindow = 1600;  ///< from this width on the wide measures apply
inline constexpr Measures kWide = {96, 64, 416, 616, 464, 304};
inline constexpr Measures kNarrow = {64, 48, 360, 360, 392, 64};

/// Fonts, the first one available; sizes in points. The program includes its own.
inline constexpr std::array<const char*, 4> kFontFamilies = {"Inter Tabular", "Inter", "Noto Sans",
                                                             "DejaVu Sans"};
inline constexpr double kTextSize = 10;
inline constexpr double kCaptionSize = 9;
inline constexpr double kHeadlineSize = 13.5;

}  // namespace boresight::ui
