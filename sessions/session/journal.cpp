// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sessions/io/atomic_file.h"
#include "sessions/io/crc32.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "boresight-journal";
constexpr int kVersion = 1;
constexpr std::size_t kMaxJournalBytes = 1024 * kMegabyte;
constexpr std::size_t kCrcDigits = 8;

std::string crcText(const std::string& previous_crc, std::string_view line) {
  const std::string chained = previous_crc + std::string(line);
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%08x",
                crc32({reinterpret_cast<const std::uint8_t*>(chained.data()), chained.size()}));
  return text.data();
}

/// Appends a line for `value` to `text` and moves the chain on.
void addLine(const nlohmann::ordered_json& value, std::string& last_crc, std::string& text) {
  const std::string line =
      value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  last_crc = crcText(last_crc, line);
  text += last_crc + " " + line + "\n";
}

nlohmann::ordered_json headerJson(const std::string& base_sha256) {
  nlohmann::ordered_json header;
  header["format"] = kFormat;
  header["version"] = kVersion;
  header["base_sha256"] = base_sha256;
  return header;
}

nlohmann::ordered_json entryJson(const JournalEntry& entry) {
  nlohmann::ordered_json line;
  line["seq"] = entry.sequence;
  line["time"] = entry.time;
  line["text"] = entry.text;
  line["after_sha256"] = entry.after_sha256;
  line["patch"] = nlohmann::ordered_json::parse(entry.patch);
  return line;
}

/// The JSON of the next intact line; false at the end or at a damaged line.
bool takeLine(std::string_view& rest, std::string& last_crc, json& value) {
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos || end <= kCrcDigits + 1) return false;
  const std::string_view line = rest.substr(kCrcDigits + 1, end - kCrcDigits - 1);
  const std::string crc = crcText(last_crc, line);
  if (rest.substr(0, kCrcDigits) != crc || rest[kCrcDigits] != ' ') return false;
  value = json::parse(line, nullptr, false);
  if (!value.is_object()) return false;
  last_crc = crc;
  rest.remove_prefix(end + 1);
  return true;
}

bool readText(const json& value, const char* key, std::string& text) {
  const auto found = value.find(key);
  if (found == value.end() || !found->is_string()) return false;
  text = found->get<std::string>();
  return true;
}

bool readEntry(const json& value, std::int64_t expected, JournalEntry& entry) {
  if (!value.contains("seq") || value["seq"] != expected || !value.contains("patch")) return false;
  entry.sequence = expected;
  entry.patch = value["patch"].dump();
  return readText(value, "time", entry.time) && readText(value, "text", entry.text) &&
         readText(value, "after_sha256", entry.after_sha256);
}

std::size_t lineCount(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += c == '\n' ? 1u : 0u;
  return count + (text.empty() || text.back() == '\n' ? 0u : 1u);
}

std::string writeReason(int error) {
  if (error == ENOSPC) return "no space left on the device";
  if (error == EFBIG) return "the file would become larger than is allowed";
  if (error == EROFS) return "the file system is read-only";
  return std::strerror(error);
}

/// 0, or what went wrong.
int writeAll(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count < 0 ? errno : EIO;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return ::fdatasync(descriptor) == 0 ? 0 : errno;
}

}  // namespace

JournalContents readJournal(const std::filesystem::path& file) {
  JournalContents contents;
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error) && std::filesystem::is_empty(file, error)) {
    contents.problem = "the file is empty";
    return contents;
  }
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxJournalBytes, FileUse::kSession);
  std::string_view rest = asText(bytes);
  std::string last_crc;
  json value;
  std::string format;
  if (!takeLine(rest, last_crc, value) || !readText(value, "format", format) || format != kFormat) {
    contents.problem = "it does not begin as a journal of a session";
    return contents;
  }
  if (value.value("version", json()) != kVersion) {
    contents.problem = "it is of another version than this program's";
    return contents;
  }
  (void)readText(value, "base_sha256", contents.base_sha256);
  JournalEntry entry;
  std::string_view before = rest;
  while (takeLine(rest, last_crc, value)) {
    const auto expected = static_cast<std::int64_t>(contents.entries.size()) + 1;
    if (!readEntry(value, expected, entry)) {
      rest = before;
      break;
    }
    contents.entries.push_back(entry);
    before = rest;
  }
  contents.lost_lines = lineCount(rest);
  return contents;
}

Journal::Journal(const std::filesystem::path& file, const std::string& base_sha256,
                 const std::vector<JournalEntry>& entries)
    : file_(file) {
  std::string text;
  addLine(headerJson(base_sha256), last_crc_, text);
  for (JournalEntry entry : entries) {
    entry.sequence = ++sequence_;
    addLine(entryJson(entry), last_crc_, text);
  }
  writeFileAtomically(file, text, FileUse::kSession);
  size_bytes_ = static_cast<std::int64_t>(text.size());
  descriptor_ = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) throw OutputError(file, writeReason(errno));
}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Journal::append(JournalEntry entry) {
  if (damaged_) throw OutputError(file_, "an earlier edit could not be written; save the session");
  entry.sequence = sequence_ + 1;
  std::string crc = last_crc_;
  std::string line;
  addLine(entryJson(entry), crc, line);
  const int error = writeAll(descriptor_, line);
  if (error != 0) {
    // Half a line would hide the lines behind it.
    damaged_ = ::ftruncate(descriptor_, size_bytes_) != 0;
    throw OutputError(file_, writeReason(error));
  }
  last_crc_ = crc;
  size_bytes_ += static_cast<std::int64_t>(line.size());
  ++sequence_;
}

}  // namespace boresight::sessions
