// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/journal.h"

#include <nlohmann/json.hpp>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {
namespace {

constexpr const char* kJournalFormat = "boresight-journal";
constexpr int kJournalVersion = 2;

/// The next line, without its end; what is left begins after it.
std::string_view takeLine(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

Journal readHeader(const JsonReader& json) {
  Journal journal;
  journal.base_sha256 = json.at("base_sha256").text();
  for (const JsonReader& edit : json.at("edits").elements())
    journal.entries.push_back(
        {edit.at("text").text(), edit.at("time").text(), edit.at("after_sha256").text()});
  return journal;
}

}  // namespace

void writeJournal(const std::filesystem::path& file, const Journal& journal) {
  nlohmann::ordered_json header = {{"format", kJournalFormat},
                                   {"version", kJournalVersion},
                                   {"base_sha256", journal.base_sha256},
                                   {"edits", nlohmann::ordered_json::array()}};
  for (const JournalEntry& entry : journal.entries)
    header["edits"].push_back(
        {{"text", entry.text}, {"time", entry.time}, {"after_sha256", entry.after_sha256}});
  const std::string text =
      header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n" +
      journal.session_text;
  writeFileAtomically(file, sha256Text(text) + "\n" + text, FileUse::kSession);
}

JournalContents readJournal(const std::filesystem::path& file) {
  JournalContents contents;
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error) && std::filesystem::is_empty(file, error)) {
    contents.problem = "the file is empty";
    return contents;
  }
  const std::vector<std::uint8_t> bytes = readFileBytes(file, 2 * kMaxJsonBytes, FileUse::kSession);
  std::string_view rest = asText(bytes);
  const std::string_view sha256 = takeLine(rest);
  if (sha256 != sha256Text(rest)) {
    contents.problem = "it is damaged, or of another version than this program's";
    return contents;
  }
  try {
    const JsonDocument header(file, takeLine(rest));
    static_cast<Journal&>(contents) = header.read(kJournalFormat, kJournalVersion, readHeader);
  } catch (const InputError& wrong) {
    contents.problem = wrong.reason();
  }
  contents.session_text = rest;
  return contents;
}

}  // namespace boresight::sessions
