// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_file.h"

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_document.h"
#include "sessions/session/session_json.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::string textSha256(std::string_view text) {
  return sha256Text({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

fs::path beside(const fs::path& session_file, const char* extension) {
  fs::path name = session_file;
  if (name.extension() == ".json") name.replace_extension();
  name += extension;
  return name;
}

}  // namespace

fs::path journalFileOf(const fs::path& session_file) { return beside(session_file, ".journal"); }
fs::path lockFileOf(const fs::path& session_file) { return beside(session_file, ".lock"); }
fs::path runsFolderOf(const fs::path& session_file) { return beside(session_file, ".runs"); }

fs::path runFileOf(const fs::path& session_file, const std::string& digest) {
  return runsFolderOf(session_file) / (digest + ".trace");
}

SavedSession readSessionFile(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxJsonBytes, FileUse::kSession);
  if (asText(bytes).starts_with("PK\x03\x04"))
    throw InputError(file,
                     "an archive, as whs pack makes it: unpack it, and open the session in it");
  const JsonDocument document(file, asText(bytes));
  return {readSession(document.root()), sha256Text(bytes)};
}

std::string writeSessionFile(const fs::path& file, const Session& session) {
  const std::string text = sessionText(session, file);
  if (text.size() > kMaxJsonBytes)
    throw OutputError(file, "the session is larger than the limit of " +
                                std::to_string(kMaxJsonBytes / kMegabyte) + " MB");
  writeFileAtomically(file, text, FileUse::kSession);
  return textSha256(text);
}

}  // namespace boresight::sessions
