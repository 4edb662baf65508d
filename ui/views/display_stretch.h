// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <QImage>
#include <QString>

#include "sessions/io/image_file.h"

namespace boresight::ui {

/// The share of the samples that an automatic stretch makes black, and white.
inline constexpr double kClippedShare = 0.005;

/// Levels between which all but the darkest and the brightest samples lie; of an even image some
/// that can be told apart.
sessions::GrayLevels automaticLevels(const sessions::ImageSamples& samples);

/// All that the samples' bits can say.
sessions::GrayLevels fullLevels(const sessions::ImageSamples& samples);

/// The file's own value at a pixel inside: whole numbers as they are, others with six digits.
QString sampleText(const sessions::ImageSamples& samples, int x, int y);

/// For the eye only.
QImage stretched(const sessions::ImageSamples& samples, const sessions::GrayLevels& levels);

}  // namespace boresight::ui
