// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_journal.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/files/append_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/session/session_change.h"
#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kJournalFormat = "boresight-journal";
constexpr int kWholeVersion = 1;
constexpr int kLinesVersion = 2;
constexpr std::size_t kSumDigits = 16;

std::string sumOf(const std::string& former_sum, std::string_view json) {
  return sha256Text(former_sum + std::string(json)).substr(0, kSumDigits);
}

std::string lineOf(const std::string& sum, const std::string& json) {
  return sum + " " + json + "\n";
}

/// A description may hold any bytes.
std::string quoted(const std::string& text) {
  return ordered_json(text).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// The lines of a journal up to the first damaged one.
struct JournalLines {
  std::vector<JsonDocument> entries;  ///< the header first
  std::string damage;
};

JournalLines readLines(const fs::path& file, std::string_view text) {
  JournalLines lines;
  std::string sum;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;  // of an edit that was not finished
    const std::string_view line = text.substr(0, end);
    const std::string_view json = line.substr(std::min(line.size(), kSumDigits + 1));
    const std::string expected = sumOf(sum, json);
    if (line.substr(0, kSumDigits + 1) != expected + " ") {
      lines.damage = "line " + std::to_string(lines.entries.size() + 1) + " is damaged";
      break;
    }
    sum = expected;
    lines.entries.emplace_back(file, json);
    text.remove_prefix(end + 1);
  }
  return lines;
}

/// Index of the first entry after the saved state, or 0 when the journal is of another one.
std::size_t firstAfter(const std::string& saved_sha256, const std::vector<JsonDocument>& entries) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (const auto sha256 = entries[i].root().find(i == 0 ? "base_sha256" : "saved_sha256");
        sha256 && sha256->text() == saved_sha256)
      first = i + 1;
  return first;
}

/// Makes the edit of an entry.
void replay(const JsonReader& entry, Recovery& recovery) {
  if (entry.has("saved_sha256")) return;
  recovery.session = withChange(recovery.session, entry.at("change"));
  recovery.time = entry.at("time").text();
  recovery.edits.push_back(entry.at("edit").text());
}

Recovery readEdits(const fs::path& file, std::string_view text, const SavedSession& saved) {
  JournalLines lines = readLines(file, text);
  if (lines.entries.empty()) throw InputError(file, "no line of it is whole");
  lines.entries.front().root().requireFormat(kJournalFormat, kLinesVersion);
  const std::size_t first = firstAfter(saved.file_sha256, lines.entries);
  if (first == 0) throw InputError(file, "it belongs to another state of the file");
  Recovery recovery{{saved.file_sha256, {}, {}}, saved.session, lines.damage};
  for (std::size_t i = first; i < lines.entries.size(); ++i) try {
      replay(lines.entries[i].root(), recovery);
    } catch (const InputError& wrong) {
      recovery.damage = "line " + std::to_string(i + 1) + " cannot be read: " + wrong.reason();
      break;
    }
  return recovery;
}

Recovery readWhole(const JsonReader& json) {
  Recovery recovery;
  recovery.base_sha256 = json.at("base_sha256").text();
  recovery.time = json.at("time").text();
  for (const JsonReader& edit : json.at("edits").elements()) recovery.edits.push_back(edit.text());
  recovery.session = readSession(json.at("session"));
  return recovery;
}

Recovery readWhole(const fs::path& file, std::string_view text) {
  return JsonDocument(file, text).read(kJournalFormat, kWholeVersion, [](const JsonReader& json) {
    return readWhole(json);
  });
}

}  // namespace

JournalWriter::JournalWriter(fs::path file, std::string base_sha256)
    : file_(std::move(file)), base_sha256_(std::move(base_sha256)) {}

void JournalWriter::addEdit(const std::string& text, const std::string& change) {
  append("{\"edit\": " + quoted(text) + ", \"time\": \"" + utcNowText() +
         "\", \"change\": " + change + "}");
}

void JournalWriter::addSaved(const std::string& sha256) {
  append("{\"saved_sha256\": \"" + sha256 + "\"}");
}

void JournalWriter::append(const std::string& json) {
  std::string text;
  std::string sum = sum_;
  if (size_bytes_ == 0) {
    const ordered_json header = {
        {"format", kJournalFormat}, {"version", kLinesVersion}, {"base_sha256", base_sha256_}};
    const std::string first = header.dump();
    sum = sumOf("", first);
    text = lineOf(sum, first);
  }
  sum = sumOf(sum, json);
  text += lineOf(sum, json);
  if (size_bytes_ == 0)
    writeFileAtomically(file_, text, FileUse::kSession);
  else
    appendToFile(file_, size_bytes_, text);
  size_bytes_ += text.size();
  sum_ = std::move(sum);
}

bool isJournal(const fs::path& file) try {
  constexpr std::size_t kBeginning = 80;
  const std::vector<std::uint8_t> bytes = readBeginning(file, kBeginning);
  return asText(bytes).find(kJournalFormat) != std::string_view::npos;
} catch (const InputError&) {
  return false;
}

Recovery readJournal(const fs::path& file, const SavedSession& saved) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxSessionBytes, FileUse::kSession);
  if (!asText(bytes).starts_with('{')) return readEdits(file, asText(bytes), saved);
  Recovery whole = readWhole(file, asText(bytes));
  // A program may end between saving the edits and removing the journal.
  if (sha256Text(sessionText(whole.session, file)) == saved.file_sha256)
    return {{saved.file_sha256, whole.time, {}}, saved.session, {}};
  if (whole.base_sha256 != saved.file_sha256)
    throw InputError(file, "it belongs to another state of the file");
  return whole;
}

Recovery readWholeJournal(const fs::path& file) {
  return readWhole(file, asText(readFileBytes(file, kMaxSessionBytes, FileUse::kSession)));
}

}  // namespace boresight::sessions
