// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace boresight::sessions {

enum class ImageContainer { kPng, kJpeg, kTiff };

const char* imageContainerName(ImageContainer container);

/// Of samples that are signed, floating, or of other lengths.
inline constexpr const char* kOtherSamples =
    "samples are not unsigned integers of 8 or 16 bits: write the image as a TIFF or PNG of 16 "
    "bits, its range spread over 0 .. 65535";

/// What the headers of an image file say, before anything is decoded.
struct ImageHeader {
  ImageContainer container = ImageContainer::kPng;
  std::int64_t width = 0;
  std::int64_t height = 0;
  int orientation = 1;              ///< that EXIF or a TIFF states, 1 .. 8; 1: as stored
  bool has_further_images = false;  ///< of TIFF: pages
};

/// Reads the structure of a PNG, JPEG or TIFF from the first byte to the last that matters.
/// Decoders fill what is missing with gray and go on, so that a truncated file is found here:
/// PNG by its chunks, their checksums and IEND; JPEG by its segments and EOI; TIFF by the place of
/// every strip or tile of the first image. InputError, also for any other format.
ImageHeader checkImageContainer(const std::filesystem::path& file,
                                std::span<const std::uint8_t> bytes);

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
