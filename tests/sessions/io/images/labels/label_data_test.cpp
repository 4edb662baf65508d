// SPDX-License-Identifier: Apache-2.0
// Images of missions, outside of the repository: the folder planetary of BORESIGHT_DATA. Pixels and
// camera models are read here by themselves: bytes at the offset that the label's text names,
// numbers by their keywords.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
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
  std::replace_if(
      list.begin(), list.end(), [](char c) { return c == '(' || c == ','; }, ' ');
  std::istringstream stream(list);
  for (double value; stream >> value;) numbers.push_back(value);
  return numbers;
}

/// Pixels are those at the offset that the label names, and vectors have the numbers of its text.
TEST(LabelData, ImagesAndTheirCameras_AreThoseOfTheFilesText) {
  const auto files = missionImages();
  if (files.empty()) GTEST_SKIP() << "BORESIGHT_DATA names no folder with planetary images";
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    const auto bytes = readFileBytes(file, kMaxImageFileBytes);
    const std::string text(asText(bytes).substr(0, 30000));
    const auto record = static_cast<std::size_t>(listAfter(text, "RECORD_BYTES").at(0));
    const auto first = static_cast<std::size_t>(listAfter(text, "^IMAGE").at(0));
    const ImageSamples samples = readSamples(file);
    ASSERT_EQ(samples.width, 1024);
    ASSERT_EQ(samples.height, 1024);
    const std::size_t offset = (first - 1) * record;
    for (std::size_t i = 0; i < samples.values.size(); ++i)
      ASSERT_EQ(samples.values[i], bytes[offset + 2 * i] * 256 + bytes[offset + 2 * i + 1]) << i;
    const GrayImage image = readImage(file);
    EXPECT_EQ(image.bit_depth, 12);
    EXPECT_EQ(image.container, "PDS3");
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
      ASSERT_EQ(stated.size(), 3u) << key;
      const Eigen::Vector3d expected(stated[0], stated[1], stated[2]);
      EXPECT_LT((vector - expected).norm(), 1e-5 * std::max(1.0, expected.norm())) << key;
    });
    if (model.model != CameraModel::kCahvore) continue;
    EXPECT_EQ(model.type, listAfter(group, "MODEL_COMPONENT_8").at(0));
    EXPECT_EQ(model.parameter, listAfter(group, "MODEL_COMPONENT_9").at(0));
  }
}

}  // namespace
}  // namespace boresight::sessions
