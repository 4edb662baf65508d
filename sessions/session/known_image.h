// SPDX-License-Identifier: Apache-2.0
// An image as a session knows it, and which of its files to name when it is no longer that: a label
// may be a file of its own.
#pragma once

#include <filesystem>
#include <string>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Reads the image by another rule than the session's, or by that. InputError when it cannot be
/// read, or its files are not those that the session knows.
GrayImage readKnownImage(const ImageInput& image, const ImageReadOptions& eight_bit);

/// What beside the file belongs to the image: "its label DET.LBL", "its pixels DET.DAT"; "" for an
/// image of one file, and for one that cannot be read.
std::string otherFileText(const std::filesystem::path& image);

/// One sentence where the session knows a label and neither the file nor one beside it has it any
/// more; else "".
std::string lostLabelText(const ImageInput& image);

}  // namespace boresight::sessions
