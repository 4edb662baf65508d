// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/zip_writer.h"

#include <minizip/unzip.h>
#include <minizip/zip.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr unsigned long kUtf8Names = 1ul << 11;
constexpr unsigned long kMadeByUnix = (3ul << 8) | 45ul;
constexpr unsigned long kOrdinaryFile = 0100644ul << 16;
constexpr std::size_t kChunkBytes = std::size_t{1} << 24;
constexpr std::size_t kZip64From = 0xfffffffful - (std::size_t{1} << 20);

/// 1980-01-01, the first day that a zip can name.
zip_fileinfo fixedInfo() {
  zip_fileinfo info{};
  info.tmz_date.tm_mday = 1;
  info.tmz_date.tm_year = 1980;
  info.external_fa = kOrdinaryFile;
  return info;
}

}  // namespace

ZipWriter::ZipWriter(const fs::path& archive) : archive_(archive) {
  requireWritable(archive_);
  temporary_ = archive_.parent_path() / (".boresight-" + std::to_string(::getpid()) + ".zip.tmp");
  zip_ = zipOpen64(temporary_.c_str(), APPEND_STATUS_CREATE);
  if (zip_ == nullptr) throw OutputError(archive_, "the archive cannot be begun");
}

ZipWriter::~ZipWriter() {
  if (zip_ != nullptr) zipClose(zip_, nullptr);
  std::error_code error;
  fs::remove(temporary_, error);
}

void ZipWriter::add(const std::string& name, std::span<const std::uint8_t> bytes) {
  if (!names_.insert(name).second) return;
  const zip_fileinfo info = fixedInfo();
  bool good = zipOpenNewFileInZip4_64(zip_, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                                      Z_DEFLATED, Z_BEST_SPEED, 0, -MAX_WBITS, DEF_MEM_LEVEL,
                                      Z_DEFAULT_STRATEGY, nullptr, 0, kMadeByUnix, kUtf8Names,
                                      bytes.size() >= kZip64From ? 1 : 0) == ZIP_OK;
  while (good && !bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), kChunkBytes);
    good = zipWriteInFileInZip(zip_, bytes.data(), static_cast<unsigned>(count)) == ZIP_OK;
    bytes = bytes.subspan(count);
  }
  good = good && zipCloseFileInZip(zip_) == ZIP_OK;
  if (!good) throw OutputError(archive_, "the archive cannot be written (is the disk full?)");
}

void ZipWriter::add(const std::string& name, std::string_view text) {
  add(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

/// The library writes through a buffer and does not tell when the end of it is lost.
void ZipWriter::requireReadable() const {
  unzFile file = unzOpen64(temporary_.c_str());
  std::size_t count = 0;
  bool good = file != nullptr;
  std::vector<std::uint8_t> buffer(kChunkBytes);
  for (int at = good ? unzGoToFirstFile(file) : UNZ_END_OF_LIST_OF_FILE; at == UNZ_OK && good;
       at = unzGoToNextFile(file)) {
    good = unzOpenCurrentFile(file) == UNZ_OK;
    int bytes = 1;
    while (good && bytes > 0)
      bytes = unzReadCurrentFile(file, buffer.data(), static_cast<unsigned>(buffer.size()));
    good = good && bytes == 0 && unzCloseCurrentFile(file) == UNZ_OK;
    ++count;
  }
  if (file != nullptr) unzClose(file);
  if (!good || count != names_.size())
    throw OutputError(archive_, "the archive cannot be read again (is the disk full?)");
}

void ZipWriter::commit() {
  if (zipClose(std::exchange(zip_, nullptr), nullptr) != ZIP_OK)
    throw OutputError(archive_, "the archive cannot be completed (is the disk full?)");
  requireReadable();
  moveIntoPlace(temporary_, archive_);
}

}  // namespace boresight::sessions
