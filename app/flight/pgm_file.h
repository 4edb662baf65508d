// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

namespace boresight::flight {

/// Reads the header of a binary PGM (P5, largest value 255) and leaves the stream at the first
/// pixel. What is wrong with it, for people, or nullptr.
const char* readPgmHeader(std::FILE* stream, int& width, int& height);

/// Reads all pixels, after the header; there must be nothing behind them. The same.
const char* readPgmPixels(std::FILE* stream, std::span<std::uint8_t> pixels);

}  // namespace boresight::flight
