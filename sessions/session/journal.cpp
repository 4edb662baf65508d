// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/journal.h"

#include <nlohmann/json.hpp>

#include "sessions/io/atomic_file.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_reader.h"
#include "sessions/session/session_file.h"

namespace boresight::sessions {
namespace {

constexpr const char* kJournalFormat = "boresight-journal";
constexpr int kJournalVersion = 1;

Recovery readRecovery(const JsonReader& json) {
  Recovery recovery;
  recovery.base_sha256 = json.at("base_sha256").text();
  recovery.time = json.at("time").text();
  for (const JsonReader& edit : json.at("edits").elements()) recovery.edits.push_back(edit.text());
  recovery.session = readSession(json.at("session"));
  return recovery;
}

}  // namespace

void writeJournal(const std::filesystem::path& file, const Journal& journal,
                  const std::string& session_text) {
  const nlohmann::ordered_json header = {{"format", kJournalFormat},
                                         {"version", kJournalVersion},
                                         {"base_sha256", journal.base_sha256},
                                         {"time", journal.time},
                                         {"edits", journal.edits}};
  std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  text.pop_back();  // the closing brace
  writeFileAtomically(file, text + ",\n\"session\": " + session_text + "}\n", FileUse::kSession);
}

Recovery readJournal(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, 2 * kMaxJsonBytes, FileUse::kSession);
  return JsonDocument(file, asText(bytes)).read(kJournalFormat, kJournalVersion, readRecovery);
}

}  // namespace boresight::sessions
