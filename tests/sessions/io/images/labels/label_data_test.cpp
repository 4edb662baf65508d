// SPDX-License-Identifier: Apache-2.0
// Images of missions, outside of the repository: the folder planetary of BORESIGHT_DATA. Pixels and
// camera models are read here by themselves: bytes at the offset that the label's text names,
// numbers by their keywords.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> missionImages() {
  std::vector<fs::path> files;
  const char* data = std::getenv("BORESIGHT_DATA");
  const fs::path folder = data == nullptr ? fs::path() : fs::path(data) / "planetary";
  if (data == nullptr || !fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".IMG") files.push_back(entry.path());
  return files;
}

std::vector<double> listAfter(const std::string& text, const std::string& keyword) {
  const auto at = text.find(keyword + " ");
  const auto open = text.find_first_of("(0123456789", text.find('=', at));
  std::vector<double> numbers;
  if (at == std::string::npos) return numbers;
  std::string list = text.substr(open, text.find_first_of(")\r\n", open) - open);
  for (char& c : list)
    if (c == '(' || c == ',') c = ' ';
  const char* next = list.c_str();
  char* end = nullptr;
  for (double value = std::strtod(next, &end); end != next; value = std::strtod(next, &end)) {
    numbers.push_back(value);
    next = end;
  }
  return numbers;
}

TEST(LabelData, PixelsAreThoseAtTheOffsetThatTheLabelNames) {
  const auto files = missionImages();
  if (files.empty()) GTEST_SKIP() << "BORESIGHT_DATA names no folder with planetary images";
  for (const fs::path& file : files) {
    const auto bytes = readFileBytes(file, kMaxImageFileBytes);
    const std::string text(asText(bytes).substr(0, 30000));
    const auto record = static_cast<std::size_t>(listAfter(text, "RECORD_BYTES").at(0));
    const auto first = static_cast<std::size_t>(listAfter(text, "^IMAGE").at(0));
    const ImageSamples samples = readSamples(file);
    ASSERT_EQ(samples.width, 1024) << file;
    ASSERT_EQ(samples.height, 1024) << file;
    const std::size_t offset = (first - 1) * record;
    for (std::size_t i = 0; i < samples.values.size(); ++i)
      ASSERT_EQ(samples.values[i], bytes[offset + 2 * i] * 256 + bytes[offset + 2 * i + 1])
          << file << " " << i;
    const GrayImage image = readImage(file);
    EXPECT_EQ(image.bit_depth, 12) << file;
    EXPECT_EQ(image.container, "PDS3");
  }
}

TEST(LabelData, CameraModelsHaveTheNumbersOfTheText) {
  const auto files = missionImages();
  if (files.empty()) GTEST_SKIP() << "BORESIGHT_DATA names no folder with planetary images";
  for (const fs::path& file : files) {
    const std::string text(asText(readFileBytes(file, kMaxImageFileBytes)).substr(0, 30000));
    const auto begin = text.find("= GEOMETRIC_CAMERA_MODEL");
    const std::string group = text.substr(begin, text.find("END_GROUP", begin) - begin);
    const ImageLabel label = readImageLabel(file);
    ASSERT_TRUE(label.camera) << label.camera_remark;
    EXPECT_TRUE(label.subframe && label.subframe->whole());
    EXPECT_GE(label.frames.size(), 3u);
    const CameraReference& reference = *label.camera->reference;
    EXPECT_NE(text.find(reference.frame.name), std::string::npos);
    const CahvModel model = cahvFromCamera(label.camera->camera, reference.camera_from_reference);
    int component = 0;
    forVectors(model, [&](const char* key, const Eigen::Vector3d& vector) {
      const auto stated = listAfter(group, "MODEL_COMPONENT_" + std::to_string(++component));
      ASSERT_EQ(stated.size(), 3u) << file << " " << key;
      const Eigen::Vector3d expected(stated[0], stated[1], stated[2]);
      EXPECT_LT((vector - expected).norm(), 1e-5 * std::max(1.0, expected.norm()))
          << file << " " << key;
    });
    if (model.model != CameraModel::kCahvore) continue;
    EXPECT_EQ(model.type, listAfter(group, "MODEL_COMPONENT_8").at(0)) << file;
    EXPECT_EQ(model.parameter, listAfter(group, "MODEL_COMPONENT_9").at(0)) << file;
  }
}

}  // namespace
}  // namespace boresight::sessions
