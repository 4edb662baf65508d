// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QIcon>
#include <QSize>

#include "ui/style/theme.h"

namespace boresight::ui {

/// Monochrome icons on a grid of 16 x 16, drawn as lines.
enum class Icon {
  kNone,
  kCheck,
  kCross,
  kWarning,
  kInfo,
  kClock,
  kRing,
  kDot,
  kRun,
  kStop,
  kStepStage,
  kStepIteration,
  kReset,
  kSearch,
  kMove,
  kMask,
  kPencil,
  kShield,
  kPlus,
  kFilter,
  kFolder,
  kTrash,
  kImage,
  kCamera,
  kCube,
  kTarget,
  kTheme,
  kHelp,
  kFlag,
  kNext,
  kSidePane,
  kFit,
  kOneToOne,
  kRuler,
  kEye,
  kSwipe,
  kLayers,
  kSideBySide,
  kAlgorithm,
  kFloat,
};

/// Size of an icon next to a text, with room between the two.
inline constexpr QSize kButtonIcon(kIcon + 6, kIcon);

/// An icon in a colour of the theme in use when it is drawn; disabled: the colour of hints.
QIcon iconOf(Icon icon, QRgb Theme::*color = &Theme::text);
/// The icon of a picture in a list; it is not tinted where its row is selected.
QIcon pictureIcon(const QImage& picture);
/// An icon for the overlay on the image, which is dark in every theme.
QIcon overlayIcon(Icon icon);

/// Draws an icon in a square, in one colour.
void paintIcon(QPainter& painter, const QRectF& place, Icon icon, const QColor& color);

}  // namespace boresight::ui
