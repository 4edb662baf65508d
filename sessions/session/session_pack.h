// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// A file that an archive includes.
struct PackedFile {
  std::string name;            ///< in the archive
  std::filesystem::path file;  ///< absolute, its links resolved
  std::string sha256;          ///< of its bytes
};

/// Content of the archive of a session: a folder of the session's name with the session, `inputs/`
/// with every file that it names (once, below the beginning of its hash, so that equal names do not
/// collide), and the traces of its runs.
struct SessionPack {
  std::vector<PackedFile> files;   ///< without the session
  std::string session_name;        ///< in the archive
  std::string session_text;        ///< names its files relatively
  std::vector<std::string> notes;  ///< traces and landmarks that are missing and are left out
};

/// Reads every file as the type that the session's member states: an image, a mesh with its
/// buffers, a mask, an onboard record, landmarks, the trace of a run. InputError, naming the
/// member, when a file has another type, has changed since the session was made, or lies (links
/// resolved) neither below the session's folder nor below that of an image, mesh, mask or record.
/// Nothing is written.
SessionPack planPack(const Session& session, const std::filesystem::path& session_file);

/// Writes the zip archive, and reads it again before it is renamed. InputError when a file has
/// changed since it was planned; OutputError.
void writePack(const SessionPack& pack, const std::filesystem::path& archive);

}  // namespace boresight::sessions
