// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {

// All of these throw OverwriteError for a file that this process has read (file_bytes.h), unless it
// was read for the same `use`, other than kInput.

/// Writes a file whole or not at all: a temporary file in its folder, fsync, rename, fsync of the
/// folder. On failure the old file is unchanged and no temporary file remains. The target of a
/// symbolic link and the permissions of an existing file are kept. A device or pipe (/dev/stdout)
/// cannot be renamed onto and is written directly. Throws OutputError.
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes,
                         FileUse use = FileUse::kInput);
void writeFileAtomically(const std::filesystem::path& file, std::string_view text,
                         FileUse use = FileUse::kInput);

/// Gives a finished file in the same folder the name `file`: fsync, rename, fsync of the folder. On
/// failure both are unchanged. OutputError.
void moveIntoPlace(const std::filesystem::path& finished, const std::filesystem::path& file,
                   FileUse use = FileUse::kInput);

/// Waits until the names of the files in a folder are stored. Not every file system can: a refusal
/// is not reported.
void syncFolder(const std::filesystem::path& folder);

/// Throws OutputError when `file` evidently cannot be written (its folder is missing or read-only,
/// it is a folder): called before long work; writing may still fail.
void requireWritable(const std::filesystem::path& file, FileUse use = FileUse::kInput);

/// Creates a folder with all its files or not at all: `write` fills a temporary folder next to it.
/// The folder is renamed when `write` returns, and removed when it throws. OutputError when the
/// name exists and is not an empty folder, or the folder cannot be created.
void writeFolderAtomically(const std::filesystem::path& folder,
                           const std::function<void(const std::filesystem::path&)>& write);

}  // namespace boresight::sessions
