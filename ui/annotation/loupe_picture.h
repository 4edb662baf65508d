// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QImage>

#include "sessions/io/image_file.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// A small piece of an image as a loupe shows it: every screen pixel of `size` has the gray of the
/// image pixel that its centre lies on, stretched between the darkest and the brightest shown, a
/// few clipped. Outside the image it is dark. `transform` is in coordinates of which
/// `device_pixel_ratio` screen pixels make one. For the eye only.
QImage loupePicture(const sessions::ImageSamples& samples, const ViewTransform& transform,
                    const QSize& size, double device_pixel_ratio);

/// The 8-bit values of an image as samples, for images whose file has not been read.
sessions::ImageSamples samplesOf(const QImage& gray);

}  // namespace boresight::ui
