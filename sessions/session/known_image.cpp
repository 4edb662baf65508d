// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/known_image.h"

#include <system_error>

#include "sessions/io/errors.h"
#include "sessions/io/labels/label_files.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

GrayImage readOrName(const ImageInput& image, const ImageReadOptions& eight_bit) {
  try {
    return readImage(image.source.file, eight_bit);
  } catch (const InputError&) {
    const std::string lost = lostLabelText(image);
    if (lost.empty()) throw;
    throw InputError(image.source.file, lost);
  }
}

}  // namespace

GrayImage readKnownImage(const ImageInput& image, const ImageReadOptions& eight_bit) {
  GrayImage read = readOrName(image, eight_bit);
  if (read.file_sha256 == image.source.sha256) return read;
  const std::string other = otherFileText(image.source.file);
  requireKnown(image.source.file, other.empty() ? "its bytes" : "its bytes or " + other,
               read.file_sha256, image.source.sha256);
  return read;
}

SceneMesh readKnownScene(const std::vector<MeshInput>& inputs) {
  std::vector<PartSource> parts;
  for (const MeshInput& input : inputs) parts.push_back(input.source);
  return readScene(parts, [&inputs](std::size_t part, const std::string& sha256) {
    requireKnown(inputs[part].source.mesh, "its bytes", sha256, inputs[part].sha256);
  });
}

void requireKnown(const fs::path& file, const std::string& what, const std::string& found_sha256,
                  const std::string& known_sha256) {
  if (found_sha256 != known_sha256)
    throw InputError(file, what +
                               " are not those that the session was made with: relink the file, "
                               "or accept it as it is now");
}

std::string otherFileText(const fs::path& image) {
  try {
    const auto label = labelFileOf(image);
    if (!label) return "";
    if (*label != image) return "its label " + label->filename().string();
    const LabelFiles files = readLabelFiles(*label);
    return files.parts.size() < 2 ? "" : "its pixels " + files.parts[1].name;
  } catch (const InputError&) {
    return "";
  }
}

std::string lostLabelText(const ImageInput& image) {
  std::error_code error;
  const fs::path& file = image.source.file;
  if (image.label.empty() || !fs::exists(file, error) || labelFileOf(file)) return "";
  try {
    (void)readSamples(file);
    return "";  // another picture that needs no label
  } catch (const InputError&) {
  }
  const std::string stem = file.stem().string();
  return "the label that it had when the session was made is no longer there: put " + stem +
         ".lbl (or " + stem + ".xml) back beside it";
}

}  // namespace boresight::sessions
