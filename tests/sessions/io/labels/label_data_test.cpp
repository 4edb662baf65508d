// SPDX-License-Identifier: Apache-2.0
// Images of missions, outside of the repository: the folder planetary of BORESIGHT_DATA. Pixels and
// camera models are read here anew: bytes at the offset that the label's text names, numbers by
// their keywords, projection by the published formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sessions/io/file_bytes.h"
#include "sessions/io/image_file.h"
#include "sessions/io/labels/image_label.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using V3 = Eigen::Vector3d;

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

struct Text {
  std::map<char, V3> vector;
  double type = 0, parameter = 0;
  bool entrance = false;
};

Text modelIn(const std::string& label) {
  const std::string group =
      label.substr(label.find("= GEOMETRIC_CAMERA_MODEL"),
                   label.find("END_GROUP", label.find("= GEOMETRIC_CAMERA_MODEL")) -
                       label.find("= GEOMETRIC_CAMERA_MODEL"));
  Text text;
  text.entrance = group.find("CAHVORE") != std::string::npos;
  for (int i = 0; i < (text.entrance ? 7 : 6); ++i) {
    const auto numbers = listAfter(group, "MODEL_COMPONENT_" + std::to_string(i + 1));
    EXPECT_EQ(numbers.size(), 3u);
    text.vector["CAHVORE"[i]] = V3(numbers.at(0), numbers.at(1), numbers.at(2));
  }
  if (!text.entrance) return text;
  text.type = listAfter(group, "MODEL_COMPONENT_8").at(0);
  text.parameter = listAfter(group, "MODEL_COMPONENT_9").at(0);
  return text;
}

/// CAHVOR and CAHVORE as published, for a point in the label's frame; false where not imaged.
bool projected(const Text& t, const V3& point, double& x, double& y) {
  const V3 d = point - t.vector.at('C');
  const V3 &o = t.vector.at('O'), &r = t.vector.at('R');
  const double w = d.dot(o);
  const V3 lambda = d - w * o;
  V3 seen;
  if (!t.entrance) {
    const double tau = lambda.squaredNorm() / (w * w);
    seen = d + (r[0] + r[1] * tau + r[2] * tau * tau) * lambda;
  } else {
    const V3& e = t.vector.at('E');
    const double l = lambda.norm();
    const double linearity = t.type == 1 ? 1.0 : t.type == 2 ? 0.0 : t.parameter;
    double theta = std::atan2(l, w);
    for (int i = 0; i < 200; ++i) {  // bisection would do as well; plain secant steps
      const auto f = [&](double a) {
        return w * std::sin(a) - l * std::cos(a) -
               (a - std::sin(a)) * (e[0] + e[1] * a * a + e[2] * a * a * a * a);
      };
      const double h = 1e-6;
      theta -= f(theta) / ((f(theta + h) - f(theta - h)) / (2 * h));
    }
    if (theta * std::abs(linearity) >= std::acos(0.0)) return false;
    const double chi = linearity > 0   ? std::tan(linearity * theta) / linearity
                       : linearity < 0 ? std::sin(linearity * theta) / linearity
                                       : theta;
    const double mu = r[0] + r[1] * chi * chi + r[2] * chi * chi * chi * chi;
    seen = (l / chi) * o + (1 + mu) * lambda;
  }
  const double depth = seen.dot(t.vector.at('A'));
  x = seen.dot(t.vector.at('H')) / depth;
  y = seen.dot(t.vector.at('V')) / depth;
  return depth > 0;
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

TEST(LabelData, CamerasProjectAsTheVectorsInTheText) {
  const auto files = missionImages();
  if (files.empty()) GTEST_SKIP() << "BORESIGHT_DATA names no folder with planetary images";
  for (const fs::path& file : files) {
    const std::string text(asText(readFileBytes(file, kMaxImageFileBytes)).substr(0, 30000));
    const Text model = modelIn(text);
    const ImageLabel label = readImageLabel(file);
    ASSERT_TRUE(label.camera) << label.camera_remark;
    EXPECT_TRUE(label.subframe && label.subframe->whole());
    EXPECT_GE(label.frames.size(), 3u);
    const CameraReference& reference = *label.camera->reference;
    EXPECT_NE(text.find(reference.frame.name), std::string::npos);
    EXPECT_LT(
        (reference.camera_from_reference.inverse().translation_m - model.vector.at('C')).norm(),
        1e-9);
    int seen = 0;
    const double edge = 600.0 / model.vector.at('H').norm();
    for (double u = -edge; u <= edge; u += edge / 6)
      for (double v = -edge; v <= edge; v += edge / 6)
        for (const double range_m : {0.5, 2.0, 30.0}) {
          const V3 a = model.vector.at('A');
          const V3 right = V3(0, 0, 1).cross(a).normalized();
          const V3 point =
              model.vector.at('C') + range_m * (a + u * right + v * a.cross(right)).normalized();
          double x = 0, y = 0;
          if (!projected(model, point, x, y) || x < 0 || y < 0 || x > 1023 || y > 1023) continue;
          Eigen::Vector2d pixel;
          ASSERT_TRUE(
              project(label.camera->camera, reference.camera_from_reference * point, pixel));
          EXPECT_NEAR(pixel.x(), x, 2e-3) << file;
          EXPECT_NEAR(pixel.y(), y, 2e-3) << file;
          ++seen;
        }
    EXPECT_GT(seen, 50) << file;
  }
}

}  // namespace
}  // namespace boresight::sessions
