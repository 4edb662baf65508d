// SPDX-License-Identifier: Apache-2.0
// The files that this process was given to read: no output replaces one of them.
#pragma once

#include <filesystem>

namespace boresight::sessions {

/// What a file is read as, or written as. Files of all uses but the first two are kept up to date
/// by the program itself: each may be replaced by a file of the same use.
enum class FileUse {
  kInput,
  kFree,  ///< may be replaced: only looked at to see what it is, or written by this process
  kSession,
  kRun,
  kResults,
  kMarks,
  kLandmarks
};

/// Remembers that `file` was read, or that a file which was read names it as an input. A file with
/// two uses counts as an input. Not for what is no regular file.
void noteInput(const std::filesystem::path& file, FileUse use = FileUse::kInput);

/// Remembers that this process has written `output`: it may do so again, also after reading it.
void noteOutput(const std::filesystem::path& output, FileUse use = FileUse::kInput);

/// Throws OverwriteError when `output` is a file that was noted, under whatever name, symbolic or
/// hard link, and is not replaced by one of the same use.
void requireNoInput(const std::filesystem::path& output, FileUse use = FileUse::kInput);

}  // namespace boresight::sessions
