// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/frame_source.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = 64 * kMegabyte;

/// The name with its numbers filled up with zeros, for sorting by their values.
std::string sortKey(const std::string& name) {
  constexpr std::size_t kLongestName = 255;
  std::string key;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t end = std::min(name.find_first_not_of("0123456789", at), name.size());
    if (end == at) {
      key += name[at++];
      continue;
    }
    key.append(kLongestName - std::min(kLongestName, end - at), '0');
    key.append(name, at, end - at);
    at = end;
  }
  return key;
}

/// Hidden files, such as those that macOS puts next to each file of a stick, are none.
bool isImageName(const fs::path& file) {
  if (file.filename().string().starts_with('.')) return false;
  constexpr std::array kEnds = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".img", ".vic"};
  const std::string end = lowerCase(file.extension().string());
  return std::find(kEnds.begin(), kEnds.end(), end) != kEnds.end();
}

std::vector<fs::path> filesOfFolder(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->is_regular_file(error) && isImageName(entry->path())) files.push_back(entry->path());
  if (error) throw InputError(folder, "cannot be listed: " + error.message());
  if (files.empty())
    throw InputError(folder,
                     "has no image; images end in .png, .jpg, .jpeg, .tif, .tiff, .img or "
                     ".vic");
  std::ranges::sort(files, {}, [](const fs::path& file) {
    return std::pair(sortKey(file.filename().string()), file);
  });
  return files;
}

std::vector<fs::path> filesOfList(const fs::path& list) {
  const std::vector<std::uint8_t> bytes = readFileBytes(list, kMaxListBytes);
  const std::string_view text = textOf(list, asText(bytes));
  if (text.find('\0') != std::string_view::npos)
    throw InputError(list, "is not a list of images: a text file with one path a line");
  std::vector<fs::path> files;
  std::set<fs::path> known;
  for (TextLines lines(text); lines.next();) {
    std::string line(lines.line());
    line.resize(line.find_last_not_of(kTextBlanks) + 1);
    if (line.empty() || line.front() == '#') continue;
    files.push_back(list.parent_path() / line);
    if (!known.insert(files.back().lexically_normal()).second)
      throw InputError(list, "line " + std::to_string(lines.number()), line + " is listed twice");
  }
  if (files.empty()) throw InputError(list, "lists no image");
  return files;
}

/// Reads each image on request.
class ImageFiles final : public FrameSource {
 public:
  ImageFiles(std::vector<fs::path> files, fs::path folder, const ImageReadOptions& options)
      : files_(std::move(files)), folder_(std::move(folder)), options_(options) {}

  std::int64_t count() const override { return static_cast<std::int64_t>(files_.size()); }

  std::optional<Frame> next() override {
    if (next_ == files_.size()) return std::nullopt;
    const fs::path& file = files_[next_++];
    Frame frame{file.lexically_relative(folder_).string(), std::nullopt, ""};
    try {
      frame.image = readImage(file, options_);
    } catch (const FileError& error) {
      frame.problem = error.what();
    }
    return frame;
  }

  void skip() override { next_ = std::min(next_ + 1, files_.size()); }

 private:
  std::vector<fs::path> files_;
  fs::path folder_;  ///< to which names are relative
  ImageReadOptions options_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> openImages(const fs::path& folder_or_list,
                                        const ImageReadOptions& options) {
  std::error_code error;
  if (!fs::exists(folder_or_list, error))
    throw InputError(folder_or_list, "there is no such folder or file");
  const fs::path path = fs::absolute(folder_or_list).lexically_normal();
  if (fs::is_directory(path, error))
    return std::make_unique<ImageFiles>(filesOfFolder(path), path, options);
  return std::make_unique<ImageFiles>(filesOfList(path), path.parent_path(), options);
}

}  // namespace boresight::sessions
