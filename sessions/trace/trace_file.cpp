// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/trace_file.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/base/digest.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/trace/archive.h"
#include "sessions/trace/trace_fields.h"

namespace boresight::sessions {
namespace {

constexpr std::string_view kMagic = "BSTRACE\n";
constexpr std::uint32_t kFormatVersion = 11;
constexpr std::size_t kHeaderBytes = 8 + 4 + 8;
constexpr std::size_t kChecksumBytes = 32;
constexpr std::size_t kMaxTraceBytes = 2048 * kMegabyte;

std::array<std::uint8_t, kChecksumBytes> checksum(std::span<const std::uint8_t> bytes) {
  Sha256 sha;
  sha.update(bytes);
  return sha.digest();
}

}  // namespace

void saveTrace(const std::filesystem::path& file, const LocalizationTrace& trace) {
  ArchiveWriter payload;
  fields(payload, trace);
  ArchiveWriter whole;
  whole.bytes().assign(kMagic.begin(), kMagic.end());
  whole.number(kFormatVersion);
  whole.number(static_cast<std::uint64_t>(payload.bytes().size()));
  std::vector<std::uint8_t>& bytes = whole.bytes();
  bytes.insert(bytes.end(), payload.bytes().begin(), payload.bytes().end());
  const auto sum = checksum(bytes);
  bytes.insert(bytes.end(), sum.begin(), sum.end());
  writeFileAtomically(file, bytes, FileUse::kRun);
}

LocalizationTrace loadTrace(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxTraceBytes, FileUse::kRun);
  const std::span<const std::uint8_t> all(bytes);
  if (bytes.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    throw InputError(file, "not a trace of boresight");
  if (bytes.size() < kHeaderBytes + kChecksumBytes) throw InputError(file, "truncated");
  ArchiveReader header(file, all.subspan(kMagic.size(), kHeaderBytes - kMagic.size()));
  std::uint32_t version = 0;
  std::uint64_t length = 0;
  header.number(version);
  header.number(length);
  if (version != kFormatVersion)
    throw InputError(file, "version",
                     std::to_string(version) + ", but this program reads version " +
                         std::to_string(kFormatVersion));
  if (length != bytes.size() - kHeaderBytes - kChecksumBytes)
    throw InputError(file, "truncated, or something was appended");
  const auto sum = checksum(all.first(bytes.size() - kChecksumBytes));
  if (!std::equal(sum.begin(), sum.end(), bytes.end() - kChecksumBytes))
    throw InputError(file, "checksum", "the file was altered or damaged");
  ArchiveReader payload(file, all.subspan(kHeaderBytes, static_cast<std::size_t>(length)));
  LocalizationTrace trace;
  fields(payload, trace);
  payload.require(payload.atEnd(), "more bytes than the record has fields");
  trace.finished = trace.status != LocalizationStatus::kRunning;
  if (trace.finished) trace.stage = Stage::kFinished;
  return trace;
}

}  // namespace boresight::sessions
