// SPDX-License-Identifier: Apache-2.0
// Reads whole files, and remembers them: no output replaces an input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::sessions {

/// Purpose of a file that is read or written. The program updates files of all uses but the first
/// two: each may be replaced by a file of the same use.
enum class FileUse {
  kInput,
  kFree,  ///< may be replaced: only its type was read, or this process wrote it
  kSession,
  kRun,
  kResults,
  kMarks,
  kLandmarks
};

/// Remembers a file that was read, or that another file names as its input. A file with two uses
/// counts as an input. Files that are not regular are not remembered.
void noteInput(const std::filesystem::path& file, FileUse use = FileUse::kInput);

/// Remembers that this process has written `output`: it may be written again, also after being
/// read.
void noteOutput(const std::filesystem::path& output, FileUse use = FileUse::kInput);

/// Throws OverwriteError when `output` is a noted file, by any name, symbolic or hard link, and is
/// not replaced by one of the same use.
void requireNoInput(const std::filesystem::path& output, FileUse use = FileUse::kInput);

inline constexpr std::size_t kMegabyte = std::size_t{1} << 20;

/// The whole file, read once, so that the hashed bytes are the parsed bytes. InputError when it is
/// missing, a folder, a pipe or a device, not readable, empty, longer than `max_bytes`, or one that
/// a download left in its place (a Git LFS pointer, an HTML page). From then on no output replaces
/// it.
std::vector<std::uint8_t> readFileBytes(const std::filesystem::path& file, std::size_t max_bytes,
                                        FileUse use = FileUse::kInput);

/// At most the first `count` bytes of the file; rejects the same files.
std::vector<std::uint8_t> readBeginning(const std::filesystem::path& file, std::size_t count);

std::string_view asText(std::span<const std::uint8_t> bytes);

/// The text without the byte order mark of UTF-8.
std::string_view withoutMark(std::string_view text);

/// A file without the UTF-8 byte order mark that spreadsheets and editors put in front. InputError
/// when it is UTF-16 or UTF-32, by its mark or by the zero bytes of its first characters.
std::string_view unmarkedText(const std::filesystem::path& file, std::string_view bytes);

/// The text of a text file: unmarkedText without zero bytes and Ctrl-Z behind its end. InputError.
std::string_view textOf(const std::filesystem::path& file, std::string_view bytes);

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256Text(std::span<const std::uint8_t> bytes);
std::string sha256Text(std::string_view text);

/// Whether `count` bytes from `offset` on exist.
inline bool holds(std::span<const std::uint8_t> bytes, std::uint64_t offset, std::uint64_t count) {
  return offset <= bytes.size() && count <= bytes.size() - offset;
}

/// Unsigned number of `size` bytes (1 .. 8) at `offset`, which must exist.
inline std::uint64_t readUnsigned(std::span<const std::uint8_t> bytes, std::uint64_t offset,
                                  int size, bool big_endian) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) {
    const auto place = offset + static_cast<std::uint64_t>(big_endian ? i : size - 1 - i);
    value = value << 8 | bytes[static_cast<std::size_t>(place)];
  }
  return value;
}

}  // namespace boresight::sessions
