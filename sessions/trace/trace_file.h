// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Writes a trace atomically; reading it back gives the same bits. OutputError.
///
/// The file, all numbers big-endian:
///
///     8 bytes    "BSTRACE\n"
///     u32        version of the format
///     u64        length of the payload
///     payload    the fields of LocalizationTrace in the order of trace_fields.h
///     32 bytes   SHA-256 of everything before
///
/// Integers have the width of their field, a double or float its IEEE bits, an enumeration is a u8,
/// a text or list is a u32 count and its elements, an option its name and its value as a double. A
/// binary image is width, height and its words (64 pixels each, bit x & 63).
void saveTrace(const std::filesystem::path& file, const LocalizationTrace& trace);

/// InputError when the file is missing, cut, altered, of another format or version, or contradicts
/// itself (edge pixels outside their image, matches of templates that do not exist).
LocalizationTrace loadTrace(const std::filesystem::path& file);

}  // namespace boresight::sessions
