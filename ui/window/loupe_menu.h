// SPDX-License-Identifier: Apache-2.0
#pragma once

class QMenu;

namespace boresight::ui {

class ImageAnnotation;

/// Adds how annotating on the image looks and behaves: snapping, the loupe and its magnification,
/// the magnification of residuals.
void addLoupeActions(QMenu& menu, ImageAnnotation& annotation);

}  // namespace boresight::ui
