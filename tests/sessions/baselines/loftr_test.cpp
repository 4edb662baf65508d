// SPDX-License-Identifier: Apache-2.0
// The matcher that ships, where its model and its package are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "sessions/baselines/matcher_client.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

bool packageIsInstalled() {
  if (std::system("node --version >/dev/null 2>&1") != 0) return false;
  const std::string probe = "cd '" + std::string(BORESIGHT_MATCHERS) +
                            "/loftr' && node -e \"require('onnxruntime-node')\"";
  return std::system((probe + " >/dev/null 2>&1").c_str()) == 0;
}

std::string commandOf(const std::string& model) {
  return "node '" + std::string(BORESIGHT_MATCHERS) + "/loftr/loftr.js' --model '" + model + "'";
}

/// Empty where the model or the package is missing.
std::string loftrCommand() {
  const char* model = std::getenv("BORESIGHT_LOFTR_MODEL");
  if (model == nullptr || !std::filesystem::exists(model) || !packageIsInstalled()) return "";
  return commandOf(model);
}

/// Black, with one white pixel in a gray square, whatever the pixels are averaged over.
struct SpotImage {
  int width, height;
  std::vector<std::uint8_t> pixels;

  SpotImage(int columns, int rows, int x, int y)
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    for (int v = y - 2; v <= y + 2; ++v)
      for (int u = x - 2; u <= x + 2; ++u) at(u, v) = 100;
    at(x, y) = 255;
  }
  std::uint8_t& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  ImageView view() const { return {pixels.data(), width, height, width}; }
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(Loftr, FindsAShift) {
  const std::string command = loftrCommand();
  if (command.empty())
    GTEST_SKIP() << "set BORESIGHT_LOFTR_MODEL to the model's file, and run `npm install` in "
                    "resources/matchers/loftr";
  const ExampleCase example("os");
  const ImageView whole = example.image.view();
  constexpr int kShift = 48;
  const ImageView first{whole.data, whole.width - kShift, whole.height - kShift, whole.stride};
  const ImageView second{whole.row(kShift) + kShift, first.width, first.height, whole.stride};
  sessions::MatcherClient client(command, 120.0, {});
  const auto pairs = client.match(first, second, 400, 120.0, {});
  ASSERT_GT(pairs.size(), 30u);
  std::vector<double> dx, dy;
  for (const auto& pair : pairs) {
    dx.push_back(pair.second_x - pair.first_x);
    dy.push_back(pair.second_y - pair.first_y);
  }
  // A cell is 16 px of 640 x 480.
  EXPECT_NEAR(median(dx), -kShift, 0.5 * 16.0 * first.width / 640.0);
  EXPECT_NEAR(median(dy), -kShift, 0.5 * 16.0 * first.height / 480.0);
}

TEST(Loftr, TakesKeyPointsOfAWholeModelInPixelsOfTheImages) {
  if (!packageIsInstalled()) GTEST_SKIP() << "run `npm install` in resources/matchers/loftr";
  // The model's match is the brightest pixel of each input, a quarter of a pixel to the right; its
  // match without confidence must not come. Input pixels are half and 1 / 1.5 of the images'.
  const SpotImage first(512, 512, 200, 100);
  const SpotImage second(1536, 1536, 399, 300);
  sessions::MatcherClient client(
      commandOf(std::string(BORESIGHT_MODELS) + "/brightest.onnx") + " --size 1024x1024", 120.0,
      {});
  EXPECT_EQ(client.width(), 1024);
  EXPECT_EQ(client.height(), 1024);
  const auto pairs = client.match(first.view(), second.view(), 10, 120.0, {});
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(pairs[0].first_x, 200.0 + 0.125, 0.3);
  EXPECT_NEAR(pairs[0].first_y, 100.0, 0.3);
  EXPECT_NEAR(pairs[0].second_x, 399.0 + 0.375, 0.8);
  EXPECT_NEAR(pairs[0].second_y, 300.0, 0.8);
  EXPECT_NEAR(pairs[0].score, 0.75, 1e-6);
}

TEST(Loftr, MissingPackageIsNamedWithWhatToDo) {
  if (std::system("node --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "node is not installed";
  const TemporaryFolder folder;
  std::filesystem::copy(std::filesystem::path(BORESIGHT_MATCHERS) / "loftr/loftr.js",
                        folder / "loftr.js");
  const std::string command =
      "env -u NODE_PATH node '" + (folder / "loftr.js").string() + "' --model model.onnx";
  EXPECT_EQ(
      folder.message([&] { const sessions::MatcherClient client(command, 120.0, {}); }),
      "the matcher (env -u NODE_PATH node 'loftr.js' --model model.onnx) ended with status 1, "
      "saying: the package onnxruntime-node is not installed: run npm install in " +
          std::filesystem::canonical(folder.path()).string());
}

}  // namespace
}  // namespace boresight::test
