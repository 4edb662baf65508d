// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "sessions/io/image_container.h"

namespace boresight::sessions {

/// Whether the bytes begin as TIFF 6.0 or BigTIFF.
bool isTiff(std::span<const std::uint8_t> bytes);

/// The orientation 1 .. 8 in the first directory of a TIFF, which an Exif block is, too; 1 where it
/// states none, or is damaged.
int tiffOrientation(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// The same TIFF with orientation 1 in place of the one that it states: the decoder turns others.
std::vector<std::uint8_t> uprightTiff(const std::filesystem::path& file,
                                      std::span<const std::uint8_t> bytes);

/// The part of checkImageContainer for TIFF: the first image's directory, strips or tiles are
/// within the file, and of a kind that is decoded with its values intact (unsigned samples of 1, 8
/// or 16 bits; gray, RGB, palette, YCbCr; chunky; no straight alpha beside 8-bit colour; at most
/// four channels).
/// InputError.
ImageHeader checkTiff(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
